//! Where a path leads, and whether two paths lead to the same file.

use std::fs::{self, Metadata};
use std::io;
use std::path::{Path, PathBuf};

/// Links that are followed at most, as by the kernel.
const LINKS: usize = 40;

/// Whether what is written to `path` goes to standard output: `-`, `/dev/stdout` and its like, and links to them.
#[must_use]
pub fn is_standard_output(path: &Path) -> bool {
    let last = last_link(path);
    let own = format!("/proc/{}/fd/1", std::process::id());
    path.as_os_str() == "-"
        || ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", &own].iter().any(|name| last == Path::new(name))
}

/// The path after following links, up to one into `/proc`, which leads to an open file and not to a name.
pub(super) fn last_link(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..LINKS {
        if is_open_file(&path) {
            break;
        }
        let Ok(next) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    path
}

/// Whether a path names a file that this process holds open, as `/dev/fd/5` does.
pub(super) fn is_open_file(path: &Path) -> bool {
    let parent = path.parent().and_then(|p| fs::canonicalize(p).ok());
    parent.is_some_and(|p| p.starts_with("/proc") && p.ends_with("fd"))
}

/// The path without links; neither it nor its folder need exist.
pub(super) fn resolved(path: &Path) -> io::Result<PathBuf> {
    if let Ok(place) = fs::canonicalize(path) {
        return Ok(place);
    }
    let last = last_link(path);
    let folder = last.parent().map(|p| if p.as_os_str().is_empty() { Path::new(".") } else { p });
    match (folder.and_then(|p| fs::canonicalize(p).ok()), last.file_name()) {
        (Some(folder), Some(name)) => Ok(folder.join(name)),
        _ => std::path::absolute(last),
    }
}

/// The first of `inputs` that is the file at `place`, by name or by another link to it; where nothing is there yet, by name.
pub(super) fn input_at<'a>(place: &Path, inputs: &'a [PathBuf]) -> Option<&'a Path> {
    let there = match fs::metadata(place) {
        Ok(is) => Some(is).filter(Metadata::is_file)?,
        // Another result that is yet to be written.
        Err(_) => {
            let named = |input: &&PathBuf| resolved(opened(input)).is_ok_and(|is| is == place);
            return inputs.iter().find(named).map(PathBuf::as_path);
        }
    };
    let same = |input: &&PathBuf| {
        fs::metadata(opened(input)).is_ok_and(|is| is_same(&is, &there))
            || fs::canonicalize(opened(input)).is_ok_and(|is| is == place)
    };
    inputs.iter().find(same).map(PathBuf::as_path)
}

/// The first of `inputs` that lies in the folder at `place`, by name or by another link to a file there.
pub(super) fn input_in<'a>(place: &Path, inputs: &'a [PathBuf]) -> Option<&'a Path> {
    let within = |input: &&PathBuf| fs::canonicalize(opened(input)).is_ok_and(|is| is.starts_with(place));
    let named = inputs.iter().find(within).map(PathBuf::as_path);
    named.or_else(|| fs::read_dir(place).ok()?.flatten().find_map(|entry| input_at(&entry.path(), inputs)))
}

/// What is read where an input is `-`.
fn opened(input: &Path) -> &Path {
    if input.as_os_str() == "-" { Path::new("/dev/stdin") } else { input }
}

#[cfg(unix)]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_same(_: &Metadata, _: &Metadata) -> bool {
    false
}

#[cfg(unix)]
pub(super) fn is_block_device(is: &Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_block_device(&is.file_type())
}

#[cfg(not(unix))]
pub(super) fn is_block_device(_: &Metadata) -> bool {
    false
}
