//! `recon inspect`: what a bag holds.

use super::simulate::write;
use crate::cli::InspectArgs;
use crate::console::{Console, listened};
use crate::error::{CliError, Outcome};
use recon_io::{
    BagErrorKind, BagLog, BagMapping, FileTarget, Scene, brief, is_standard_output, log_of_bag, overview,
    palms_of, read_bag, write_contact_log,
};
use serde_json::json;
use std::fmt::Write as _;
use std::io::{self, Write as _};

pub(crate) fn run(args: &InspectArgs, console: &Console) -> Result<Outcome, CliError> {
    let inputs: Vec<_> =
        std::iter::once(&args.bag).chain(&args.mapping).chain(&args.scene).cloned().collect();
    let target =
        |path: &std::path::PathBuf| Ok::<_, CliError>((FileTarget::new(path, &inputs)?, path.clone()));
    let draft_to = args.output.as_ref().filter(|path| !is_standard_output(path)).map(target).transpose()?;
    let csv_to = args.csv.as_ref().map(target).transpose()?;
    let scene = args.scene.as_ref().map(Scene::read).transpose()?;
    let stated = args.mapping.as_ref().map(BagMapping::read).transpose()?;
    let in_file = |kind: BagErrorKind| kind.in_file(&args.bag);
    let bag = read_bag(&args.bag)?;
    let name = args.bag.file_name().unwrap_or(args.bag.as_os_str()).to_string_lossy();
    let found = overview(&bag, &name).map_err(in_file)?;
    let (mut text, mut figures) = (found.text(), found.json());
    if stated.is_some() || csv_to.is_some() {
        let mapping = stated.as_ref().unwrap_or(&found.draft.mapping);
        let made = palms_of(mapping, scene.as_ref()).and_then(|palms| log_of_bag(&bag, mapping, &palms));
        let made = made.map_err(in_file)?;
        let _ = write!(text, "{}", told(&made));
        figures["log"] = json!({
            "samples": made.log.times().len(), "duration_s": made.log.duration(), "epoch_ns": made.epoch,
            "notes": made.notes, "warnings": made.warnings,
        });
        if let Some((target, path)) = csv_to {
            write(target, &path, |to| write_contact_log(&made.log, to))?;
            let _ = writeln!(text, "{}", path.display());
            figures["csv"] = path.to_string_lossy().into();
        }
    }
    match draft_to {
        Some((target, path)) => {
            write(target, &path, |to| to.write_all(found.draft.text.as_bytes()))?;
            let _ = writeln!(text, "{}", path.display());
            console.written(&text, &figures)?;
        }
        None => {
            // With the draft behind it all of it is a mapping, wherever it is sent.
            let drafts = stated.is_none() && !console.is_json();
            let text = if drafts { text.lines().map(|line| format!("# {line}\n")).collect() } else { text };
            console.result(&text, &figures)?;
            // As it is, so that it can be used with all its digits.
            if drafts {
                listened(write!(io::stdout().lock(), "\n{}", found.draft.text))?;
            }
        }
    }
    let has_palms = !found.draft.mapping.palms.is_empty();
    Ok(if found.is_whole() && has_palms { Outcome::Done } else { Outcome::WithReservations })
}

/// A log that was made of the bag, in words.
fn told(made: &BagLog) -> String {
    let mut text =
        format!("The log has {} samples over {} s.\n", made.log.times().len(), brief(made.log.duration()));
    for note in &made.notes {
        let _ = writeln!(text, "  {note}");
    }
    for warning in &made.warnings {
        let _ = writeln!(text, "Warning: {warning}");
    }
    text
}
