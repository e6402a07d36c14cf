use crate::cli::ReconstructArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{Asked, Estimated, LogSource, estimated, explained, meshes_as, read_log};
use crate::progress::Progress;
use recon_io::{FolderTarget, Scene, SceneErrorKind};
use serde_json::Value;
use std::path::Path;

pub(crate) fn run(args: &ReconstructArgs, console: &Console) -> Result<Outcome, CliError> {
    let lacking = if args.without_forces { CliError::NoGravity } else { CliError::LogNeedsScene };
    let path = args.scene.as_ref().ok_or(lacking)?;
    let scene = match Scene::read(path) {
        Err(error) if matches!(error.kind, SceneErrorKind::InPlane) => {
            return super::planar::reconstruct(args, path, console);
        }
        read => read?,
    };
    if args.without_forces {
        return super::without_forces::run(args, &scene, console);
    }
    let target = target(args)?;
    let progress = Progress::new(4, console.is_quiet());
    progress.step("reading the log");
    let title = args.log.file_name().unwrap_or(args.log.as_os_str()).to_string_lossy();
    let read = read_log(source(args, &scene), console)?;
    let epoch = read.epoch;
    let asked = Asked {
        path: &args.log,
        scene: &scene,
        title: &title,
        identify: args.identify,
        accuracy: args.accuracy,
        covariances: args.covariance || args.mcap,
    };
    let made = estimated(read, &asked, &progress)?;
    progress.step("writing the results");
    let mut extras = made.extras(&args.export, args.export_shape, args.mcap.then_some(epoch))?;
    extras.extend(meshes_as(made.surfaces(), &args.mesh)?);
    if args.covariance {
        extras.push(made.covariances()?);
    }
    let figures = made.write(target, &extras)?;
    drop(progress);
    if let Some(choice) = made.made.choice.as_ref().filter(|_| args.explain) {
        console.note(&explained(choice, true));
    }
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
    console.written(&text, &figures)?;
    Ok(if made.is_reliable() { Outcome::Done } else { Outcome::WithReservations })
}

/// What came out, in words; `figures` are those of its summary.
pub(crate) fn describe(made: &Estimated, figures: &Value) -> String {
    super::any_palms::describe(&made.made.data, figures)
}
