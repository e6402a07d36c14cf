//! Words of the command line as options of a call.

use super::failure::{Failure, FailureKind, keywords};
use crate::cli::{Cli, Command};

/// The command that `name` and these words make.
pub(super) fn parsed(name: &str, words: &[String]) -> Result<Command, Failure> {
    let line = ["recon", name].into_iter().map(str::to_owned).chain(words.iter().cloned());
    match Cli::of(line) {
        Ok(cli) => Ok(cli.command),
        Err(usage) => {
            let text = usage.render().to_string();
            let text = text.split("\n\nUsage").next().unwrap_or_default();
            let text = text.split("\n\nFor more").next().unwrap_or_default();
            let said = text.trim_start_matches("error: ").split_whitespace().collect::<Vec<_>>().join(" ");
            Err(Failure { kind: FailureKind::Option, message: keywords(&said) })
        }
    }
}

/// A command that a parse of its own name did not give, which clap does not do.
pub(super) fn unlike(name: &str) -> Failure {
    Failure { kind: FailureKind::Fault, message: format!("the options are not those of {name}") }
}
