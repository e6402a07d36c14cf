//! Results that appear as a whole or not at all, and never in the place of what recon did not write.

mod checksum;
mod file;
mod folder;
mod left;
pub(crate) mod manifest;
mod place;
#[cfg(test)]
mod tests;

#[cfg(feature = "mcap")]
pub(crate) use checksum::Checksum;
pub use checksum::{Summed, fingerprint};
pub use file::{AtomicFile, FileTarget};
pub use folder::{FolderTarget, OutputFolder};
pub use left::remove_left_behind;
pub use place::is_standard_output;

use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a result cannot be written. Whatever stood at the target before stands there still.
#[derive(Debug, Error)]
#[non_exhaustive]
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
    /// The target is a file, and a folder is to be written.
    #[error("{} exists and is no folder; name another folder", path.display())]
    NotAFolder {
        /// The target.
        path: PathBuf,
    },
    /// The target is a folder, and a file is to be written.
    #[error("{} is a folder; name a file in it", path.display())]
    IsFolder {
        /// The target.
        path: PathBuf,
    },
    /// The target is a disk.
    #[error("{} is a block device, and what it holds would be lost; name a file", path.display())]
    BlockDevice {
        /// The target.
        path: PathBuf,
    },
    /// Something stands in the folder that is not recon's to replace.
    #[error(
        "{} holds what was not written by recon, or was changed since: {names}; name another folder, move these away, or \
         give --force to write beside them (no such file is ever replaced or removed)",
        path.display()
    )]
    Foreign {
        /// The target.
        path: PathBuf,
        /// What stands there.
        names: String,
    },
    /// A file of a result would have to take the place of one that is not recon's.
    #[error(
        "{} was not written by recon, or was changed since, so it is not replaced, --force or not; move it away or name \
         another folder",
        path.display()
    )]
    Collision {
        /// The file.
        path: PathBuf,
    },
    /// The target is an input.
    #[error("{} is the input {}, which would be lost; name another file", path.display(), input.display())]
    Input {
        /// The target.
        path: PathBuf,
        /// As it was given.
        input: PathBuf,
    },
    /// An input lies in the target.
    #[error(
        "the input {} lies in the folder {}, where results take the place of files; name another folder",
        input.display(),
        path.display()
    )]
    InputWithin {
        /// The target.
        path: PathBuf,
        /// As it was given.
        input: PathBuf,
    },
    /// The results do not hold what they say. This is a fault of recon.
    #[error("the results for {} fail their own check and are not written: {source}", path.display())]
    Certificate {
        /// The target.
        path: PathBuf,
        /// What does not hold.
        source: crate::CheckError,
    },
    /// The target has no name of its own.
    #[error("`{}` cannot be the name of a result; name a file or folder to be made", path.display())]
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
fn sibling(target: &Path) -> Result<PathBuf, OutputError> {
    let name = target.file_name().ok_or_else(|| OutputError::NoName { path: target.to_owned() })?;
    Ok(target.with_file_name(left::partial(name)))
}
