//! `recon`: shape and motion of an unknown convex object from touch, on the command line.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(recon_cli::main(std::env::args_os()))
}
