//! Results that appear as a whole or not at all.

mod file;
mod folder;

pub use file::AtomicFile;
pub use folder::OutputFolder;

use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a result cannot be written. Whatever stood at the target before stands there still.
#[derive(Debug, Error)]
pub enum OutputError {
    /// Something could not be created, written or put in place.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was being done.
        action: &'static str,
        /// To which path.
        path: PathBuf,
        /// Why it failed.
        source: std::io::Error,
    },
    /// The target is not something that recon wrote, so it is not replaced.
    #[error("{} exists and was not written by recon, so it is not replaced; name another folder or remove it", path.display())]
    Occupied {
        /// The target.
        path: PathBuf,
    },
    /// The target has no name of its own, as `..` or `/` has not.
    #[error("{} cannot be the name of a result; name a file or folder to be made", path.display())]
    NoName {
        /// The target.
        path: PathBuf,
    },
}

impl OutputError {
    fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::Io { action, path: path.to_owned(), source }
    }
}

/// A name beside `target`, on the same file system, that no other process uses.
fn sibling(target: &Path, purpose: &str) -> Result<PathBuf, OutputError> {
    let name = target.file_name().ok_or_else(|| OutputError::NoName { path: target.to_owned() })?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{purpose}-{}", std::process::id()));
    Ok(target.with_file_name(hidden))
}
