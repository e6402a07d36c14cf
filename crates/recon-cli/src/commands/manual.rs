//! The command line as shells and manuals know it.

use crate::cli::{Cli, CompletionsArgs};
use crate::console::listened;
use crate::error::{CliError, Outcome};
use clap::CommandFactory;
use std::io::{self, Write};

/// Completions for a shell, on standard output.
pub(crate) fn completions(args: &CompletionsArgs) -> Result<Outcome, CliError> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "recon", &mut text);
    listened(io::stdout().lock().write_all(&text))?;
    Ok(Outcome::Done)
}

/// The manual page with all commands, on standard output.
pub(crate) fn page() -> Result<Outcome, CliError> {
    let mut command = Cli::command();
    command.build();
    let mut text = Vec::new();
    let written = || -> io::Result<()> {
        clap_mangen::Man::new(command.clone()).render(&mut text)?;
        for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
            let man = clap_mangen::Man::new(sub.clone());
            // A part of the page, of which each command has its name as the title.
            writeln!(text, ".SH \"RECON {}\"", sub.get_name().to_uppercase())?;
            man.render_description_section(&mut text)?;
            man.render_synopsis_section(&mut text)?;
            man.render_options_section(&mut text)?;
        }
        Ok(())
    };
    let mut written = written;
    listened(written().and_then(|()| io::stdout().lock().write_all(&text)))?;
    Ok(Outcome::Done)
}
