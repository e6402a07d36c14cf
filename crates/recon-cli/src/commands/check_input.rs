//! `recon check-input`: what is understood of an input, before anything is estimated.

mod log;
mod page;
mod touches;

use super::simulate::write as write_file;
use crate::cli::CheckInputArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{LogSource, PlanarSource, load, read_planar};
use recon::object_dynamics::ContactLog;
use recon_io::{
    FileTarget, PlanarScene, Scene, SceneErrorKind, Touches, TouchesError, TouchesErrorKind, is_bag,
    read_touches, write_figures_page,
};
use serde_json::Value;
use std::fmt::Write;

/// What was understood: for a person, for a program, and what does not go together.
struct Understood {
    lines: Vec<(String, String)>,
    figures: Value,
    warnings: Vec<String>,
    readings: Readings,
}

/// What was read, for pictures.
enum Readings {
    /// With the times between which samples are missing, s.
    Log(Box<ContactLog>, Vec<[f64; 2]>),
    Touches(Touches),
}

pub(crate) fn run(args: &CheckInputArgs, console: &Console) -> Result<Outcome, CliError> {
    let inputs: Vec<_> =
        std::iter::once(&args.input).chain(&args.scene).chain(&args.mapping).cloned().collect();
    let target = args.report.as_ref().map(|path| FileTarget::new(path, &inputs)).transpose()?;
    let understood = understood(args)?;
    let title = args.input.file_name().unwrap_or(args.input.as_os_str()).to_string_lossy().into_owned();
    if let (Some(target), Some(path)) = (target, &args.report) {
        let page = page::page(title, &understood);
        write_file(target, path, |to| write_figures_page(&page, to))?;
    }
    let Understood { lines, mut figures, warnings, .. } = understood;
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
            Ok(found) => return Ok(touches::told(found)),
            // A header of something else: a log, perhaps, which needs a scene.
            Err(contacts @ TouchesError { kind: TouchesErrorKind::MissingColumn { .. }, .. }) => {
                return Err(CliError::NeitherTouches { contacts });
            }
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
