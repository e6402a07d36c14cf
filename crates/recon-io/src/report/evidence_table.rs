//! Rows of the table of what a result rests on.

use super::data::level;
use super::page::escape_text;
use super::{Evidence, EvidenceValue, Level};
use crate::number::{brief, with_brief_numbers};

/// All rows.
pub(super) fn rows(of: &[Evidence]) -> String {
    of.iter().map(row).collect()
}

fn row(of: &Evidence) -> String {
    let mark = match of.level {
        Level::Good => "✓",
        Level::Caution => "!",
        Level::Bad => "✕",
        Level::Neutral => "·",
    };
    let (class, value) = match &of.value {
        EvidenceValue::Number(v) => ("number", brief(*v)),
        EvidenceValue::Count(n) => ("number", n.to_string()),
        // Several things stand below each other.
        EvidenceValue::Text(text) => (
            if text.contains("; ") { "words several" } else { "words" },
            escape_text(&with_brief_numbers(text)).replace("; ", "<br>"),
        ),
    };
    let (name, unit, meaning) = (
        escape_text(&of.name),
        escape_text(&of.unit.replace("^2", "²").replace("^3", "³")),
        escape_text(&of.meaning),
    );
    format!(
        "<tr><td><span class=\"mark {}\">{mark}</span>{name}</td><td class=\"{class}\">{value} {unit}</td><td class=\"meaning\">{meaning}</td></tr>\n",
        level(of.level)
    )
}
