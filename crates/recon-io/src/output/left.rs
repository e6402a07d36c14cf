//! What a run leaves behind that was killed: hidden files and folders whose process no longer holds them.
//!
//! Whoever writes holds a lock, which the operating system ends with the process, however that ends. Where there are no locks nothing is
//! taken for left behind.

use super::folder::is_stranded;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// The file of a hidden folder that is locked while its process lives.
const LOCK: &str = ".in-use";

/// What follows the name of the target in the name of what will take its place; then comes the number of the process.
const PARTIAL: &str = ".partial-";

/// The hidden name beside `name` of what will take its place.
pub(super) fn partial(name: &OsStr) -> std::ffi::OsString {
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!("{PARTIAL}{}", std::process::id()));
    hidden
}

/// A hidden folder in use.
#[derive(Debug)]
pub(super) struct Held {
    path: PathBuf,
    lock: Option<File>,
}

impl Held {
    /// Holds a folder that was just made.
    pub(super) fn new(folder: &Path) -> io::Result<Self> {
        let path = folder.join(LOCK);
        let file = File::create_new(&path)?;
        let _ = file.try_lock();
        Ok(Self { path, lock: Some(file) })
    }

    /// Lets go of the folder, which can be renamed then, and leaves nothing in it.
    pub(super) fn release(&mut self) -> io::Result<()> {
        self.lock = None;
        fs::remove_file(&self.path)
    }
}

/// The lock of what was left behind; none of what is in use, or holds files of an earlier run that are not back in their place.
fn lock_of_left(path: &Path) -> Option<File> {
    let is = fs::symlink_metadata(path).ok()?;
    let file = match is.is_dir() {
        true => File::open(path.join(LOCK)).ok().filter(|_| !is_stranded(path))?,
        false => Some(is.is_file()).filter(|is| *is).and_then(|_| File::open(path).ok())?,
    };
    file.try_lock().is_ok().then_some(file)
}

/// Whether nobody uses a hidden file or folder any more.
pub(super) fn is_left(path: &Path) -> bool {
    lock_of_left(path).is_some()
}

/// Removes what was left behind within `folder` under names of which `is_ours` knows; what cannot be removed stays, and is in nobody's way.
pub(super) fn clear(folder: &Path, is_ours: impl Fn(&str) -> bool) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for path in entries.map(|entry| entry.path()) {
        let named = path.file_name().and_then(OsStr::to_str).is_some_and(&is_ours);
        // Held while it is removed: nobody else takes it for left behind.
        if let Some(_lock) = Some(&path).filter(|_| named).and_then(|path| lock_of_left(path)) {
            let _ = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
        }
    }
}

/// Removes what was left behind by runs that were to write `target`.
pub(super) fn clear_beside(target: &Path) {
    if let (Some(folder), Some(name)) = (target.parent(), target.file_name().and_then(OsStr::to_str)) {
        clear(folder, |hidden| target_of(hidden) == Some(name));
    }
}

/// The name of the target in that of what was to take its place.
fn target_of(hidden: &str) -> Option<&str> {
    let (name, process) = hidden.strip_prefix('.')?.rsplit_once(PARTIAL)?;
    (!process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit())).then_some(name)
}

/// Removes from a folder that holds folders of results what runs left behind there that were killed while they wrote one.
pub fn remove_left_behind(folder: impl AsRef<Path>) {
    let folder = folder.as_ref();
    clear(folder, |hidden| target_of(hidden).is_some() && folder.join(hidden).is_dir());
}
