//! Crates whose types cross our interfaces: with two versions in the tree, equal names would be different types.
//!
//! `cargo metadata` lists more than is built (nalgebra names every version of glam that it could convert from), so
//! this asks `cargo tree`, which lists what the chosen features bring in.

use crate::cargo::{cargo, output};
use crate::steps::Outcome;

const ONE_VERSION: [&str; 3] = ["glam", "nalgebra", "parry3d-f64"];

pub(crate) fn check() -> Result<Outcome, String> {
    let complaints = complaints(&tree()?);
    if complaints.is_empty() { Ok(Outcome::Passed) } else { Err(complaints.join("\n")) }
}

/// All packages for all features and platforms, one `name vVERSION` a line, repeated as often as they are needed.
fn tree() -> Result<String, String> {
    let options = "--workspace --all-features --target all --edges normal,build,dev --prefix none --locked";
    output(&mut cargo(&format!("tree {options}")))
}

/// One line for each crate that is not there in exactly one version.
fn complaints(tree: &str) -> Vec<String> {
    let complaint = |name: &&str| {
        let mut versions: Vec<_> = tree.lines().filter_map(|line| version_of(line, name)).collect();
        versions.sort_unstable();
        versions.dedup();
        (versions.len() != 1).then(|| format!("{name}: {versions:?} in the tree instead of one version"))
    };
    ONE_VERSION.iter().filter_map(complaint).collect()
}

fn version_of<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let mut words = line.split_whitespace();
    (words.next()? == name).then(|| words.next()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_workspace_has_one_glam_and_one_nalgebra() {
        assert_eq!(complaints(&tree().expect("cargo shows the tree")), Vec::<String>::new());
    }

    #[test]
    fn two_versions_and_none_are_caught() {
        let tree =
            "us v0.1.0 (somewhere)\nglam v0.33.12\nparry3d-f64 v0.31.1\nglam v0.34.0\nglam v0.33.12 (*)\n";
        let found = complaints(tree);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].contains("0.33.12") && found[0].contains("0.34.0"), "{found:?}");
        assert!(found[1].starts_with("nalgebra: []"), "{found:?}");
    }
}
