//! The command line as shells and manuals know it.

use crate::cli::{Cli, CompletionsArgs};
use crate::console::listened;
use crate::error::{CliError, Outcome};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
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
    let written = manual(&command).and_then(|text| io::stdout().lock().write_all(text.as_bytes()));
    listened(written)?;
    Ok(Outcome::Done)
}

/// The page: each command is a part of it, not a page of its own.
fn manual(command: &Command) -> io::Result<String> {
    let version = command.get_version().unwrap_or_default();
    let mut text = format!(".TH RECON 1 \"\" \"recon {version}\" \"User Commands\"\n");
    text += &rendered(|to| Man::new(command.clone()).render_name_section(to))?;
    text += &of_command(command)?;
    let mut list = rendered(|to| Man::new(command.clone()).render_subcommands_section(to))?;
    for sub in command.get_subcommands() {
        let name = sub.get_name().replace('-', r"\-");
        list = list.replace(&format!(r"recon\-{name}(1)"), &format!("recon {name}"));
    }
    text += &list;
    text += &further(command, "SH");
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        text += &format!(".SH \"RECON {}\"\n", sub.get_name().to_uppercase());
        text += &of_command(sub)?.replace("\n.SH ", "\n.SS ");
        text += &further(sub, "SS");
    }
    Ok(text)
}

/// Description, synopsis and options.
fn of_command(command: &Command) -> io::Result<String> {
    let man = Man::new(command.clone());
    rendered(|to| {
        man.render_description_section(to)?;
        man.render_synopsis_section(to)?;
        man.render_options_section(to)
    })
}

fn rendered(section: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<String> {
    let mut text = Vec::new();
    section(&mut text)?;
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    // A break beside an empty line is none, which manuals are checked for.
    let is_space = |k: usize| lines.get(k).is_some_and(|line| line.is_empty());
    let idle = |k: usize| lines[k] == ".br" && (is_space(k.wrapping_sub(1)) || is_space(k + 1));
    Ok((0..lines.len()).filter(|k| !idle(*k)).map(|k| format!("{}\n", lines[k])).collect())
}

/// What `--help` says at its end, line by line as there.
fn further(command: &Command, heading: &str) -> String {
    let Some(help) = command.get_after_long_help() else { return String::new() };
    let help = help.to_string().replace('\\', r"\e").replace('-', r"\-").replace('\'', r"\(aq");
    let line = |line: &str| if line.starts_with('.') { format!("\\&{line}\n") } else { format!("{line}\n") };
    format!(".{heading} \"MORE\"\n.nf\n{}.fi\n", help.lines().map(line).collect::<String>())
}
