//! What is said to the user: results on standard output, everything else on standard error.

use crate::error::CliError;
use recon_io::with_brief_numbers;
use serde_json::{Value, json};
use std::error::Error;
use std::io::{self, ErrorKind, Write};

/// Standard output and standard error, as text or as JSON.
pub(crate) struct Console {
    json: bool,
    quiet: bool,
}

impl Console {
    /// As JSON for a program; `quiet` leaves out all but errors, what was asked for in JSON, and answers that stand nowhere else.
    pub(crate) fn new(json: bool, quiet: bool) -> Self {
        Self { json, quiet }
    }

    /// Whether nobody wants to be told how work goes on.
    pub(crate) fn is_quiet(&self) -> bool {
        self.json || self.quiet
    }

    /// Whether a program is reading.
    pub(crate) fn is_json(&self) -> bool {
        self.json
    }

    /// Prints a result that stands nowhere else: `text` for a person, `value` for a program.
    pub(crate) fn result(&self, text: &str, value: &Value) -> Result<(), CliError> {
        let line = if self.json { format!("{value:#}") } else { with_brief_numbers(text.trim_end()) };
        listened(writeln!(io::stdout().lock(), "{line}"))
    }

    /// Tells of a result that stands in files, and of what was asked for in JSON.
    pub(crate) fn written(&self, text: &str, value: &Value) -> Result<(), CliError> {
        if self.quiet && !self.json { Ok(()) } else { self.result(text, value) }
    }

    /// Says something beside the result; a program reads it from the result instead.
    pub(crate) fn note(&self, text: &str) {
        if !self.is_quiet() {
            // Without anyone to read notes there is nothing to be done.
            let _ = writeln!(io::stderr().lock(), "{}", with_brief_numbers(text));
        }
    }

    /// Prints a mistake of usage for a program.
    pub(crate) fn usage(mistake: &clap::Error) {
        let text = mistake.to_string();
        let told = text
            .trim()
            .trim_start_matches("error: ")
            .split("\n\nFor more information")
            .next()
            .unwrap_or_default();
        let _ = writeln!(io::stderr().lock(), "{:#}", json!({ "error": told, "causes": [] }));
    }

    /// Prints an error with its chain of causes.
    pub(crate) fn error(&self, error: &CliError) {
        let causes = causes(error);
        let text = if self.json {
            format!("{:#}", json!({ "error": error.to_string(), "causes": causes }))
        } else {
            let text = std::iter::once(format!("recon: {error}"))
                .chain(causes)
                .collect::<Vec<_>>()
                .join("\n  because: ");
            with_brief_numbers(&text)
        };
        let _ = writeln!(io::stderr().lock(), "{text}");
    }
}

/// What an error says was its cause, and the cause of that.
pub(crate) fn causes(error: &CliError) -> Vec<String> {
    let mut causes = Vec::new();
    let mut cause = error.source();
    while let Some(inner) = cause {
        // Some errors print their source as a part of their own text; then it is not said twice.
        let text = inner.to_string();
        if !causes.last().is_some_and(|last: &String| last.contains(&text)) {
            causes.push(text);
        }
        cause = inner.source();
    }
    causes
}

/// A reader that has gone away, such as `head`, has had what it wanted.
pub(crate) fn listened(written: io::Result<()>) -> Result<(), CliError> {
    match written {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(CliError::StandardOutput(e)),
        _ => Ok(()),
    }
}
