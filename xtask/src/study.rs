//! Long studies: run by the release build of `recon-benches`; their tables are committed under docs/.

use std::process::ExitCode;

use crate::cargo::{cargo, exit_code, output, root, run};

/// Where rows of parts are kept.
const ROWS: &str = "target/study-rows";

/// The study of the fuzz targets, which are outside of the workspace.
const FUZZ: &str = "fuzz_targets";
/// The study that reads with another crate, which a feature switches on.
const URDF: &str = "exported_objects";

/// Name of a study, the file under docs/ that it writes, and what it is about. Which are made in parts, and why others are not, stands in the
/// table of `benches/src/studies/main.rs`, and is told where a part is asked for.
const STUDIES: &[(&str, &str, &str)] = &[
    (
        "approximations",
        "approximations.md",
        "alpha shapes, Hermite surfaces, splines, principal surfaces: error by number of contacts and by noise",
    ),
    (
        "assumptions",
        "assumptions.md",
        "what contradicts a log: false alarms of the score tests, and which assumption is named",
    ),
    (
        "atlas",
        "atlas.md",
        "every method along every way of failing: right, reported, wrong without a warning",
    ),
    ("bounds_corners", "charts/bounds/corners.csv", "corners of half-spaces against rational arithmetic"),
    ("bounds_curvature", "charts/bounds/curvature.csv", "bounds from limits on the radii of curvature"),
    ("bounds_fuzz", "charts/bounds/fuzz.csv", "the hull on every kind of input, judged by exact predicates"),
    ("bounds_incremental", "charts/bounds/incremental.csv", "bounds kept up to date, contact by contact"),
    ("bounds_timing", "charts/bounds/timing.csv", "hull and half-spaces beside parry3d, Qhull and CGAL"),
    (
        "bounds_noise",
        "bounds-noise.md",
        "bounds of simulated noisy contacts: how often they hold, how tight they are",
    ),
    (
        "bounds_noise_wrong",
        "bounds-noise-wrong.md",
        "bounds of contacts whose noise is not as stated: how often they hold, what is said about it",
    ),
    (
        "bounds_planar",
        "charts/bounds/planar.csv",
        "bounds in the plane and of concave bodies: time, soundness, what they give away",
    ),
    (
        "bounds_planar_noise",
        "bounds-planar-noise.md",
        "right contacts in the plane under noise, in any order: bounds, and what is called impossible",
    ),
    ("bounds_tosses", "bounds-tosses.md", "bounds from poses of bodies that MuJoCo tosses onto a table"),
    ("cold_start", "cold-start.md", "three palms: random scenes from no guess"),
    (
        "whole_logs",
        "whole-logs.md",
        "noisy whole logs of random bodies on three palms: white noise, and what is not as stated",
    ),
    ("mode_bank", "mode-bank.md", "banks of modes: error and cost against what is kept"),
    (
        "mode_switches",
        "mode-switches.md",
        "contact modes where contacts come, go, slide and stick: how often right, how far to be believed",
    ),
    (
        "least_model",
        "least-model.md",
        "the least model that serves: whether the wanted accuracy is reached, and what it costs beside trying all",
    ),
    ("no_force", "no-force.md", "three palms without force sensors: random scenes from no guess"),
    (
        "nonsmooth",
        "nonsmooth.md",
        "corners, edges and faces told from contacts, and bounds of bodies that are not smooth",
    ),
    ("three_palms_monte_carlo", "three-palms-monte-carlo.md", "three palms against the Cramer-Rao bound"),
    (
        "three_palms_timing",
        "three-palms-timing.md",
        "three palms from no guess and from nearby: time and accuracy, beside SciPy",
    ),
    (
        "contact_changes",
        "contact-changes.md",
        "random changes of contact modes: gaps, cones, sticking, energy",
    ),
    ("contact_cost", "contact-cost.md", "cost of contacts with friction and without, beside MuJoCo"),
    ("contact_wedging", "contact-wedging.md", "states in which friction wedges sliding contacts"),
    (
        "contact_estimates",
        "contact-estimates.md",
        "motion, mass and inertia from reference logs of any palms, from no guess",
    ),
    (
        "contact_estimates_impulses",
        "contact-estimates-impulses.md",
        "motion, mass and inertia from measured impulses beside forces at samples",
    ),
    (
        "contact_estimates_random",
        "contact-estimates-random.md",
        "motion and mass on random scenes of three tilting palms, everything unknown",
    ),
    (
        "contact_exports",
        "contact-exports.md",
        "exported scenes of any palms in MuJoCo, beside our own motion",
    ),
    ("exported_objects", "exported-objects.md", "exported objects as MuJoCo, Drake and urdf-rs take them in"),
    (
        "contact_modes_estimated",
        "contact-modes-estimated.md",
        "contact modes with probabilities after an estimate from reference logs, friction unknown",
    ),
    (
        "contact_modes_followed",
        "contact-modes-followed.md",
        "contact modes with probabilities of a stream that follows reference logs, friction unknown, and what they cost",
    ),
    ("contact_logs", "contact-logs.md", "reference logs of any palms simulated from their start"),
    (
        "tilting_palms",
        "tilting-palms.md",
        "random scenes of three tilting palms with friction on all three: which are simulated to the end",
    ),
    (
        "planar_estimates",
        "planar-estimates.md",
        "motion in the plane from no guess: random bodies, noise, wrong constants",
    ),
    (
        "planar_estimates_friction",
        "planar-estimates-friction.md",
        "motion in the plane from palms that rub: random bodies, coefficients, noise",
    ),
    (
        "planar_observability",
        "planar-observability.md",
        "the paper's planar system by Lie derivatives: rank and condition along S1 to S4",
    ),
    (
        "planar_contacts",
        "planar-contacts.md",
        "planar bodies on any palms: what a run keeps to, what it refuses",
    ),
    ("palms", "palms.md", "flat, convex and concave palms on the same bodies: what is seen, held and known"),
    (
        "pushes",
        "pushes-study.md",
        "outline, friction and modes from pushes: simulated shapes, and real logs where they are there",
    ),
    (
        "reaching",
        "exploration.md",
        "touches and way that planners take to a gap, false certificates under noise",
    ),
    ("result_bags", "result-bags.md", "bags of results as mcap-ros2-support reads them"),
    (
        "contour",
        "contour.md",
        "outlines that are not convex, followed by round fingers: what is felt, what is jumped over",
    ),
    (
        "parallel",
        "parallel.md",
        "way of a palm that planners take to a gap of a body between parallel palms with friction",
    ),
    (
        "relief",
        "relief.md",
        "bodies in space that are not convex, touched by round fingers: what is felt, what is jumped over",
    ),
    ("rolling", "rolling.md", "radians and seconds of palm motion that planners take to a gap in the plane"),
    (
        "rolling_sensed",
        "rolling-sensed.md",
        "the same with noisy sensors and the estimator in the loop, false certificates, horizon against bodies drawn",
    ),
    (
        "shape_fits",
        "shape-fits.md",
        "shapes fitted to contacts against the Cramer-Rao bound, and their choice",
    ),
    (FUZZ, "fuzz.md", "every parser, hulls, half-spaces on a million inputs made of the committed seeds"),
    ("streaming", "streaming.md", "three palms sample by sample over a minute: time and accuracy"),
];

/// The atlas of failures, all of it or in parts: what came of its runs is kept while it is made, so that one that was broken off goes on where it
/// was. `--smoke` makes few runs and writes nothing, nor does `one`; `boundaries` makes none, and writes docs/boundaries.md anew.
pub(crate) fn atlas(words: impl Iterator<Item = String>) -> ExitCode {
    let words: Vec<String> =
        words.map(|word| if word == "--smoke" { "smoke".to_owned() } else { word }).collect();
    let first = words.first().map(String::as_str);
    if matches!(first, Some("smoke" | "one" | "boundaries")) {
        let mut command = cargo("run --release --quiet --package recon-benches --bin study -- atlas");
        return exit_code(run(command.args(&words)));
    }
    let study = |more: &[&str]| {
        let more = more.iter().map(|word| (*word).to_owned());
        main(std::iter::once("atlas".to_owned()).chain(words.iter().cloned()).chain(more))
    };
    if words.iter().any(|word| word.starts_with("--")) {
        return study(&[]);
    }
    let made = study(&["--shard", "0/1"]);
    if made != ExitCode::SUCCESS {
        return made;
    }
    let merged = study(&["--merge"]);
    if merged == ExitCode::SUCCESS {
        // They are of this state of the code alone.
        let _ = std::fs::remove_dir_all(root().join(ROWS).join("atlas"));
    }
    merged
}

/// Runs the study that is named first; what follows is handed to it. Of a part (`--shard k/n`) what came of its runs is kept in a folder
/// (`--rows`, if not stated one under target), and `--merge` writes the table from it.
pub(crate) fn main(mut words: impl Iterator<Item = String>) -> ExitCode {
    let asked = words.next();
    let Some((name, file, _)) = STUDIES.iter().find(|(name, ..)| asked.as_deref() == Some(name)) else {
        eprintln!("give the name of a study:");
        STUDIES.iter().for_each(|(name, file, about)| eprintln!("  {name}  {about} (docs/{file})"));
        return ExitCode::from(2);
    };
    let mut words: Vec<String> = words.collect();
    let is_part = words.iter().any(|word| word == "--shard");
    if is_part && !words.iter().any(|word| word == "--rows") {
        words.push("--rows".to_owned());
    }
    if words.last().is_some_and(|word| word == "--rows" || word == "--merge") {
        words.push(format!("{ROWS}/{name}"));
    }
    let mut command = if *name == FUZZ {
        cargo("run --release --quiet --locked --manifest-path fuzz/Cargo.toml --bin study --")
    } else {
        let features = if *name == URDF { " --features urdf" } else { "" };
        cargo(&format!("run --release --quiet --package recon-benches{features} --bin study -- {name}"))
    };
    let path = root().join("docs").join(file);
    let written = output(command.args(&words)).and_then(|table| match is_part {
        true => Ok(words.last().cloned().unwrap_or_default()),
        false => std::fs::write(&path, table)
            .map(|()| path.display().to_string())
            .map_err(|error| format!("{}: {error}", path.display())),
    });
    match written {
        Ok(written) => {
            println!("wrote {written}");
            ExitCode::SUCCESS
        }
        Err(complaint) => {
            eprintln!("{complaint}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is registered with the binary names its parts there: a study without has no place in that table.
    #[test]
    fn studies_of_xtask_are_those_of_the_binary() {
        let table = include_str!("../../benches/src/studies/main.rs");
        let registered = |name: &str| {
            ["OF_RUNS", "TIMES", "SHORT", "DRAWN"]
                .iter()
                .any(|parts| table.contains(&format!("(\"{name}\", {parts}, ")))
        };
        for (name, ..) in STUDIES.iter().filter(|(name, ..)| *name != FUZZ) {
            assert!(registered(name), "{name} is not in the binary of studies");
        }
        let lines = table.lines().filter(|line| line.trim_start().starts_with("(\""));
        let unlisted: Vec<_> = lines
            .filter(|line| !STUDIES.iter().any(|(name, ..)| line.contains(&format!("(\"{name}\", "))))
            .collect();
        assert_eq!(unlisted, [""; 0]);
    }
}
