//! Tracked files must not name folders of somebody's machine: such a path works for one person and tells of them.

use std::fs;
use std::path::Path;

use crate::cargo::{output, program, root};
use crate::steps::Outcome;

/// First folders of paths that belong to one machine or one person.
const FOLDERS: [&str; 5] = ["home", "root", "Users", "work", "mnt"];

pub(crate) fn check() -> Result<Outcome, String> {
    if !root().join(".git").exists() {
        return Ok(Outcome::Skipped("not a git checkout, so no file is tracked".to_owned()));
    }
    let tracked = output(program("git").args(["ls-files", "-z"]))?;
    let complaints: Vec<_> =
        tracked.split_terminator('\0').flat_map(|file| complaints(&root(), file)).collect();
    if complaints.is_empty() { Ok(Outcome::Passed) } else { Err(complaints.join("\n")) }
}

/// One line for each line of a file that names such a folder; files that are no text hold none.
fn complaints(root: &Path, file: &str) -> Vec<String> {
    // A file that is deleted but still tracked cannot name anything.
    let Ok(text) = fs::read_to_string(root.join(file)) else { return Vec::new() };
    let guilty = text.lines().enumerate().filter(|(_, line)| names_a_machine(line));
    guilty.map(|(index, line)| format!("{file}:{}: {}", index + 1, line.trim())).collect()
}

fn names_a_machine(line: &str) -> bool {
    FOLDERS.iter().any(|folder| {
        let pattern = format!("/{folder}/");
        line.match_indices(&pattern).any(|(at, _)| starts_a_path(&line[..at]))
    })
}

/// A slash starts an absolute path unless a name, a dot or a tilde stands before it.
fn starts_a_path(before: &str) -> bool {
    !before.ends_with(|c: char| c.is_alphanumeric() || "._-~}/".contains(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absolute_paths_into_a_machine_are_found() {
        // Written with a gap, so that this file does not name one itself.
        for line in ["see #home/me/x", "\"#Users/me/x\"", "cd #root/x", "path=#work/x", "(#mnt/x)"] {
            assert!(names_a_machine(&line.replace('#', "/")), "{line}");
        }
        for line in
            ["a/work/b", "../work/b", "~/work/b", "https://x.org/home/b", "/worker/b", "{root}/work/x"]
        {
            assert!(!names_a_machine(line), "{line}");
        }
    }
}
