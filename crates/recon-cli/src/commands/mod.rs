//! The commands: from arguments to files and words.

mod any_palms;
mod bounds;
mod check;
mod demo;
mod explore;
mod export;
mod follow;
mod inspect;
mod next;
mod planar;
mod plane;
mod reconstruct;
mod simulate;
mod without_forces;

use crate::cli::Command;
use crate::console::Console;
use crate::error::{CliError, Outcome};

/// Runs a command.
pub(crate) fn run(command: &Command, console: &Console) -> Result<Outcome, CliError> {
    match command {
        Command::Simulate(args) => simulate::run(args, console),
        Command::Reconstruct(args) => reconstruct::run(args, console),
        Command::Inspect(args) => inspect::run(args, console),
        Command::Follow(args) => follow::run(args, console),
        Command::Bounds(args) => bounds::run(args, console),
        Command::Planar(args) => planar::run(args, console),
        Command::Demo(args) => demo::run(args, console),
        Command::Export(args) => export::run(args, console),
        Command::Check(args) => check::run(args, console),
        Command::Explore(args) => explore::run(args, console),
        Command::Next(args) => next::run(args),
    }
}
