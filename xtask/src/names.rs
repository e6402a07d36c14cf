//! The public names of each crate as a list, so that one that goes is seen in review: `docs/names.txt`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::cargo::root;
use crate::landing::folder;
use crate::metadata::Metadata;

const LIST: &str = "docs/names.txt";
const ITEMS: [&str; 8] = ["struct", "enum", "trait", "fn", "const", "type", "static", "union"];

/// Writes the list.
pub(crate) fn write() -> Result<Vec<String>, String> {
    let path = root().join(LIST);
    std::fs::write(&path, list(&Metadata::load()?)?).map_err(|error| format!("{LIST}: {error}"))?;
    Ok(vec![path.display().to_string()])
}

/// One line for each name that went or came since the list was written.
pub(crate) fn complaints(metadata: &Metadata) -> Result<Vec<String>, String> {
    let now = list(metadata)?;
    let listed = std::fs::read_to_string(root().join(LIST)).unwrap_or_default();
    let (now, listed): (BTreeSet<&str>, BTreeSet<&str>) = (now.lines().collect(), listed.lines().collect());
    let gone = listed.difference(&now).map(|name| format!("{name}: is public in {LIST} alone"));
    let new = now.difference(&listed).map(|name| format!("{name}: is not in {LIST}"));
    let mut all: Vec<String> = gone.chain(new).collect();
    if !all.is_empty() {
        all.push(
            "names that go break others: say so in the CHANGELOG.md, then run `cargo xtask names`".to_owned(),
        );
    }
    Ok(all)
}

fn list(metadata: &Metadata) -> Result<String, String> {
    let mut lines = BTreeSet::new();
    for package in metadata.published() {
        let source = folder(package).join("src");
        if source.join("lib.rs").is_file() {
            names(&source.join("lib.rs"), &source, &package.library, &mut lines)?;
        }
    }
    Ok(lines.into_iter().map(|line| line + "\n").collect())
}

/// Adds what the file of a module makes public, `inside` being the folder of its modules. Names are read off the text: what macros make is not seen.
fn names(file: &Path, inside: &Path, path: &str, lines: &mut BTreeSet<String>) -> Result<(), String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    for (at, _) in text.match_indices("\npub ") {
        let rest = &text[at + 5..];
        let (word, tail) = rest.split_once(' ').unwrap_or((rest, ""));
        if word == "use" {
            for used in leaves(tail.split(';').next().unwrap_or_default()) {
                let last = used.rsplit("::").next().unwrap_or_default();
                let (from, name) = used.split_once(" as ").unwrap_or((&used, last));
                module(inside, &from.split("::").collect::<Vec<_>>(), &format!("{path}::{name}"), lines)?;
            }
            continue;
        }
        let tail = if word == "const" { tail.strip_prefix("fn ").unwrap_or(tail) } else { tail };
        let name: String = tail.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        if word == "mod" {
            module(inside, &[&name], &format!("{path}::{name}"), lines)?;
        } else if ITEMS.contains(&word) {
            lines.insert(format!("{path}::{name}"));
        }
    }
    Ok(())
}

/// Adds an item that is named, with all that is in it where it is a module of this crate.
fn module(inside: &Path, steps: &[&str], path: &str, lines: &mut BTreeSet<String>) -> Result<(), String> {
    lines.insert(path.to_owned());
    match found(inside, steps) {
        Some((file, folder)) => names(&file, &folder, path, lines),
        None => Ok(()),
    }
}

/// The file of a module below a folder, and the folder of its own modules.
fn found(inside: &Path, steps: &[&str]) -> Option<(PathBuf, PathBuf)> {
    let folder = steps.iter().fold(inside.to_owned(), |folder, step| folder.join(step));
    let files = [folder.join("mod.rs"), folder.with_extension("rs")];
    files.into_iter().find(|file| file.is_file()).map(|file| (file, folder))
}

/// The paths of a tree of uses: `a::{b, c::d}` are `a::b` and `a::c::d`.
fn leaves(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((before, within)) = tree.split_once('{') else { return vec![tree.to_owned()] };
    let within = within.strip_suffix('}').unwrap_or(within);
    let (mut depth, mut parts) = (0, vec![String::new()]);
    for c in within.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        match parts.last_mut() {
            Some(last) if c != ',' || depth > 0 => last.push(c),
            _ => parts.push(String::new()),
        }
    }
    let parts = parts.iter().filter(|part| !part.trim().is_empty());
    parts.flat_map(|part| leaves(part)).map(|leaf| format!("{before}{leaf}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uses_are_taken_apart() {
        assert_eq!(leaves("a::{B, c::{D, E},\n F as G}"), ["a::B", "a::c::D", "a::c::E", "a::F as G"]);
    }

    #[test]
    fn names_behind_modules_that_are_used_in_public_are_found() {
        let all = list(&Metadata::load().expect("cargo describes this workspace")).expect("it can be read");
        for name in ["observer::bank::Bank", "observer::Model", "shape_bounds::planar::fit::OutlineFit"] {
            assert!(all.lines().any(|line| line == name), "{name}");
        }
        assert!(!all.contains("observer::core"));
    }
}
