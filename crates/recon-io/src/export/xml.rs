//! The little of XML that is needed.

use crate::number::exact;
use std::io::{self, Write};

/// Text of a comment: two hyphens would end it, and so would one at its end.
pub(super) fn comment(text: &str) -> String {
    let mut safe: String = text.replace(['\n', '\r'], " ");
    while safe.contains("--") {
        safe = safe.replace("--", "- -");
    }
    format!("<!-- {safe} -->")
}

/// Numbers at full precision.
pub(super) fn numbers(values: &[f64]) -> String {
    // A file may hold -0.0, but nobody wants to read it.
    values.iter().map(|v| exact(v + 0.0)).collect::<Vec<_>>().join(" ")
}

/// A comment a note, after the word who wrote the file.
pub(super) fn head(notes: &[String], to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "{}", comment(&format!("Written by recon {}. SI units.", env!("CARGO_PKG_VERSION"))))?;
    notes.iter().try_for_each(|note| writeln!(to, "{}", comment(note)))
}
