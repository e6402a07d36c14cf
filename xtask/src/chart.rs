//! Charts: handed to the release build of `recon-benches`, so that this crate depends on none of the others.

use std::process::ExitCode;

use crate::cargo::{cargo, run};

pub(crate) fn main(words: impl Iterator<Item = String>) -> ExitCode {
    let mut command = cargo("run --release --package recon-benches --bin study -- chart");
    match run(command.args(words)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(complaint) => {
            eprintln!("{complaint}");
            ExitCode::FAILURE
        }
    }
}
