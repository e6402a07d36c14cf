//! The verdict, notes and warnings on top of a page.

use super::data::level;
use super::page::escape_text;
use super::{Level, Verdict};
use crate::number::with_brief_numbers;

/// One of them, under a word.
pub(super) fn notice(of: Level, word: &str, text: &str) -> String {
    let (level, text) = (level(of), escape_text(&with_brief_numbers(text)));
    format!("<p class=\"notice {level}\"><strong>{word}</strong>{text}</p>\n")
}

/// What to do next.
pub(super) fn next(step: &str) -> String {
    let mut letters = step.chars();
    let step: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    notice(Level::Neutral, "Next", &format!("{step}."))
}

/// A verdict under the word for good, caution and bad, then the warnings.
pub(super) fn notices(verdict: &Verdict, [good, caution, bad]: [&str; 3], warnings: &[String]) -> String {
    let word = match verdict.level {
        Level::Good => good,
        Level::Caution => caution,
        Level::Bad => bad,
        Level::Neutral => "Note",
    };
    let warnings = warnings.iter().map(|warning| notice(Level::Caution, "Warning", warning));
    std::iter::once(notice(verdict.level, word, &verdict.text)).chain(warnings).collect()
}
