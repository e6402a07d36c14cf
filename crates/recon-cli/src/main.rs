//! `recon`: shape and motion of an unknown convex object from touch, on the command line.

mod cli;
mod commands;
mod console;
mod error;
mod interrupt;
mod pipeline;
mod progress;

use clap::Parser;
use cli::Cli;
use console::Console;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) => {
            // Help goes to standard output, mistakes to standard error; where nobody listens, nothing is lost.
            let _ = usage.print();
            return ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2));
        }
    };
    let console = Console::new(cli.json);
    let result = interrupt::install().and_then(|()| commands::run(&cli.command, &console));
    match result {
        Ok(outcome) => outcome.exit_code(),
        Err(error) => {
            console.error(&error);
            error.exit_code()
        }
    }
}
