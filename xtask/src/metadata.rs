//! What `cargo metadata` knows about the workspace, cut down to what the checks ask.

use std::collections::HashMap;

use serde_json::Value;

use crate::cargo::{cargo, output};

/// Kind of a dependency.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Normal,
    Build,
    Dev,
}

/// A dependency that the resolver chose: index of the package and why it is needed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Edge {
    pub(crate) to: usize,
    pub(crate) kinds: Vec<Kind>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Package {
    pub(crate) name: String,
    pub(crate) version: String,
    pub(crate) licence: Option<String>,
    /// `None` for a package in a folder of ours.
    pub(crate) source: Option<String>,
    pub(crate) manifest: String,
    /// Names of its Cargo features, `default` among them.
    pub(crate) features: Vec<String>,
    pub(crate) member: bool,
    /// What its library is called.
    pub(crate) library: String,
    /// Whether the registry may have it.
    pub(crate) published: bool,
    /// What a registry wants to know and its manifest does not say.
    pub(crate) lacking: Vec<&'static str>,
    pub(crate) edges: Vec<Edge>,
}

/// All packages of the workspace and below it, for all features and platforms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Metadata {
    pub(crate) root: String,
    pub(crate) packages: Vec<Package>,
}

impl Metadata {
    /// Asks cargo; the lock file must be up to date.
    pub(crate) fn load() -> Result<Self, String> {
        let line = "metadata --format-version 1 --all-features --locked";
        let text = output(&mut cargo(line))?;
        let value = serde_json::from_str(&text).map_err(|error| format!("cargo metadata: {error}"))?;
        Self::parse(&value).ok_or_else(|| "cargo metadata is not of format version 1".to_owned())
    }

    pub(crate) fn parse(value: &Value) -> Option<Self> {
        let members: Vec<&str> = texts(&value["workspace_members"])?;
        let mut indices = HashMap::new();
        let mut packages = Vec::new();
        for package in value["packages"].as_array()? {
            let id = package["id"].as_str()?;
            indices.insert(id, packages.len());
            packages.push(parse_package(package, members.contains(&id))?);
        }
        for node in value["resolve"]["nodes"].as_array()? {
            let from = *indices.get(node["id"].as_str()?)?;
            for dependency in node["deps"].as_array()? {
                let to = *indices.get(dependency["pkg"].as_str()?)?;
                let kinds =
                    dependency["dep_kinds"].as_array()?.iter().map(parse_kind).collect::<Option<_>>()?;
                packages[from].edges.push(Edge { to, kinds });
            }
        }
        Some(Self { root: value["workspace_root"].as_str()?.to_owned(), packages })
    }

    /// The members that a registry may have, in the order of their names.
    pub(crate) fn published(&self) -> impl Iterator<Item = &Package> {
        self.members().filter(|package| package.published)
    }

    pub(crate) fn members(&self) -> impl Iterator<Item = &Package> {
        self.packages.iter().filter(|package| package.member)
    }

    /// The way from a package to each package that is built into it (its normal and build dependencies and theirs),
    /// by name, the nearest first.
    pub(crate) fn ways_into<'a>(&'a self, from: &'a Package) -> Vec<Vec<&'a str>> {
        let mut seen = vec![false; self.packages.len()];
        let mut ways: Vec<(Vec<&str>, &Package)> = vec![(vec![from.name.as_str()], from)];
        let mut next = 0;
        while next < ways.len() {
            let (way, package) = ways[next].clone();
            next += 1;
            for edge in &package.edges {
                let built_in = edge.kinds.iter().any(|kind| *kind != Kind::Dev);
                if built_in && !std::mem::replace(&mut seen[edge.to], true) {
                    let to = &self.packages[edge.to];
                    ways.push(([way.as_slice(), &[to.name.as_str()]].concat(), to));
                }
            }
        }
        ways.into_iter().skip(1).map(|(way, _)| way).collect()
    }
}

/// What a registry wants to know of a package.
const WANTED: [&str; 5] = ["description", "license", "repository", "documentation", "readme"];

/// What the library of a package is called.
fn library(package: &Value) -> Option<String> {
    let is_library =
        |target: &&Value| target["kind"].as_array().is_some_and(|kinds| kinds.contains(&"lib".into()));
    package["targets"].as_array()?.iter().find(is_library)?["name"].as_str().map(str::to_owned)
}

fn parse_package(package: &Value, member: bool) -> Option<Package> {
    let text = |key: &str| package[key].as_str().map(str::to_owned);
    Some(Package {
        name: text("name")?,
        version: text("version")?,
        licence: text("license"),
        source: text("source"),
        manifest: text("manifest_path")?,
        features: package["features"].as_object()?.keys().cloned().collect(),
        member,
        library: library(package).or_else(|| text("name").map(|name| name.replace('-', "_")))?,
        published: !package["publish"].is_array(),
        lacking: WANTED.into_iter().filter(|field| package[field].is_null()).collect(),
        edges: Vec::new(),
    })
}

fn parse_kind(dependency: &Value) -> Option<Kind> {
    match &dependency["kind"] {
        Value::Null => Some(Kind::Normal),
        Value::String(kind) if kind == "build" => Some(Kind::Build),
        Value::String(kind) if kind == "dev" => Some(Kind::Dev),
        _ => None,
    }
}

fn texts(value: &Value) -> Option<Vec<&str>> {
    value.as_array()?.iter().map(Value::as_str).collect()
}

#[cfg(test)]
pub(crate) mod made_up {
    //! Metadata of a workspace that does not exist, in cargo's own format, so that the parser is tested with it.

    use serde_json::{Value, json};

    use super::Metadata;

    /// Packages as `name: dependency dependency/dev`, members first; a package after `|` comes from the registry.
    pub(crate) fn workspace(lines: &[&str]) -> Metadata {
        let mut packages = Vec::new();
        let mut nodes = Vec::new();
        let mut members = Vec::new();
        for line in lines {
            let (name, dependencies) = line.split_once(':').expect("name: dependencies");
            let foreign = name.strip_prefix('|');
            let name = foreign.unwrap_or(name);
            if foreign.is_none() {
                members.push(name);
            }
            packages.push(package(name, foreign.is_some()));
            let deps: Vec<Value> = dependencies.split_whitespace().map(dependency).collect();
            nodes.push(json!({ "id": name, "deps": deps }));
        }
        let value = json!({
            "workspace_members": members, "workspace_root": "/ws", "packages": packages, "resolve": { "nodes": nodes }
        });
        Metadata::parse(&value).expect("it is in cargo's format")
    }

    fn package(name: &str, foreign: bool) -> Value {
        json!({
            "id": name, "name": name.split('@').next(), "version": name.split('@').nth(1).unwrap_or("1.0.0"),
            "license": "MIT", "manifest_path": format!("/ws/{name}/Cargo.toml"), "features": { "default": [] },
            "source": foreign.then_some(crate::verify::DEFAULT_REGISTRY),
        })
    }

    fn dependency(word: &str) -> Value {
        let (name, kind) = word.split_once('/').map_or((word, None), |(name, kind)| (name, Some(kind)));
        json!({ "pkg": name, "dep_kinds": [{ "kind": kind }] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_leads_through_normal_and_build_dependencies_only() {
        let metadata = made_up::workspace(&["a: b c/dev", "b: d/build", "|c: e", "|d:", "|e:"]);
        let ways = metadata.ways_into(&metadata.packages[0]);
        assert_eq!(ways, [vec!["a", "b"], vec!["a", "b", "d"]]);
    }

    #[test]
    fn circles_of_dependencies_end() {
        let metadata = made_up::workspace(&["a: b", "b: a b"]);
        assert_eq!(metadata.ways_into(&metadata.packages[0]).len(), 2);
    }

    #[test]
    fn another_format_is_refused() {
        assert_eq!(Metadata::parse(&serde_json::json!({ "packages": [] })), None);
    }
}
