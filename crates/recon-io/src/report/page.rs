//! What all pages are made of: one head, verdict, key figures, sections, evidence.

use super::{Bounds, Evidence, EvidenceValue};
use crate::number::{brief, brief_to};
use crate::planar_figures::{FigurePanel, figures_in_page};
use std::io::{self, Write};

const PAGE: &str = include_str!("assets/page.html");
const STYLE: &str = include_str!("assets/style.css");
/// What moves pictures that are shown in turn; without it they run by themselves.
const SCRIPT: &str = include_str!("assets/turn.js");

/// A key figure: name, value and unit.
pub type Fact = (&'static str, String, &'static str);

/// A page that needs nothing else: no network, no other file.
pub(super) struct Page<'a> {
    /// What kind of result it is.
    pub(super) kicker: &'a str,
    /// Of what, such as the name of a log.
    pub(super) title: &'a str,
    /// Notices, as HTML.
    pub(super) verdict: String,
    pub(super) facts: &'a [Fact],
    /// Sections, as HTML.
    pub(super) body: String,
}

impl Page<'_> {
    pub(super) fn write(&self, to: impl Write) -> io::Result<()> {
        let parts = [
            ("title", escape_text(self.title)),
            ("style", STYLE.to_owned()),
            ("kicker", escape_text(self.kicker)),
            ("verdict", self.verdict.clone()),
            ("facts", tiles(self.facts)),
            ("body", self.body.clone()),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("script", SCRIPT.to_owned()),
        ];
        fill(PAGE, &parts, to)
    }
}

/// Key figures as tiles.
pub(super) fn tiles(facts: &[Fact]) -> String {
    let tile = |(name, value, unit): &Fact| {
        format!("<div><dt>{name}</dt><dd>{value}<small>{unit}</small></dd></div>\n")
    };
    let all: String = facts.iter().map(tile).collect();
    if all.is_empty() {
        all
    } else {
        format!("<dl class=\"facts\" aria-label=\"Key figures\">\n{all}</dl>\n")
    }
}

/// A section: what it shows as HTML, and what is said of it.
pub(super) fn section(heading: &str, shown: &str, caption: &str) -> String {
    let (heading, caption) = (escape_text(heading), escape_text(caption));
    let caption = if caption.is_empty() { caption } else { format!("<p class=\"caption\">{caption}</p>\n") };
    format!(
        "<section class=\"figure\" aria-label=\"{heading}\">\n<h2>{heading}</h2>\n{shown}{caption}</section>\n"
    )
}

/// A section of curves and views; none without any.
pub(super) fn curves_section(heading: &str, panels: &[FigurePanel], caption: &str) -> String {
    if panels.is_empty() {
        return String::new();
    }
    let curves = figures_in_page(panels);
    section(heading, &format!("<div class=\"panel curves\">\n{curves}</div>\n"), caption)
}

/// The section of what the result rests on; none without rows.
pub(super) fn evidence_section(heading: &str, rows: &str) -> String {
    if rows.is_empty() {
        return String::new();
    }
    // A column without a word has no name.
    let silent = rows.matches("<td class=\"meaning\"></td>").count() == rows.matches("<tr>").count();
    let tells = if silent { "" } else { "What it tells" };
    let head =
        format!("<thead><tr><th>Quantity</th><th class=\"number\">Value</th><th>{tells}</th></tr></thead>");
    section(heading, &format!("<table class=\"evidence\">\n{head}\n<tbody>\n{rows}</tbody>\n</table>\n"), "")
}

/// Mass and principal moments, with deviations where they were estimated.
pub(super) fn of_body(evidence: &[Evidence]) -> Vec<Fact> {
    let of = |key: &str| {
        evidence.iter().find(|row| row.key == key).and_then(|row| match row.value {
            EvidenceValue::Number(value) => Some(value),
            _ => None,
        })
    };
    let rows = [
        ("Mass", "mass", "std_mass", "kg"),
        ("Least moment", "moment_x", "std_moment_x", "kg m²"),
        ("Middle moment", "moment_y", "std_moment_y", "kg m²"),
        ("Largest moment", "moment_z", "std_moment_z", "kg m²"),
        ("Moment of inertia", "inertia", "std_inertia", "kg m²"),
    ];
    let tile = |(name, key, deviation, unit)| {
        let std = of(deviation).map_or_else(String::new, |std| {
            format!("<small class=\"deviation\">± {}</small>", brief_to(2, std))
        });
        Some((name, brief(of(key)?) + &std, unit))
    };
    rows.into_iter().filter_map(tile).collect()
}

/// Volumes of bounds.
pub(super) fn of_bounds(bounds: &Bounds) -> Vec<Fact> {
    let lower = bounds.lower.volume;
    let first = ("Lower bound", brief(lower), "m³");
    match bounds.upper.as_ref().map(|upper| upper.volume) {
        Some(upper) => {
            vec![
                first,
                ("Upper bound", brief(upper), "m³"),
                ("Lower / upper", brief_to(4, lower / upper), ""),
            ]
        }
        None => vec![first, unbounded()],
    }
}

/// An upper bound that is none.
pub(super) fn unbounded() -> Fact {
    ("Upper bound", "unbounded".to_owned(), "")
}

/// Writes a page with each `{{name}}` in it replaced by the part of that name.
fn fill(page: &str, parts: &[(&str, String)], mut to: impl Write) -> io::Result<()> {
    let mut rest = page;
    while let Some((before, after)) = rest.split_once("{{") {
        to.write_all(before.as_bytes())?;
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        if let Some((_, text)) = parts.iter().find(|(key, _)| *key == name) {
            to.write_all(text.as_bytes())?;
        }
        rest = after;
    }
    to.write_all(rest.as_bytes())?;
    to.flush()
}

pub(super) fn escape_text(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::super::Level;
    use super::*;

    #[test]
    fn pages_refer_to_nothing_outside_and_text_cannot_break_out() {
        let (title, verdict) = ("a <log> & \"more\"", super::super::notices::next("</script>"));
        let body = section("<b>", "", "1 < 2");
        let page = Page { kicker: "k", title, verdict, facts: &[("Time", "1".to_owned(), "s")], body };
        let mut out = Vec::new();
        page.write(&mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        for outside in ["http:", "https:", "src=", "href=", "@import", "url(h", "fetch(", "{{", "<b>"] {
            assert!(!text.contains(outside), "{outside}");
        }
        assert!(text.contains("default-src 'none'") && text.matches("</script>").count() == 1);
        assert!(text.contains("<title>a &lt;log&gt; &amp; \"more\" – recon</title>"));
        assert!(text.contains("<dt>Time</dt><dd>1<small>s</small></dd>") && text.contains("1 &lt; 2"));
    }

    /// The same numbers as on the console: six digits, two of a deviation.
    #[test]
    fn mass_and_inertia_are_tiles_with_their_deviations() {
        let row = |key: &str, value: f64| Evidence {
            key: key.into(),
            name: String::new(),
            value: EvidenceValue::Number(value),
            unit: "kg".into(),
            meaning: String::new(),
            level: Level::Neutral,
        };
        let rows = [row("mass", 0.399_979_3), row("std_mass", 4.43e-5), row("moment_x", 1.6e-4)];
        let page = tiles(&of_body(&rows));
        for tile in [
            "<dt>Mass</dt><dd>0.399979<small class=\"deviation\">± 4.4e-5</small><small>kg</small></dd>",
            "<dt>Least moment</dt><dd>0.00016<small>kg m²</small></dd>",
        ] {
            assert!(page.contains(tile), "{tile}");
        }
    }
}
