//! The page of a result that figures and a table tell: bounds, fits, motion without forces.

use super::evidence_table::rows;
use super::notices::notices;
use super::page::{Fact, Page, curves_section, evidence_section};
use super::{Evidence, Verdict};
use crate::planar_figures::FigurePanel;
use std::io::{self, Write};

/// What the page shows.
#[derive(Clone, Debug, PartialEq)]
pub struct FiguresPage {
    /// What kind of result it is.
    pub kicker: &'static str,
    /// Of what, such as the name of a file.
    pub title: String,
    /// What it is worth, in a sentence.
    pub verdict: Verdict,
    /// What the reader must know.
    pub warnings: Vec<String>,
    /// Key figures: name, value, unit.
    pub facts: Vec<Fact>,
    /// What the figures are of.
    pub heading: &'static str,
    /// Pictures, two in a row.
    pub panels: Vec<FigurePanel>,
    /// What they show.
    pub caption: String,
    /// What the table of the last part tells, such as [`FiguresPage::RESTS_ON`].
    pub table: &'static str,
    /// Its rows.
    pub evidence: Vec<Evidence>,
}

impl FiguresPage {
    /// What a result rests on.
    pub const RESTS_ON: &'static str = "What the result rests on";
}

/// Writes such a result as one HTML page that needs nothing else.
///
/// # Errors
/// Those of `to`.
pub fn write_figures_page(page: &FiguresPage, to: impl Write) -> io::Result<()> {
    let body = curves_section(page.heading, &page.panels, &page.caption)
        + &evidence_section(page.table, &rows(&page.evidence));
    let verdict = notices(&page.verdict, ["Good", "With care", "Unreliable"], &page.warnings);
    Page { kicker: page.kicker, title: &page.title, verdict, facts: &page.facts, body }.write(to)
}

#[cfg(test)]
mod tests {
    use super::super::{EvidenceValue, Level};
    use super::*;

    #[test]
    fn the_page_tells_all_of_it_and_loads_nothing() {
        let page = FiguresPage {
            kicker: "Bounds",
            title: "a <b>".to_owned(),
            verdict: Verdict { level: Level::Caution, text: "one & two".to_owned() },
            warnings: vec!["mind < this".to_owned()],
            facts: vec![("Lower bound", "1".to_owned(), "m³")],
            heading: "Views",
            panels: vec![FigurePanel::default()],
            caption: "c".to_owned(),
            table: FiguresPage::RESTS_ON,
            evidence: vec![Evidence {
                key: "k".to_owned(),
                name: "Name".to_owned(),
                value: EvidenceValue::Number(0.123456),
                unit: "m".to_owned(),
                meaning: "what".to_owned(),
                level: Level::Good,
            }],
        };
        let mut out = Vec::new();
        write_figures_page(&page, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        for part in
            ["a &lt;b&gt;", "With care</strong>one &amp; two", "Warning</strong>mind &lt; this", "0.123456 m"]
        {
            assert!(text.contains(part), "{part}");
        }
        assert!(!text.contains("{{") && !text.contains("src="));
    }
}
