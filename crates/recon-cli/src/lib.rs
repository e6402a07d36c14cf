//! The command `recon`, and what it does for programs that have their readings in memory and want results there.
//!
//! Start with the command: `recon demo` makes a report to look at, `recon --help` names the rest. From a program:
//!
//! ```
//! // The formats that it reads and writes, on standard output.
//! assert_eq!(recon_cli::main(["recon", "formats"].map(Into::into)), 0);
//! // An unknown option is a mistake of usage.
//! assert_eq!(recon_cli::main(["recon", "--no-such-option"].map(Into::into)), 2);
//! ```
//!
//! [`main`] is the command itself: arguments, files, words and exit codes. [`Log`], [`Reconstructed`], [`Bounded`], [`Simulated`] and
//! [`Follower`] are the same pipeline without files, for fronts in other languages: from the same numbers they make the same results, to the
//! last bit.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod cli;
mod commands;
mod console;
mod error;
mod in_memory;
mod interrupt;
mod pipeline;
mod progress;

pub use in_memory::{
    Body, Bounded, Failure, FailureKind, Follower, Log, Outlines, PlaneLog, PlaneReconstructed, PlaneScene,
    PlaneSimulated, Reconstructed, Simulated, check, plan_of_columns, plan_of_file, unless_stopped,
};
pub use progress::Watch;

use cli::Cli;
use console::Console;
use std::ffi::OsString;

/// Runs the command with these arguments, the first of which is its name; returns its exit code, which `recon --help` explains.
///
/// From then on Ctrl-C, SIGTERM and SIGHUP end the process, or the writing of files that was begun.
pub fn main(args: impl IntoIterator<Item = OsString>) -> u8 {
    let args: Vec<OsString> = args.into_iter().collect();
    let cli = match Cli::of(&args) {
        Ok(cli) => cli,
        Err(usage) => {
            // Nothing else is known of a command line that is not understood.
            let json = args.iter().take_while(|arg| *arg != "--").any(|arg| arg == "--json");
            match json && usage.use_stderr() {
                true => Console::usage(&usage),
                // Help goes to standard output, mistakes to standard error; where nobody listens, nothing is lost.
                false => drop(usage.print()),
            }
            return u8::try_from(usage.exit_code()).unwrap_or(2);
        }
    };
    let console = Console::new(cli.json, cli.quiet);
    let result = interrupt::install().and_then(|()| commands::run(&cli.command, &console));
    match result {
        Ok(outcome) => outcome.code(),
        Err(error) => {
            console.error(&error);
            error.code()
        }
    }
}
