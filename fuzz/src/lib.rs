//! What is fuzzed, as plain functions: every parser of `recon-io`, and hulls, intersections and tetrahedra of `exact-hull`.
//!
//! A target takes any bytes. It returns whether they were accepted, and panics where what came of them breaks a promise. The same functions
//! are run by cargo-fuzz (`fuzz_targets`) and, where that or nightly Rust is missing, by the study (`cargo xtask study fuzz_targets`).

mod geometry;
pub mod inputs;
mod parsers;

/// Something that takes bytes.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, and that of its folder of seeds.
    pub name: &'static str,
    /// Whether the bytes are accepted.
    pub run: fn(&[u8]) -> bool,
}

/// All of them.
pub const TARGETS: [Target; 19] = [
    Target { name: "log", run: parsers::log },
    Target { name: "any_log", run: parsers::any_log },
    Target { name: "contact_log", run: parsers::contact_log },
    Target { name: "planar_log", run: parsers::planar_log },
    Target { name: "planar_contact_log", run: parsers::planar_contact_log },
    Target { name: "contacts", run: parsers::contacts },
    Target { name: "planar_contacts", run: parsers::planar_contacts },
    Target { name: "poses", run: parsers::poses },
    Target { name: "scene", run: parsers::scene },
    Target { name: "planar_scene", run: parsers::planar_scene },
    Target { name: "planar_known", run: parsers::planar_known },
    Target { name: "bag_mapping", run: parsers::bag_mapping },
    Target { name: "bag", run: parsers::bag },
    Target { name: "hull", run: geometry::hull },
    Target { name: "incremental_hull", run: geometry::incremental_hull },
    Target { name: "half_spaces", run: geometry::half_spaces },
    Target { name: "tetrahedra", run: geometry::tetrahedra },
    Target { name: "planar_hull", run: geometry::planar_hull },
    Target { name: "half_planes", run: geometry::half_planes },
];

/// The target of this name.
#[must_use]
pub fn target(name: &str) -> Option<Target> {
    TARGETS.into_iter().find(|target| target.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_runs_and_each_target_accepts_some() {
        for target in TARGETS {
            let seeds = inputs::seeds(target.name).expect("the folder can be read");
            let accepted = seeds.iter().filter(|seed| (target.run)(seed)).count();
            assert!(accepted > 0, "{}: {} seeds, none accepted", target.name, seeds.len());
        }
    }

    #[test]
    fn each_target_has_its_file_for_libfuzzer() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz_targets");
        for target in TARGETS {
            let text =
                std::fs::read_to_string(folder.join(format!("{}.rs", target.name))).unwrap_or_default();
            assert!(text.contains(&format!("\"{}\"", target.name)), "{}", target.name);
        }
    }
}
