use super::answers::{Advice, bounds_and_errors, evidence, of_body};
use crate::cli::ReconstructArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{Asked, Estimated, LogSource, Reconstruction, estimated, meshes_as, read_log};
use crate::progress::Progress;
use recon_io::{FolderTarget, Scene, SceneErrorKind, brief, brief_to};
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
    let progress = Progress::new(4, console.is_quiet());
    progress.step("reading the log");
    let title = args.log.file_name().unwrap_or(args.log.as_os_str()).to_string_lossy();
    let read = read_log(source(args, &scene), console)?;
    let stand = read.stand;
    let asked = Asked { path: &args.log, scene: &scene, title: &title, identify: args.identify };
    let made = estimated(read, &asked, &progress)?;
    progress.step("writing the results");
    let mut extras = made.extras(&args.export, args.export_shape, args.mcap.then_some(stand))?;
    extras.extend(meshes_as(made.surfaces(), &args.mesh)?);
    let figures = made.write(target, &extras)?;
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
    made: &Estimated,
    mut figures: Value,
    folder: &Path,
) -> Result<Outcome, CliError> {
    figures["folder"] = folder.to_string_lossy().into();
    let text = format!("{}{}", describe(made, &figures), folder.join("report.html").display());
    console.result(&text, &figures)?;
    Ok(if made.is_reliable() { Outcome::Done } else { Outcome::WithReservations })
}

/// What came out, in words; `figures` are those of its summary.
pub(crate) fn describe(made: &Estimated, figures: &Value) -> String {
    match made {
        Estimated::Planes(made, _) => of_planes(made, figures),
        Estimated::AnyPalms(made, _) => super::any_palms::describe(&made.data, figures),
    }
}

fn of_planes(made: &Reconstruction, figures: &Value) -> String {
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
    for (name, value) in of_body(&made.mass, figures) {
        line(name, value);
    }
    let known = ["std_position", "std_velocity", "std_orientation"].map(|key| evidence(figures, key));
    if let [Some(position), Some(velocity), Some(turn)] = known {
        let [position, velocity, turn] = [position, velocity, turn].map(|std| brief_to(2, std));
        line("motion known to", format!("{position} m, {velocity} m/s, {turn} rad (std)"));
    }
    if let Some(weakest) = figures["evidence"]["weakest"]["value"].as_str() {
        line("least certain", weakest.to_owned());
    }
    for (name, value) in bounds_and_errors(data.bounds.as_ref(), figures) {
        line(name, value);
    }
    let advice = Advice {
        reliable: made.is_reliable(),
        bounds: data.bounds.as_ref(),
        identified: made.identified.is_some(),
        learned: true,
    };
    line("next", advice.next().to_owned());
    text
}
