//! Charts: handed to the release build of `recon-benches`, so that this crate depends on none of the others. The command is built as well: one of them times it.

use std::process::ExitCode;

use crate::cargo::{cargo, exit_code, program, run, target};

pub(crate) fn main(words: impl Iterator<Item = String>) -> ExitCode {
    let build = || run(&mut cargo("build --release --package recon-benches --package recon-touch-cli"));
    let draw = || run(program(&target().join("release/study").to_string_lossy()).arg("chart").args(words));
    exit_code(build().and_then(|()| draw()))
}
