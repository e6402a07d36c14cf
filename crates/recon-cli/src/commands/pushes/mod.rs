//! `recon pushes`: outline, friction and modes from pushes by a round finger.

mod tables;
mod words;

use super::answers::written_to;
use crate::cli::PushesArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::write_files_folder;
use crate::progress::Progress;
use recon::object_dynamics::pushing::PushLog;
use recon::observer::pushes::{PushFriction, PushesEstimate, estimate_pushes};
use recon_io::{FolderTarget, Level, PushedLog, read_push_logs, write_pushes_report};
use std::collections::BTreeMap;

/// What was made of one log.
struct Told {
    number: u32,
    estimate: PushesEstimate,
    halves: Option<[PushFriction; 2]>,
}

pub(crate) fn run(args: &PushesArgs, console: &Console) -> Result<Outcome, CliError> {
    let inputs = [args.pushes.clone(), args.poses.clone()];
    let target = FolderTarget::new(&args.output, &inputs, args.force)?;
    let progress = Progress::new(2, console.is_quiet());
    progress.step("reading the pushes");
    let mut logs = read_push_logs(&args.pushes, &args.poses)?;
    if let Some(number) = args.log {
        let one = logs.remove_entry(&number).ok_or_else(|| {
            let there = logs.keys().map(u32::to_string).collect::<Vec<_>>().join(", ");
            CliError::NoPushLog { path: args.pushes.clone(), number, there }
        })?;
        logs = BTreeMap::from([one]);
    }
    progress.step("estimating outline, friction and modes");
    let mut told = Vec::new();
    for (number, log) in &logs {
        let estimate =
            estimate_pushes(log, args.radius).map_err(|source| CliError::Pushes { log: *number, source })?;
        told.push(Told { number: *number, estimate, halves: halves(log, args.radius) });
    }
    let only = told.len() == 1;
    let shown: Vec<PushedLog> = told
        .iter()
        .map(|told| PushedLog {
            number: (!only).then_some(told.number),
            told: &told.estimate,
            halves: told.halves,
            finger_radius: args.radius,
            verdict: words::verdict(told),
            warnings: words::warnings(told),
        })
        .collect();
    let mut page = Vec::new();
    let title = args.pushes.file_name().unwrap_or(args.pushes.as_os_str()).to_string_lossy().into_owned();
    write_pushes_report(&title, &shown, &mut page).map_err(CliError::Page)?;
    let mut files = tables::files(&told);
    files.push(("report.html".to_owned(), page));
    let figures = words::summary(&told, args.radius);
    write_files_folder(target, &files, &figures)?;
    drop(progress);
    let mut text: String = told.iter().map(|told| words::described(told, only)).collect();
    text += &written_to(Some(&args.output));
    console.written(&text, &figures)?;
    let sure = shown.iter().all(|log| log.verdict.level == Level::Good);
    Ok(if sure { Outcome::Done } else { Outcome::WithReservations })
}

/// Friction by the first and the second half of the pushes, each with an outline of its own; none where a half does not tell it.
fn halves(log: &PushLog, radius: f64) -> Option<[PushFriction; 2]> {
    let (first, second) = log.pushes().split_at(log.pushes().len() / 2);
    let of = |pushes: &[_]| estimate_pushes(&PushLog::new(pushes.to_vec()).ok()?, radius).ok()?.friction;
    Some([of(first)?, of(second)?])
}
