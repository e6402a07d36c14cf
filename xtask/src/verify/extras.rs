//! Steps that need a cargo subcommand which may not be installed; they say so instead of passing.

use crate::cargo::{cargo, has_subcommand, output, program, root, run};
use crate::steps::Outcome;

/// Advisories are left out: they need a network, and a new advisory must not turn an old commit red.
pub(crate) fn deny() -> Result<Outcome, String> {
    with("deny", "deny --all-features check bans licenses sources")
}

pub(crate) fn hack() -> Result<Outcome, String> {
    with("hack", "hack check --workspace --feature-powerset --no-dev-deps")
}

/// Against the commit before this one: a baseline that is there before anything is published.
pub(crate) fn semver() -> Result<Outcome, String> {
    with("semver-checks", "semver-checks --workspace --baseline-rev HEAD~1")
}

/// Only in the lines that the last commit changed; over everything it takes hours.
pub(crate) fn mutants() -> Result<Outcome, String> {
    let changed = output(program("git").args(["diff", "HEAD~1", "--", "*.rs"]))?;
    let file = root().join("target/last-commit.diff");
    std::fs::write(&file, changed).map_err(|error| format!("{}: {error}", file.display()))?;
    with("mutants", "mutants --workspace --in-diff target/last-commit.diff")
}

fn with(subcommand: &str, line: &str) -> Result<Outcome, String> {
    if !has_subcommand(subcommand) {
        return Ok(Outcome::Skipped(format!("cargo-{subcommand} is not installed")));
    }
    run(&mut cargo(line))?;
    Ok(Outcome::Passed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_subcommand_is_said_plainly() {
        let outcome = with("no-such-subcommand", "--version");
        assert_eq!(outcome, Ok(Outcome::Skipped("cargo-no-such-subcommand is not installed".to_owned())));
    }
}
