//! The page of an exploration: what is proven, what each touch brought, where the next one would be.

use super::Verdict;
use super::notices::notices;
use super::page::{Fact, Page, curves_section, escape_text, section};
use crate::number::brief_to;
use crate::planar_figures::FigurePanel;
use std::io::{self, Write};

/// What is done, in the words of the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplorationWords {
    kicker: &'static str,
    course: &'static str,
    each: &'static str,
    heads: [&'static str; 5],
}

impl ExplorationWords {
    /// A finger touches where it is told.
    pub const TOUCHES: Self = Self {
        kicker: "Where a body was touched, and what that proves of its shape",
        course: "Touch by touch",
        each: "Each touch, and why there",
        heads: ["Touch", "Why", "Along", "Met at, m", "Turned, rad"],
    };
    /// Palms turn, and the body between them rolls.
    pub const MOTIONS: Self = Self {
        kicker: "How palms turned a body, and what that proves of its shape",
        course: "Motion by motion",
        each: "Each motion, and why",
        heads: ["Motion", "Why", "Palms to, rad", "Touched from the hinge, m", "Turned, rad"],
    };
    /// One of two parallel palms moves, and the body between them rolls.
    pub const STROKES: Self = Self {
        kicker: "How a palm rolled a body, and what that proves of its shape",
        course: "Stroke by stroke",
        each: "Each stroke, and why",
        heads: ["Stroke", "Why", "Then up, object's axes", "Touched on upper, lower pad, m", "Palm moved, m"],
    };
}

/// One touch or motion, as the table of the page shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchRow {
    /// Its number; none for one that is yet to be made.
    pub touch: Option<usize>,
    /// Why there.
    pub why: String,
    /// Unit vector along which the body was touched, or that is up after a stroke; angles of the palms after a motion, in rad.
    pub along: Vec<f64>,
    /// Where it was met, in m; none for one that is yet to be made. After a motion, distances of the contacts from the hinge; after a stroke, where on the upper and the lower pad it is.
    pub point: Option<Vec<f64>>,
    /// Way from the touch before, or turns of both palms, in rad; of a stroke the palm's way, m.
    pub turned: f64,
    /// What it was expected to gain, in the unit of the progress.
    pub expected: Option<f64>,
    /// What it gained.
    pub gained: Option<f64>,
    /// What is left after it.
    pub progress: Option<f64>,
}

/// What the page shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplorationPage {
    /// What is done.
    pub words: ExplorationWords,
    /// Title.
    pub title: String,
    /// What is proven, in a sentence.
    pub verdict: Verdict,
    /// Key figures: name, value, unit.
    pub facts: Vec<Fact>,
    /// What the touches are to bring down, as the head of its column.
    pub progress: String,
    /// Pictures, two in a row.
    pub panels: Vec<FigurePanel>,
    /// What the pictures show.
    pub caption: String,
    /// Touches or motions in order, the next one last.
    pub touches: Vec<TouchRow>,
}

/// Writes an exploration as one HTML page that needs nothing else.
///
/// # Errors
/// Those of `to`.
pub fn write_exploration_report(page: &ExplorationPage, to: impl Write) -> io::Result<()> {
    let ExplorationWords { kicker, course, each, heads } = page.words;
    let heads: String = heads.iter().map(|head| format!("<th>{head}</th>")).collect();
    let table = format!(
        "<div class=\"scroll\"><table class=\"touches\">\n<thead><tr>{heads}<th>Expected</th><th>Gained</th><th>{}</th></tr></thead>\n\
         <tbody>\n{}</tbody>\n</table></div>\n",
        escape_text(&page.progress),
        page.touches.iter().map(row).collect::<String>()
    );
    let body = curves_section(course, &page.panels, &page.caption) + &section(each, &table, "");
    let verdict = notices(&page.verdict, ["Proven", "Not proven", "Refused"], &[]);
    Page { kicker, title: &page.title, verdict, facts: &page.facts, body }.write(to)
}

fn row(touch: &TouchRow) -> String {
    let vector = |v: &[f64]| v.iter().map(|c| format!("{c:.3}")).collect::<Vec<_>>().join(", ");
    let optional = |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| brief_to(3, v));
    let cells = [
        touch.touch.map_or_else(|| "next".to_owned(), |n| n.to_string()),
        escape_text(&touch.why),
        vector(&touch.along),
        touch.point.as_ref().map_or_else(|| "–".to_owned(), |p| vector(p)),
        format!("{:.2}", touch.turned),
        optional(touch.expected),
        optional(touch.gained),
        optional(touch.progress),
    ];
    let cells: String = cells.iter().map(|cell| format!("<td>{cell}</td>")).collect();
    format!("        <tr>{cells}</tr>\n")
}

#[cfg(test)]
mod tests {
    use super::super::Level;
    use super::*;

    #[test]
    fn the_page_holds_every_touch_and_loads_nothing() {
        let touch = TouchRow {
            touch: Some(1),
            why: "a < b".to_owned(),
            along: vec![0.0, 1.0],
            point: Some(vec![0.25, 2.0]),
            turned: 0.5,
            expected: None,
            gained: Some(0.125),
            progress: Some(0.25),
        };
        let next = TouchRow { touch: None, point: None, gained: None, progress: None, ..touch.clone() };
        let page = ExplorationPage {
            words: ExplorationWords::MOTIONS,
            title: "An <egg>".to_owned(),
            verdict: Verdict { level: Level::Good, text: "gap & all".to_owned() },
            facts: vec![("Touches", "1".to_owned(), "")],
            progress: "Gap".to_owned(),
            panels: vec![FigurePanel::default()],
            caption: "c".to_owned(),
            touches: vec![touch, next],
        };
        let mut out = Vec::new();
        write_exploration_report(&page, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(
            text.contains("An &lt;egg&gt;") && text.contains("gap &amp; all") && text.contains("a &lt; b")
        );
        assert!(text.contains("<td>0.250, 2.000</td>") && text.contains("<td>next</td>"));
        assert!(text.contains("<th>Palms to, rad</th>") && text.contains("Motion by motion"));
        assert!(!text.contains("{{") && !text.contains("http-equiv=\"refresh\"") && !text.contains("src="));
    }
}
