//! Steps that build: format, lints, docs, tests, and the crates and features one by one.

use super::arrows;
use crate::cargo::{cargo, run};
use crate::metadata::Metadata;
use crate::steps::Outcome;

pub(crate) fn format() -> Result<Outcome, String> {
    all(["fmt --all --check".to_owned()])
}

/// The module for Python as well, which is checked without a Python, and the study of another reader.
pub(crate) fn lint() -> Result<Outcome, String> {
    all(["clippy --workspace --all-targets --features recon-py/extension,recon-benches/urdf -- -D warnings"
        .to_owned()])
}

/// Of what others use. Libraries only: the command of `recon-cli` has the name of the facade, and their pages would overwrite each other.
pub(crate) fn docs() -> Result<Outcome, String> {
    run(cargo("doc --workspace --exclude recon-benches --exclude recon-tests --no-deps --lib")
        .env("RUSTDOCFLAGS", "-D warnings"))?;
    Ok(Outcome::Passed)
}

pub(crate) fn tests() -> Result<Outcome, String> {
    all(["test --workspace".to_owned()])
}

/// With every seed and every case: of tests that are one thing many times over `tests` runs a decisive part.
pub(crate) fn all_tests() -> Result<Outcome, String> {
    run(cargo("test --workspace").env("RECON_TESTS", "all"))?;
    Ok(Outcome::Passed)
}

/// By the profile that the tests are built with.
pub(crate) fn atlas() -> Result<Outcome, String> {
    all(["run --package recon-benches --bin study -- atlas smoke".to_owned()])
}

/// The command as well, which one of them times.
pub(crate) fn charts() -> Result<Outcome, String> {
    all([
        "build --package recon-benches --package recon-touch-cli --bins",
        "run --package recon-benches --bin study -- chart --smoke",
    ]
    .map(str::to_owned))
}

/// In a build of the whole workspace a crate that may be picked alone sees the features that others switch on in its dependencies. Here
/// it has its own only, and the least of them. Its tests are compiled and not run: they ran with the workspace, and
/// what a feature of a dependency changes is whether something is there.
pub(crate) fn alone() -> Result<Outcome, String> {
    let with = |name: &str, features: &str| {
        format!("clippy --package {name} {features} --all-targets -- -D warnings")
    };
    let metadata = Metadata::load()?;
    let by_default = |name: &str| {
        metadata.members().any(|of| of.name == name && of.features.iter().any(|of| of == "default"))
    };
    let least = |name| by_default(name).then(|| with(name, "--no-default-features"));
    all(arrows::alone().flat_map(|name| [Some(with(name, "")), least(name)]).flatten())
}

/// The fuzz targets without libFuzzer.
pub(crate) fn fuzz() -> Result<Outcome, String> {
    all(["fmt --all --check --manifest-path fuzz/Cargo.toml".to_owned()]
        .into_iter()
        .chain(["clippy", "test"].map(|line| format!("{line} --locked --manifest-path fuzz/Cargo.toml"))))
}

/// Their features are on where everything is linted, and no crate has them in its tree.
const LINTED: [&str; 2] = ["recon-py", "recon-benches"];

/// All features of all members, each without the others and without the default ones. By clippy as the steps before, since what that
/// has checked a plain check would check again.
pub(crate) fn features() -> Result<Outcome, String> {
    all(feature_lines(&Metadata::load()?))
}

fn feature_lines(metadata: &Metadata) -> Vec<String> {
    let pairs =
        metadata.members().flat_map(|member| member.features.iter().map(move |feature| (member, feature)));
    let pairs =
        pairs.filter(|(member, feature)| *feature != "default" && !LINTED.contains(&member.name.as_str()));
    let line = |package: &str, feature: &str| {
        format!("clippy --package {package} --no-default-features --features {feature} -- -D warnings")
    };
    pairs.map(|(member, feature)| line(&member.name, feature)).collect()
}

/// Runs all lines; the complaint names each one that failed.
fn all(lines: impl IntoIterator<Item = String>) -> Result<Outcome, String> {
    let complaints: Vec<_> = lines.into_iter().filter_map(|line| run(&mut cargo(&line)).err()).collect();
    if complaints.is_empty() { Ok(Outcome::Passed) } else { Err(complaints.join("\n")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metadata::made_up::workspace;

    #[test]
    fn features_are_those_of_the_members() {
        let mut metadata = workspace(&["a: b", "|b:"]);
        for package in &mut metadata.packages {
            package.features = ["default", "noise", "serde"].map(str::to_owned).into();
        }
        let lines = feature_lines(&metadata);
        let with = |line: &String, feature: &str| {
            line.contains(&format!("--package a --no-default-features --features {feature}"))
        };
        assert!(lines.len() == 2 && with(&lines[0], "noise") && with(&lines[1], "serde"), "{lines:?}");
    }

    #[test]
    fn this_workspace_has_features_to_check() {
        let lines = feature_lines(&Metadata::load().expect("cargo describes this workspace"));
        assert!(lines.iter().any(|line| line.contains("--package touch-observer")), "{lines:?}");
    }

    #[test]
    fn every_line_that_fails_is_named() {
        let complaint = all(["no-such-command-a", "--version", "no-such-command-b"].map(str::to_owned));
        let complaint = complaint.expect_err("two of them do not exist");
        assert!(complaint.lines().count() == 2 && complaint.contains("command-a"), "{complaint}");
    }
}
