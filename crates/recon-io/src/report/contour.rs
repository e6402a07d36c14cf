//! The page of what a round finger felt, along an outline or on a body in space: what was felt, what was jumped over, what is proven of the hull.

use super::Verdict;
use super::notices::notices;
use super::page::{Fact, Page, curves_section, escape_text, section};
use crate::number::brief_to;
use crate::planar_figures::FigurePanel;
use std::io::{self, Write};

/// A jump, as the table of the page shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct JumpRow {
    /// The touch before it, from 1.
    pub after: usize,
    /// Both contacts, m.
    pub ends: [Vec<f64>; 2],
    /// How far they are apart, m.
    pub mouth: f64,
    /// Radius of curvature of the hollow at most, if it was felt after all, m.
    pub radius_at_most: f64,
}

/// What the page shows.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourPage {
    /// What kind of result it is.
    pub kicker: &'static str,
    /// Title.
    pub title: String,
    /// What was felt, in a sentence.
    pub verdict: Verdict,
    /// Key figures: name, value, unit.
    pub facts: Vec<Fact>,
    /// Pictures, two in a row.
    pub panels: Vec<FigurePanel>,
    /// What stands above them.
    pub pictured: &'static str,
    /// What the pictures show.
    pub caption: String,
    /// Jumps in order.
    pub jumps: Vec<JumpRow>,
    /// What is to be known of them.
    pub about_jumps: &'static str,
}

const HEADS: [&str; 6] = ["Jump", "After touch", "From, m", "To, m", "Apart, m", "Radius at most, m"];

/// Writes it as one HTML page that needs nothing else.
///
/// # Errors
/// Those of `to`.
pub fn write_contour_report(page: &ContourPage, to: impl Write) -> io::Result<()> {
    let mut body = curves_section(page.pictured, &page.panels, &page.caption);
    if !page.jumps.is_empty() {
        let heads: String = HEADS.iter().map(|head| format!("<th>{}</th>", escape_text(head))).collect();
        let rows: String = page.jumps.iter().enumerate().map(row).collect();
        let table = format!(
            "<div class=\"scroll\"><table class=\"touches\">\n<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n"
        );
        body += &section("Where it jumped", &table, page.about_jumps);
    }
    let verdict = notices(&page.verdict, ["No jump", "Not all felt", "Refused"], &[]);
    Page { kicker: page.kicker, title: &page.title, verdict, facts: &page.facts, body }.write(to)
}

fn row((k, jump): (usize, &JumpRow)) -> String {
    let place = |at: &Vec<f64>| at.iter().map(|x| brief_to(3, *x)).collect::<Vec<_>>().join(", ");
    let cells = [
        (k + 1).to_string(),
        jump.after.to_string(),
        place(&jump.ends[0]),
        place(&jump.ends[1]),
        brief_to(3, jump.mouth),
        brief_to(4, jump.radius_at_most),
    ];
    let cells: String = cells.iter().map(|cell| format!("<td>{cell}</td>")).collect();
    format!("        <tr>{cells}</tr>\n")
}

#[cfg(test)]
mod tests {
    use super::super::Level;
    use super::*;

    #[test]
    fn the_page_holds_every_jump_and_loads_nothing() {
        let jump =
            JumpRow { after: 7, ends: [vec![0.0, 0.5], vec![0.25, 0.5]], mouth: 0.25, radius_at_most: 0.125 };
        let page = ContourPage {
            kicker: "Felt",
            title: "A <bean>".to_owned(),
            verdict: Verdict { level: Level::Caution, text: "2 < 3".to_owned() },
            facts: vec![("Jumps", "1".to_owned(), "")],
            panels: vec![FigurePanel::default()],
            pictured: "Once round",
            caption: "c".to_owned(),
            jumps: vec![jump],
            about_jumps: "not felt",
        };
        let written = |page: &ContourPage| {
            let mut out = Vec::new();
            write_contour_report(page, &mut out).unwrap();
            String::from_utf8(out).unwrap()
        };
        let text = written(&page);
        assert!(
            text.contains("A &lt;bean&gt;") && text.contains("2 &lt; 3") && text.contains("Not all felt")
        );
        assert!(text.contains("<td>0.25, 0.5</td><td>0.25</td><td>0.125</td>"), "{text}");
        assert!(!text.contains("{{") && !text.contains("src="));
        assert!(!written(&ContourPage { jumps: Vec::new(), ..page }).contains("Where it jumped"));
    }
}
