//! `recon batch`: all logs of a folder, on all cores; what was done before is not done again.

mod one;
mod page;
mod table;

use crate::cli::BatchArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::interrupt::{asked, check, while_writing};
use one::{Row, State, done_before, estimate_one};
use recon_io::{FileTarget, OutputError, remove_left_behind, write_batch_report};
use serde_json::json;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::thread;

/// Endings of logs.
const ENDINGS: [&str; 2] = ["csv", "mcap"];

/// Names in the folder of results that are no folders of logs.
pub(super) const TABLE: &str = "results.csv";
pub(super) const PAGE: &str = "index.html";

pub(crate) fn run(args: &BatchArgs, console: &Console) -> Result<Outcome, CliError> {
    let logs = logs_in(&args.folder, console)?;
    // Before hours of work that could not be kept, and for the table of logs of which each is skipped.
    std::fs::create_dir_all(&args.output).map_err(|source| {
        CliError::from(OutputError::Io { action: "create", path: args.output.clone(), source })
    })?;
    let all = args.jobs.unwrap_or_else(|| thread::available_parallelism().map_or(1, |count| count.get()));
    let rows: Vec<Mutex<Option<Row>>> = logs.iter().map(|_| Mutex::new(None)).collect();
    let (next, finished) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || {
        while let Some((log, row)) = {
            let k = next.fetch_add(1, Relaxed);
            logs.get(k).zip(rows.get(k))
        } {
            let made = done_before(args, log).unwrap_or_else(|| estimate_one(args, log));
            if asked() {
                break;
            }
            let so_far = finished.fetch_add(1, Relaxed) + 1;
            console.note(&format!("{so_far}/{} {}", logs.len(), made.describe()));
            if let Ok(mut row) = row.lock() {
                *row = Some(made);
            }
        }
    };
    thread::scope(|threads| {
        (1..all.min(logs.len())).for_each(|_| drop(threads.spawn(work)));
        work();
    });
    check()?;
    // Of logs that are skipped, or are no longer there, as well: no run will come past their folders.
    remove_left_behind(&args.output);
    let rows: Vec<Row> = rows.into_iter().filter_map(|row| row.into_inner().ok().flatten()).collect();
    let mut page = Vec::new();
    write_batch_report(&page::page(&args.folder, &rows), &mut page).map_err(CliError::Page)?;
    write(&args.output.join(TABLE), table::table(&rows).as_bytes())?;
    write(&args.output.join(PAGE), &page)?;
    tell(args, console, &rows)
}

/// The logs of a folder, sorted by name; two of one name would have one folder of results.
fn logs_in(folder: &Path, console: &Console) -> Result<Vec<PathBuf>, CliError> {
    let unread = |source| CliError::Folder { path: folder.to_owned(), source };
    let mut logs = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unread)? {
        let path = entry.map_err(unread)?.path();
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        if ENDINGS.contains(&ending.to_ascii_lowercase().as_str()) {
            if path.is_file() {
                logs.push(path);
            } else {
                console.note(&format!("{} is no file, and is passed over", path.display()));
            }
        }
    }
    logs.sort();
    if logs.is_empty() {
        return Err(CliError::NoLogs { path: folder.to_owned() });
    }
    let taken = [Some(TABLE), Some(PAGE), Some("."), Some("..")];
    if let Some(log) = logs.iter().find(|log| taken.contains(&log.file_stem().and_then(|stem| stem.to_str())))
    {
        return Err(CliError::LogName { path: log.clone() });
    }
    let mut stems = HashSet::new();
    match logs.iter().find(|log| !stems.insert(log.file_stem().map(ToOwned::to_owned))) {
        Some(twice) => Err(CliError::SameName { path: twice.clone() }),
        None => Ok(logs),
    }
}

fn write(path: &Path, contents: &[u8]) -> Result<(), CliError> {
    while_writing(|| {
        let mut file = FileTarget::new(path, &[])?.begin()?;
        std::io::Write::write_all(&mut file, contents).map_err(|source| OutputError::Io {
            action: "write",
            path: path.to_owned(),
            source,
        })?;
        Ok(file.commit()?)
    })
}

fn tell(args: &BatchArgs, console: &Console, rows: &[Row]) -> Result<Outcome, CliError> {
    let count = |state: State| rows.iter().filter(|row| row.state == state).count();
    let [good, doubtful, broken] = [State::ReliedOn, State::Doubtful, State::Broken].map(count);
    let before = rows.iter().filter(|row| row.before).count();
    let mut text = format!("{} logs: {good} relied on, {doubtful} not, {broken} skipped", rows.len());
    if before > 0 {
        text += &format!("; {before} of them were done before");
    }
    for row in rows.iter().filter(|row| row.state == State::Broken) {
        text += &format!("\n  {}: {}", row.log, row.why);
    }
    text += &format!("\n{}\n{}", args.output.join(TABLE).display(), args.output.join(PAGE).display());
    let figures = json!({
        "logs": rows.len(),
        "relied_on": good,
        "not_relied_on": doubtful,
        "skipped": broken,
        "done_before": before,
        "table": args.output.join(TABLE).to_string_lossy(),
        "page": args.output.join(PAGE).to_string_lossy(),
        "rows": rows.iter().map(Row::figures).collect::<Vec<_>>(),
    });
    console.written(&text, &figures)?;
    Ok(if good == rows.len() { Outcome::Done } else { Outcome::WithReservations })
}
