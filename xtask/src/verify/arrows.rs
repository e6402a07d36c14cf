//! The dependency arrows of `docs/architecture.md`.

use crate::metadata::{Metadata, Package};

/// The crates that the facade joins.
const CORE: [&str; 5] =
    ["contact-kinematics", "object-dynamics", "touch-observer", "shape-bounds", "touch-exploration"];

/// The crates that someone may pick alone: the core, and what certifies its bounds.
pub(crate) fn alone() -> impl Iterator<Item = &'static str> {
    CORE.into_iter().chain(["unit-direction", "exact-hull", "shape-certificate"])
}

/// Each member and the members that it may depend on, in any way (normal, build, dev).
const ALLOWED: [(&str, &[&str]); 15] = [
    ("unit-direction", &[]),
    // Geometry of points and planes, which knows nothing of robots.
    ("exact-hull", &["unit-direction"]),
    ("contact-kinematics", &["unit-direction"]),
    ("object-dynamics", &["contact-kinematics"]),
    ("touch-observer", &["contact-kinematics", "object-dynamics"]),
    ("shape-bounds", &["contact-kinematics", "exact-hull"]),
    ("touch-exploration", &["contact-kinematics", "object-dynamics", "touch-observer", "shape-bounds"]),
    ("recon-touch", &CORE),
    // What checks bounds has nothing of what makes them.
    ("shape-certificate", &[]),
    ("recon-touch-io", &["recon-touch", "shape-certificate"]),
    ("recon-touch-cli", &["recon-touch", "recon-touch-io", "recon-tests"]),
    // The two name `shape-bounds` only to switch on its feature `generators`, which the facade has no reason to carry.
    ("recon-tests", &["recon-touch", "recon-touch-io", "shape-bounds"]),
    // The scenes of the tests are the scenes of the charts.
    // Likewise `exploration`.
    ("recon-benches", &["recon-touch", "recon-touch-io", "recon-tests", "shape-bounds", "touch-exploration"]),
    // It names the last three to be built with the features that they have beside it in tests.
    ("recon-py", &["recon-touch-cli", "recon-touch-io", "shape-bounds", "touch-exploration", "exact-hull"]),
    ("xtask", &[]),
];

/// Command lines, file formats and plots: these are never built into a core crate, however indirectly.
const OUTSIDE_OF_THE_CORE: [&str; 15] = [
    "arrow",
    "clap",
    "console",
    "csv",
    "csv-core",
    "image",
    "indicatif",
    "kuva",
    "mcap",
    "miette",
    "parquet",
    "plotters",
    "png",
    "serde_json",
    "toml",
];

/// One line for each arrow that should not be there.
pub(crate) fn complaints(metadata: &Metadata) -> Vec<String> {
    let mut complaints = Vec::new();
    for member in metadata.members() {
        match ALLOWED.iter().find(|(name, _)| *name == member.name) {
            Some((_, allowed)) => complaints.extend(forbidden_members(metadata, member, allowed)),
            None => complaints.push(format!("{} has no arrows: add it to the table of xtask", member.name)),
        }
        if alone().any(|name| name == member.name) {
            complaints.extend(heavy_crates(metadata, member));
        }
    }
    for (name, _) in ALLOWED {
        if !metadata.members().any(|member| member.name == name) {
            complaints.push(format!("{name} is in the table of xtask but no member of the workspace"));
        }
    }
    complaints
}

fn forbidden_members(metadata: &Metadata, member: &Package, allowed: &[&str]) -> Vec<String> {
    let targets = member.edges.iter().map(|edge| &metadata.packages[edge.to]).filter(|to| to.member);
    let forbidden = targets.filter(|to| !allowed.contains(&to.name.as_str()));
    forbidden.map(|to| format!("{} -> {}: not an arrow of the architecture", member.name, to.name)).collect()
}

fn heavy_crates(metadata: &Metadata, member: &Package) -> Vec<String> {
    let ways = metadata.ways_into(member).into_iter();
    let heavy = ways.filter(|way| way.last().is_some_and(|name| OUTSIDE_OF_THE_CORE.contains(name)));
    heavy.map(|way| format!("{}: does not belong into a core crate", way.join(" -> "))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metadata::made_up::workspace;

    /// A workspace as the architecture wants it, with lines replaced by those with the same name.
    fn house(changes: &[&str]) -> Metadata {
        let plan = [
            "unit-direction: glam",
            "exact-hull: unit-direction glam",
            "contact-kinematics: unit-direction glam proptest/dev",
            "object-dynamics: contact-kinematics glam",
            "touch-observer: contact-kinematics object-dynamics glam",
            "shape-bounds: contact-kinematics exact-hull parry",
            "touch-exploration: contact-kinematics shape-bounds",
            "recon-touch: contact-kinematics object-dynamics touch-observer shape-bounds touch-exploration",
            "shape-certificate: glam",
            "recon-touch-io: recon-touch shape-certificate serde_json",
            "recon-touch-cli: recon-touch recon-touch-io clap",
            "recon-tests: recon-touch/dev recon-touch-io/dev",
            "recon-benches: recon-touch recon-touch-io kuva",
            "recon-py: recon-touch-cli recon-touch-io",
            "xtask: serde_json",
            "|glam:",
            "|parry: glam",
            "|proptest: clap",
            "|serde_json:",
            "|clap:",
            "|kuva:",
        ];
        let name = |line: &str| line.split(':').next().map(str::to_owned);
        let changed =
            |line| changes.iter().find(|change| name(change) == name(line)).copied().unwrap_or(line);
        workspace(&plan.into_iter().map(changed).collect::<Vec<_>>())
    }

    #[test]
    fn the_plan_of_the_architecture_has_no_complaint() {
        assert_eq!(complaints(&house(&[])), Vec::<String>::new());
    }

    #[test]
    fn this_workspace_has_no_complaint() {
        let metadata = Metadata::load().expect("cargo describes this workspace");
        assert_eq!(complaints(&metadata), Vec::<String>::new());
    }

    #[test]
    fn an_arrow_against_the_flow_is_caught() {
        let found = complaints(&house(&["contact-kinematics: unit-direction glam object-dynamics"]));
        assert_eq!(found, ["contact-kinematics -> object-dynamics: not an arrow of the architecture"]);
    }

    #[test]
    fn an_arrow_for_tests_only_is_caught_as_well() {
        let found = complaints(&house(&["shape-bounds: contact-kinematics touch-observer/dev"]));
        assert_eq!(found, ["shape-bounds -> touch-observer: not an arrow of the architecture"]);
    }

    #[test]
    fn a_heavy_crate_is_caught_through_others_with_its_way() {
        let found = complaints(&house(&["|parry: glam serde_json"]));
        // What is built on it carries it as well.
        let ways = ["shape-bounds -> parry", "touch-exploration -> shape-bounds -> parry"];
        assert_eq!(found, ways.map(|way| format!("{way} -> serde_json: does not belong into a core crate")));
        let found = complaints(&house(&["object-dynamics: contact-kinematics clap/build"]));
        // The observer is built on it, so both are caught.
        assert_eq!(found.len(), 2, "{found:?}");
    }

    #[test]
    fn a_member_without_a_place_in_the_plan_is_caught() {
        let mut metadata = house(&[]);
        metadata.packages[12].name = "ytask".to_owned();
        let found = complaints(&metadata);
        assert!(found.len() == 2 && found[0].contains("ytask") && found[1].contains("xtask"), "{found:?}");
    }
}
