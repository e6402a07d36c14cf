//! The checks of the house.
//!
//! All builds share one profile and one set of compiler flags, so that a dependency is compiled once for checking and
//! once for running, however many steps use it.

mod arrows;
mod builds;
mod extras;
mod licences;
mod pages;
mod paths;
mod python;
mod spdx;
mod versions;

use std::process::ExitCode;
use std::time::Instant;

use crate::instructions;
use crate::metadata::Metadata;
use crate::package;
use crate::steps::{Choice, Outcome, Step, When, run, table};

/// How cargo names the default registry in its metadata, whatever mirror it downloads from.
pub(crate) const DEFAULT_REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

const STEPS: &[Step] = &[
    step("format", "rustfmt has nothing to change", builds::format),
    step("arrows", "members and core crates depend on what the architecture allows", || {
        check(arrows::complaints)
    }),
    step("versions", "one glam, one nalgebra, one parry in the tree", versions::check),
    step("licences", "every package has a licence we allow", || check(licences::complaints)),
    step("sources", "every package is ours or from the default registry", || {
        check(licences::foreign_sources)
    }),
    step(
        "packages",
        "each crate can be published: its page, licences, changes; nothing from outside",
        package::check,
    ),
    step("paths", "no tracked file names a folder of somebody's machine", paths::check),
    step("deny", "cargo-deny: bans, licences, sources", extras::deny),
    beside(
        "python",
        "the package for Python and its tests, where there is a Python with maturin",
        python::check,
    ),
    beside("pages", "each command's page in a browser, where there is one", pages::check),
    step("tests", "all tests and doctests of the workspace", builds::tests),
    beside(
        "instructions",
        "inner loops take as many instructions as in docs/instructions.csv, where they can be counted (a warning)",
        instructions::check,
    ),
    step("alone", "each core crate and its tests compile and lint with its own features only", builds::alone),
    step("features", "each Cargo feature builds without the others", builds::features),
    step("docs", "rustdoc, warnings are errors", builds::docs),
    // At the end, as it keeps all cores busy.
    step("lint", "clippy over everything, warnings are errors", builds::lint),
    optional(
        "all-tests",
        "the tests with all their seeds and cases, RECON_TESTS=all (long)",
        builds::all_tests,
    ),
    optional(
        "atlas",
        "a run of each method along each way of failing: none crashes, each is right somewhere (a minute)",
        builds::atlas,
    ),
    optional("charts", "each chart with few points is drawn (a minute)", builds::charts),
    optional("fuzz", "the fuzz targets are linted, and each one runs its committed seeds", builds::fuzz),
    optional(
        "examples",
        "the example of each crate's first page runs in a project of its own, on the packages alone (minutes)",
        package::examples,
    ),
    optional("hack", "cargo-hack: all combinations of features build", extras::hack),
    optional(
        "semver",
        "cargo-semver-checks: no breaking change since the last commit without a new version",
        extras::semver,
    ),
    optional(
        "mutants",
        "cargo-mutants: tests notice changes in the last commit's lines (long)",
        extras::mutants,
    ),
];

const fn step(name: &'static str, about: &'static str, run: fn() -> Result<Outcome, String>) -> Step {
    Step { name, about, when: When::InTurn, run }
}

const fn beside(name: &'static str, about: &'static str, run: fn() -> Result<Outcome, String>) -> Step {
    Step { name, about, when: When::Beside, run }
}

const fn optional(name: &'static str, about: &'static str, run: fn() -> Result<Outcome, String>) -> Step {
    Step { name, about, when: When::AskedFor, run }
}

/// A step whose check finds complaints in the metadata.
fn check(complaints: fn(&Metadata) -> Vec<String>) -> Result<Outcome, String> {
    let found = complaints(&Metadata::load()?);
    if found.is_empty() { Ok(Outcome::Passed) } else { Err(found.join("\n")) }
}

pub(crate) fn main(words: impl Iterator<Item = String>) -> ExitCode {
    let choice = match Choice::parse(words, STEPS) {
        Ok(choice) => choice,
        Err(complaint) => {
            eprintln!("{complaint}");
            return ExitCode::from(2);
        }
    };
    if choice.list {
        for step in STEPS {
            println!(
                "{:<12} {}{}",
                step.name,
                if step.when == When::AskedFor { "(optional) " } else { "" },
                step.about
            );
        }
        return ExitCode::SUCCESS;
    }
    let start = Instant::now();
    let reports = run(STEPS, &choice);
    println!("\n{}", table(&reports, start.elapsed()));
    if reports.iter().any(|report| report.failed()) { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
