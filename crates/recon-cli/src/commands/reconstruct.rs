use crate::cli::ReconstructArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{
    AnyPalmsRequest, LogOf, LogSource, ReadLog, Reconstruction, bag_of_planes, condensed, exported,
    noisy_planes, normal_forces, read_log, reconstruct, refuse_unfelt, sentence, write_reconstruction_folder,
};
use crate::progress::Progress;
use recon_io::{Bounds, FolderTarget, Scene, SceneErrorKind, brief, brief_to};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

pub(crate) fn run(args: &ReconstructArgs, console: &Console) -> Result<Outcome, CliError> {
    if args.without_forces {
        return super::without_forces::run(args, console);
    }
    let path = args.scene.as_ref().ok_or(CliError::UnknownBody)?;
    let scene = match Scene::read(path) {
        Err(error) if matches!(error.kind, SceneErrorKind::InPlane) => {
            return super::planar::reconstruct(args, path, console);
        }
        read => read?,
    };
    let target = target(args)?;
    let progress = Progress::new(4, console.is_json());
    progress.step("reading the log");
    let title = args.log.file_name().unwrap_or(args.log.as_os_str()).to_string_lossy();
    let ReadLog { log, warnings, stand } = read_log(source(args, &scene), console)?;
    let mut request = AnyPalmsRequest::new(&scene, &title, args.identify);
    let log = match log {
        LogOf::ThreePalms(log) => log,
        LogOf::AnyPalms(log, why) => {
            refuse_unfelt(&log, &args.log, &why)?;
            request.warnings = warnings;
            request.note = sentence(&format!("{why}; the estimate is that from contacts of any palms"));
            return super::any_palms::run(args, (*log, request, stand), None, (target, progress), console);
        }
    };
    let (log, together) = condensed(log);
    if let Some(contacts) = noisy_planes(&log, &scene)? {
        request.of_noisy_planes(&log, together, warnings);
        return super::any_palms::run(
            args,
            (contacts, request, stand),
            Some(&log),
            (target, progress),
            console,
        );
    }
    let forces = normal_forces(&log);
    let mut made = reconstruct(log, &scene, &title, (args.identify, together), &progress)?;
    made.data.warnings.extend(warnings);
    progress.step("writing the results");
    let files = exported(&made.object(), &args.export, args.export_shape)?;
    let mut extras: Vec<_> = files.into_iter().map(|file| (file.name, file.contents)).collect();
    if args.mcap {
        extras.push(bag_of_planes(&made, &forces, stand)?);
    }
    let figures = write_reconstruction_folder(target, &made, &extras)?;
    drop(progress);
    tell(console, &made, figures, &args.output)
}

/// Where the log is.
pub(super) fn source<'a>(args: &'a ReconstructArgs, scene: &'a Scene) -> LogSource<'a> {
    LogSource { path: &args.log, scene, mapping: args.mapping.as_deref() }
}

/// Where the results go.
pub(super) fn target(args: &ReconstructArgs) -> Result<FolderTarget, CliError> {
    let inputs: Vec<_> =
        std::iter::once(&args.log).chain(&args.scene).chain(&args.mapping).cloned().collect();
    Ok(FolderTarget::new(&args.output, &inputs, args.force)?)
}

/// Prints what came out.
pub(super) fn tell(
    console: &Console,
    made: &Reconstruction,
    mut figures: Value,
    folder: &Path,
) -> Result<Outcome, CliError> {
    figures["folder"] = folder.to_string_lossy().into();
    console.result(&describe(made, &figures, folder), &figures)?;
    Ok(if made.is_reliable() { Outcome::Done } else { Outcome::WithReservations })
}

fn describe(made: &Reconstruction, figures: &Value, folder: &Path) -> String {
    let data = &made.data;
    let mut text = format!("{}\n", data.verdict.text);
    for warning in &data.warnings {
        let _ = writeln!(text, "Warning: {warning}");
    }
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<22} {value}");
    };
    if let (Some(first), Some(last)) = (data.times.first(), data.times.last()) {
        line("samples", format!("{} over {} s", data.times.len(), brief(last - first)));
    }
    for (name, value) in bounds_and_errors(data.bounds.as_ref(), figures) {
        line(name, value);
    }
    let _ = write!(text, "{}", folder.join("report.html").display());
    text
}

/// Names and values of what is said of the bounds and, where the truth is known, of the largest errors.
pub(super) fn bounds_and_errors(bounds: Option<&Bounds>, figures: &Value) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    if let Some(bounds) = bounds {
        lines.push(("lower bound", format!("{} m^3", brief(bounds.lower.volume))));
        if let Some(upper) = &bounds.upper {
            lines.push(("upper bound", format!("{} m^3", brief(upper.volume))));
            lines.push(("lower / upper", brief_to(4, bounds.lower.volume / upper.volume)));
        }
    }
    for (name, key, unit) in [
        ("largest error: position", "position_m", "m"),
        ("  orientation", "orientation_rad", "rad"),
        ("  angular velocity", "angular_velocity_rad_per_s", "rad/s"),
    ] {
        if let Some(error) = figures["largest_error"][key].as_f64() {
            lines.push((name, format!("{error:.2e} {unit}")));
        }
    }
    lines
}
