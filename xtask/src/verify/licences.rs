//! Licences and sources of all packages. cargo-deny looks closer where it is installed; this needs nothing.

use std::path::Path;

use super::DEFAULT_REGISTRY;
use super::spdx::is_allowed;
use crate::metadata::{Metadata, Package};

/// The same list as in `deny.toml`.
const ALLOWED: [&str; 7] = [
    "MIT",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "Zlib",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "Unicode-3.0",
];

/// One line for each package whose licence is missing, broken or not allowed.
pub(crate) fn complaints(metadata: &Metadata) -> Vec<String> {
    metadata.packages.iter().filter_map(complaint).collect()
}

fn complaint(package: &Package) -> Option<String> {
    let named = format!("{} {}", package.name, package.version);
    let Some(licence) = &package.licence else {
        return Some(format!("{named}: no licence in its manifest"));
    };
    match is_allowed(licence, &ALLOWED) {
        Ok(true) => None,
        Ok(false) => Some(format!("{named}: {licence} is not allowed")),
        Err(what) => Some(format!("{named}: {licence:?} is no licence expression: {what}")),
    }
}

/// One line for each package that is neither in the workspace nor from the default registry.
pub(crate) fn foreign_sources(metadata: &Metadata) -> Vec<String> {
    let foreign = |package: &&Package| match &package.source {
        Some(source) => source != DEFAULT_REGISTRY,
        None => !Path::new(&package.manifest).starts_with(&metadata.root),
    };
    let say = |package: &Package| {
        let place = package.source.as_deref().unwrap_or("a folder outside of the workspace");
        format!("{} {} comes from {place}", package.name, package.version)
    };
    metadata.packages.iter().filter(foreign).map(say).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metadata::made_up::workspace;

    #[test]
    fn packages_without_an_allowed_licence_are_caught() {
        let mut metadata = workspace(&["ours: good copyleft none", "|good:", "|copyleft:", "|none:"]);
        assert_eq!(complaints(&metadata), Vec::<String>::new());
        metadata.packages[2].licence = Some("AGPL-3.0-only".to_owned());
        metadata.packages[3].licence = None;
        let found = complaints(&metadata);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].contains("copyleft") && found[1].contains("none"), "{found:?}");
    }

    #[test]
    fn git_other_registries_and_folders_elsewhere_are_caught() {
        let mut metadata = workspace(&["ours: a b c d", "|a:", "|b:", "|c:", "|d:"]);
        assert_eq!(foreign_sources(&metadata), Vec::<String>::new());
        metadata.packages[2].source = Some("git+https://example.org/b".to_owned());
        metadata.packages[3].source = Some("registry+https://example.org/index".to_owned());
        metadata.packages[4].source = None;
        metadata.packages[4].manifest = "/elsewhere/d/Cargo.toml".to_owned();
        let found = foreign_sources(&metadata);
        assert_eq!(found.len(), 3, "{found:?}");
    }

    #[test]
    fn the_list_is_that_of_cargo_deny() {
        let deny =
            std::fs::read_to_string(crate::cargo::root().join("deny.toml")).expect("deny.toml is there");
        let list = deny
            .split("allow = [")
            .nth(1)
            .and_then(|rest| rest.split(']').next())
            .expect("a list of licences");
        let listed: Vec<_> = list
            .split(',')
            .map(|word| word.trim().trim_matches('"'))
            .filter(|word| !word.is_empty())
            .collect();
        assert_eq!(listed, ALLOWED);
    }
}
