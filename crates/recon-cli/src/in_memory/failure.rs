//! Why something failed, for callers that know nothing of the command line.

use crate::console::causes;
use crate::error::CliError;
use recon_io::with_brief_numbers;
use std::fmt;

/// What kind of failure it is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum FailureKind {
    /// A fault of recon itself.
    Fault,
    /// An option that is not understood, or does not go with the input.
    Option,
    /// An input that cannot be used.
    Input,
    /// A result that cannot be written.
    Output,
    /// The caller wanted no more of it.
    Interrupted,
}

/// Why something failed.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// What kind of failure it is.
    pub kind: FailureKind,
    /// What is wrong where, and how it is mended. Rows of arrays count from 0; options are named as keywords (`contact_noise`).
    pub message: String,
}

impl Failure {
    /// A failure of an input that is no CSV file: what is called a line there is a row here.
    pub(super) fn in_rows(error: CliError) -> Self {
        let Self { kind, message } = error.into();
        Self { kind, message: rows_for_lines(&message) }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

impl From<CliError> for Failure {
    fn from(error: CliError) -> Self {
        let kind = match error.code() {
            1 => FailureKind::Fault,
            2 => FailureKind::Option,
            5 => FailureKind::Output,
            130 => FailureKind::Interrupted,
            _ => FailureKind::Input,
        };
        let said: Vec<String> = std::iter::once(error.to_string()).chain(causes(&error)).collect();
        Self { kind, message: keywords(&with_brief_numbers(&said.join(": "))) }
    }
}

/// `--contact-noise` as the keyword `contact_noise`.
pub(super) fn keywords(text: &str) -> String {
    let mut parts = text.split("--");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !(c.is_ascii_lowercase() || c == '-')).unwrap_or(part.len());
        let (name, rest) = part.split_at(end);
        out += &name.replace('-', "_");
        out += rest;
    }
    out
}

/// `line 3` as `row 3`.
fn rows_for_lines(text: &str) -> String {
    let mut parts = text.split("line ");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        out += if part.starts_with(|c: char| c.is_ascii_digit()) { "row " } else { "line " };
        out += part;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_and_lines_are_named_as_the_caller_knows_them() {
        let said = "state it with --contact-noise and --normal-noise, in line 3 of a straight line";
        assert_eq!(
            rows_for_lines(&keywords(said)),
            "state it with contact_noise and normal_noise, in row 3 of a straight line"
        );
    }
}
