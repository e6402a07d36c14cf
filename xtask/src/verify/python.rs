//! The package for Python: built and tested where there is a Python with what that takes; nothing else needs one.

use crate::cargo::{output, program, recon, run, target};
use crate::steps::Outcome;
use std::process::Stdio;

/// What the tests cannot do without.
const NEEDED: [&str; 3] = ["maturin", "numpy", "pytest"];

/// Builds the wheel, unpacks it into the target folder, and runs the tests on it.
pub(crate) fn check() -> Result<Outcome, String> {
    let Some(python) = ["python3", "python"].into_iter().find(|name| imports(name, &NEEDED)) else {
        return Ok(Outcome::Skipped(format!("no Python with {}", NEEDED.join(", "))));
    };
    let command = recon()?;
    let (wheels, unpacked) = (target().join("wheels"), target().join("python"));
    // A wheel of an earlier commit is not what is tested.
    for old in [&wheels, &unpacked] {
        if old.exists() {
            std::fs::remove_dir_all(old).map_err(|error| format!("{}: {error}", old.display()))?;
        }
    }
    let mut build = program(python);
    build.args(["-m", "maturin", "build", "--locked", "--features", "as-tested", "--out"]).arg(&wheels);
    run(build.env("CARGO_TARGET_DIR", target()))?;
    let wheel = std::fs::read_dir(&wheels).map_err(|error| format!("{}: {error}", wheels.display()))?;
    let wheel = wheel.filter_map(Result::ok).next().ok_or("maturin wrote no wheel")?.path();
    run(program(python).args(["-m", "zipfile", "-e"]).arg(&wheel).arg(&unpacked))?;
    run(program(python)
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider"])
        .env("PYTHONPATH", &unpacked)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("RECON_COMMAND", command))?;
    Ok(Outcome::Passed)
}

/// Whether there is such a Python, and it has these modules.
fn imports(python: &str, modules: &[&str]) -> bool {
    let mut asked = program(python);
    asked.args(["-c", &format!("import {}", modules.join(", "))]).stderr(Stdio::null());
    output(&mut asked).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_python_that_is_not_there_has_nothing() {
        assert!(!imports("no-such-python", &["sys"]));
        assert!(!imports("python3", &["no_such_module"]));
    }
}
