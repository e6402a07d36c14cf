//! Studies of many runs in parts: each process does its share of the runs and keeps what came of each of them in a file; what was kept makes
//! the table that one process would have made.
//!
//! `study NAME WORD.. --shard K/N --rows FOLDER` does the runs whose number leaves the rest `K` by `N`, except those that the file of this
//! part has from before. `study NAME WORD.. --merge FOLDER` does none: it prints the table from the files of all parts.

mod cells;
#[cfg(test)]
mod tests;

pub use cells::Cells;

use crate::reaching::in_threads;
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use thiserror::Error;

/// Why the runs of a part, or the table of all, cannot be had, with the value and the mend in its words.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct RowsError(#[from] Why);

#[derive(Debug, Error)]
enum Why {
    #[error("--shard needs K/N with K below N, as 0/4, and not {given:?}")]
    Shard { given: String },
    #[error("it is not made in parts: {why}")]
    Whole { why: &'static str },
    #[error(
        "after the words of the study come --shard K/N --rows FOLDER, or --merge FOLDER, and not {given:?}"
    )]
    Usage { given: String },
    #[error("{}", path.display())]
    Io { path: PathBuf, source: io::Error },
    #[error("{} is of another study: {found:?} and not {asked:?}; give another folder", path.display())]
    OtherStudy { path: PathBuf, found: Vec<String>, asked: Vec<String> },
    #[error("{}, line {line} is no run of this study; delete the file to make it anew", path.display())]
    Line { path: PathBuf, line: usize },
    #[error("what is kept of run {run} is not what this study keeps; make it anew")]
    Cells { run: usize },
    #[error("run {run} is in {} and in another file; merge parts of one division", path.display())]
    Twice { run: usize, path: PathBuf },
    #[error("run {run} is in no file; do its part first")]
    Missing { run: usize },
}

/// What one process does.
#[derive(Default)]
enum Part {
    /// All, and nothing is kept.
    #[default]
    All,
    /// Those whose number leaves the rest `k` by `n`.
    One { k: usize, n: usize, path: PathBuf, file: File },
    /// None.
    Merged,
}

struct Rows {
    part: Part,
    known: BTreeMap<usize, Vec<String>>,
    next: usize,
}

/// The runs of one study, which several threads may make.
struct Runs(Mutex<Rows>);

static RUNS: Runs = Runs::new();

/// The words of the study itself.
pub fn words() -> impl Iterator<Item = String> {
    std::env::args().skip(2).take_while(|word| !word.starts_with("--"))
}

/// Whether a study is made of runs that several processes may share.
#[derive(Clone, Copy, Debug)]
pub enum Parts {
    /// It is.
    OfRuns,
    /// It is made by one process, and why.
    Whole(&'static str),
}

/// Reads what part is asked for, and what is known of it, of a study.
///
/// # Errors
/// [`RowsError`] for parts that are none, and of studies that are not made in parts.
pub fn begin(parts: Parts) -> Result<(), RowsError> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    Ok(RUNS.asked(parts, &args)?)
}

/// What came of the next run; none where it is of another part.
///
/// # Errors
/// Those of the run, and [`RowsError`] where what is kept is not what it makes.
pub fn row<T: Cells, E: From<RowsError>>(compute: impl FnOnce() -> Result<T, E>) -> Result<Option<T>, E> {
    RUNS.next(compute)
}

/// What came of the run of this number; none where it is of another part.
///
/// # Errors
/// As [`row`].
pub fn row_of<T: Cells, E: From<RowsError>>(
    run: usize,
    compute: impl FnOnce() -> Result<T, E>,
) -> Result<Option<T>, E> {
    RUNS.of(run, compute)
}

/// What came of those of the next runs that are of this part, in their order, made by two threads.
///
/// # Errors
/// As [`row`]: the first of them.
pub fn rows_in_threads<I: Sync, T: Cells + Send, E: From<RowsError> + Send>(
    items: &[I],
    compute: impl Fn(&I) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let first = {
        let mut rows = RUNS.rows();
        rows.next += items.len();
        rows.next - items.len()
    };
    let numbered: Vec<(usize, &I)> = items.iter().enumerate().map(|(k, item)| (first + k, item)).collect();
    let made = in_threads(&numbered, |(run, item)| RUNS.of(*run, || compute(item)));
    made.into_iter().filter_map(Result::transpose).collect()
}

/// Whether runs of other parts are left out: then tables that compare runs cannot be made.
#[must_use]
pub fn is_part() -> bool {
    matches!(RUNS.rows().part, Part::One { .. })
}

impl Runs {
    const fn new() -> Self {
        Self(Mutex::new(Rows { part: Part::All, known: BTreeMap::new(), next: 0 }))
    }

    fn rows(&self) -> MutexGuard<'_, Rows> {
        // A run is known or not, also after a panic.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Of the words of the command line: those of the study, then its part.
    fn asked(&self, parts: Parts, words: &[String]) -> Result<(), Why> {
        let (study, options) =
            words.split_at(words.iter().position(|word| word.starts_with("--")).unwrap_or(words.len()));
        match parts {
            Parts::Whole(why) if !options.is_empty() => Err(Why::Whole { why }),
            _ => self.begin(study, &options.iter().map(String::as_str).collect::<Vec<_>>()),
        }
    }

    fn begin(&self, study: &[String], options: &[&str]) -> Result<(), Why> {
        let mut rows = self.rows();
        match *options {
            [] => {}
            ["--shard", of, "--rows", folder] => {
                let parts = of.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
                let (k, n): (usize, usize) =
                    parts.filter(|(k, n)| k < n).ok_or_else(|| Why::Shard { given: of.to_owned() })?;
                let path = Path::new(folder).join(format!("{k}-of-{n}.rows"));
                let io = |source| Why::Io { path: path.clone(), source };
                fs::create_dir_all(folder).map_err(io)?;
                let mut file = OpenOptions::new().create(true).append(true).open(&path).map_err(io)?;
                let whole = rows.read(&path, study)?;
                // Of a line that was begun and not ended nothing is kept.
                file.set_len(whole).map_err(io)?;
                if whole == 0 {
                    file.write_all(line(study).as_bytes()).map_err(io)?;
                }
                rows.part = Part::One { k, n, path, file };
            }
            ["--merge", folder] => {
                let io = |source| Why::Io { path: folder.into(), source };
                for entry in fs::read_dir(folder).map_err(io)? {
                    let path = entry.map_err(io)?.path();
                    if path.extension().is_some_and(|of| of == "rows") {
                        rows.read(&path, study)?;
                    }
                }
                rows.part = Part::Merged;
            }
            _ => return Err(Why::Usage { given: options.join(" ") }),
        }
        Ok(())
    }

    fn next<T: Cells, E: From<RowsError>>(
        &self,
        compute: impl FnOnce() -> Result<T, E>,
    ) -> Result<Option<T>, E> {
        let run = {
            let mut rows = self.rows();
            rows.next += 1;
            rows.next - 1
        };
        self.of(run, compute)
    }

    fn of<T: Cells, E: From<RowsError>>(
        &self,
        run: usize,
        compute: impl FnOnce() -> Result<T, E>,
    ) -> Result<Option<T>, E> {
        {
            let rows = self.rows();
            if let Some(cells) = rows.known.get(&run) {
                return Ok(Some(T::of_row(cells).ok_or(RowsError(Why::Cells { run }))?));
            }
            match rows.part {
                Part::Merged => return Err(RowsError(Why::Missing { run }).into()),
                Part::One { k, n, .. } if run % n != k => return Ok(None),
                _ => {}
            }
        }
        let made = compute()?;
        if let Part::One { path, file, .. } = &mut self.rows().part {
            let mut cells = vec![run.to_string()];
            made.write(&mut cells);
            let written = file.write_all(line(&cells).as_bytes());
            written.map_err(|source| RowsError(Why::Io { path: path.clone(), source }))?;
        }
        Ok(Some(made))
    }
}

/// Cells as one line.
fn line(cells: &[String]) -> String {
    format!("{}\n", serde_json::Value::from(cells))
}

impl Rows {
    /// Reads the whole lines of a file of one part; returns how many bytes they have.
    fn read(&mut self, path: &Path, study: &[String]) -> Result<u64, Why> {
        let text = fs::read_to_string(path).map_err(|source| Why::Io { path: path.to_owned(), source })?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        for (i, text) in text[..whole].lines().enumerate() {
            let wrong = || Why::Line { path: path.to_owned(), line: i + 1 };
            let mut cells: Vec<String> = serde_json::from_str(text).map_err(|_| wrong())?;
            if i == 0 {
                if cells != study {
                    let (path, asked) = (path.to_owned(), study.to_vec());
                    return Err(Why::OtherStudy { path, found: cells, asked });
                }
                continue;
            }
            let run = cells.first().and_then(|cell| cell.parse().ok()).ok_or_else(wrong)?;
            cells.remove(0);
            if self.known.insert(run, cells).is_some() {
                return Err(Why::Twice { run, path: path.to_owned() });
            }
        }
        Ok(whole as u64)
    }
}
