//! `recon check-input`: what is understood of an input, before anything is estimated.

mod log;
mod touches;

use crate::cli::CheckInputArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{LogSource, PlanarSource, load, read_planar};
use recon_io::{PlanarScene, Scene, SceneErrorKind, TouchesError, TouchesErrorKind, is_bag, read_touches};
use serde_json::Value;
use std::fmt::Write;

/// What was understood: for a person, for a program, and what does not go together.
struct Understood {
    lines: Vec<(String, String)>,
    figures: Value,
    warnings: Vec<String>,
}

pub(crate) fn run(args: &CheckInputArgs, console: &Console) -> Result<Outcome, CliError> {
    let Understood { lines, mut figures, warnings } = understood(args)?;
    let mut text = format!("{}\n", args.input.display());
    for (name, value) in &lines {
        let _ = writeln!(text, "  {name:<22} {value}");
    }
    for warning in &warnings {
        let _ = writeln!(text, "Warning: {warning}");
    }
    figures["input"] = args.input.to_string_lossy().into();
    figures["warnings"] = warnings.clone().into();
    console.result(&text, &figures)?;
    Ok(if warnings.is_empty() { Outcome::Done } else { Outcome::WithReservations })
}

fn understood(args: &CheckInputArgs) -> Result<Understood, CliError> {
    if args.scene.is_none() && !is_bag(&args.input) {
        match read_touches(&args.input) {
            Ok(found) => return Ok(touches::told(&found)),
            // A header of something else: a log, which needs a scene.
            Err(TouchesError { kind: TouchesErrorKind::MissingColumn { .. }, .. }) => {}
            Err(error) => return Err(error.into()),
        }
    }
    let path = args.scene.as_ref().ok_or(CliError::LogNeedsScene)?;
    let scene = match Scene::read(path) {
        Err(error) if matches!(error.kind, SceneErrorKind::InPlane) => {
            let known = PlanarScene::read_known(path)?;
            return log::told_in_plane(&read_planar(&PlanarSource::File(&args.input), &known)?, known);
        }
        read => read?,
    };
    let loaded = load(LogSource { path: &args.input, scene: &scene, mapping: args.mapping.as_deref() })?;
    log::told(loaded, &scene)
}
