//! The commands: from arguments to files and words.

mod answers;
mod any_palms;
mod batch;
pub(crate) mod bounds;
mod check;
mod check_input;
mod demo;
mod explore;
mod export;
pub(crate) mod follow;
mod formats;
mod init;
mod inspect;
mod manual;
pub(crate) mod next;
pub(crate) mod planar;
mod planar_fit;
mod plane;
mod pushes;
pub(crate) mod reconstruct;
pub(crate) mod simulate;
mod without_forces;

use crate::cli::Command;
use crate::console::Console;
use crate::error::{CliError, Outcome};

/// Runs a command.
pub(crate) fn run(command: &Command, console: &Console) -> Result<Outcome, CliError> {
    match command {
        Command::Simulate(args) => simulate::run(args, console),
        Command::Reconstruct(args) => reconstruct::run(args, console),
        Command::Batch(args) => batch::run(args, console),
        Command::Inspect(args) => inspect::run(args, console),
        Command::Follow(args) => follow::run(args, console),
        Command::Bounds(args) => bounds::run(args, console),
        Command::Planar(args) => planar::run(args, console),
        Command::Pushes(args) => pushes::run(args, console),
        Command::Demo(args) => demo::run(args, console),
        Command::Export(args) => export::run(args, console),
        Command::Check(args) => check::run(args, console),
        Command::Explore(args) => explore::run(args, console),
        Command::Next(args) => next::run(args),
        Command::Init(args) => init::run(args, console),
        Command::Formats(args) => formats::run(args, console),
        Command::CheckInput(args) => check_input::run(args, console),
        Command::Completions(args) => manual::completions(args),
        Command::Man => manual::page(),
    }
}
