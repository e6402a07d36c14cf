use crate::cli::ReconstructArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{LogOf, Reconstruction, exported, read_log, reconstruct, write_reconstruction_folder};
use crate::progress::Progress;
use recon_io::{Bounds, FolderTarget, Scene, brief, brief_to};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

pub(crate) fn run(args: &ReconstructArgs, console: &Console) -> Result<Outcome, CliError> {
    if args.without_forces {
        return super::without_forces::run(args, console);
    }
    let scene = args.scene.as_ref().map(Scene::read).transpose()?.ok_or(CliError::UnknownBody)?;
    let target = target(args)?;
    let progress = Progress::new(4, console.is_json());
    progress.step("reading the log");
    let (log, moved) = match read_log(&args.log, &scene)? {
        LogOf::ThreePalms(log, moved) => (log, moved),
        LogOf::AnyPalms(log, why) => {
            return super::any_palms::run(args, &scene, (*log, why), (target, progress), console);
        }
    };
    let name = args.log.file_name().unwrap_or(args.log.as_os_str()).to_string_lossy();
    let mut made = reconstruct(log, &scene, &name, args.identify, &progress)?;
    made.data.warnings.extend(moved);
    progress.step("writing the results");
    let files = exported(&made, &args.export, args.export_shape)?;
    let extras: Vec<_> = files.into_iter().map(|file| (file.name, file.contents)).collect();
    let figures = write_reconstruction_folder(target, &made, &extras)?;
    drop(progress);
    tell(console, &made, figures, &args.output)
}

/// Where the results go.
pub(super) fn target(args: &ReconstructArgs) -> Result<FolderTarget, CliError> {
    let inputs: Vec<_> = std::iter::once(&args.log).chain(&args.scene).cloned().collect();
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
