use super::contacts::bands::{LEGEND, bands};
use super::contacts::doubtful_spans;
use super::contacts::page::{STYLE as BANDS, fact};
use super::data::{Departure, ReportData, ReportError};
use super::encode::encode;
use super::evidence_table::row;
use super::notices::{next, notices};
use super::{Bounds, Evidence, EvidenceValue};
use crate::number::{brief, brief_to};
use std::io::{self, Write};

const HEAD: &str = include_str!("assets/head.html");
const PAGE: &str = include_str!("assets/page.html");
const STYLE: &str = include_str!("assets/style.css");

/// The page's script, in the order in which its parts build on each other.
const SCRIPT: [&str; 8] = [
    include_str!("assets/math.js"),
    include_str!("assets/geometry.js"),
    include_str!("assets/webgl.js"),
    include_str!("assets/painter.js"),
    include_str!("assets/stage.js"),
    include_str!("assets/chart.js"),
    include_str!("assets/figures.js"),
    include_str!("assets/main.js"),
];

/// Writes the report as one HTML page that needs nothing else: no network, no other file.
///
/// # Errors
/// [`ReportError`] (as [`io::ErrorKind::InvalidInput`]) when the tracks do not fit together, and those of `to`.
pub fn write_report(data: &ReportData, to: impl Write) -> io::Result<()> {
    data.check().map_err(|e: ReportError| io::Error::new(io::ErrorKind::InvalidInput, e))?;
    let json = serde_json::to_string(&encode(data))?;
    let parts = [
        ("head", head(&data.title, BANDS)?),
        ("title", escape_text(&data.title)),
        (
            "verdict",
            notices(&data.verdict, ["Reliable", "With care", "Unreliable"], &data.warnings)
                + &next(&data.next),
        ),
        ("legend", LEGEND.to_owned()),
        ("bands", bands(&data.spans, &[], &doubtful_spans(&data.times, &data.relied_on))),
        ("facts", facts(data).iter().map(fact).collect()),
        ("evidence", data.evidence.iter().map(row).collect()),
        ("data", escape_script(&json)),
        ("script", SCRIPT.concat()),
    ];
    fill(PAGE, &parts, to)
}

/// Key figures: name, value and unit.
fn facts(data: &ReportData) -> Vec<(&'static str, String, &'static str)> {
    let over = data.times.last().zip(data.times.first()).map_or(0.0, |(last, first)| last - first);
    let mut facts = vec![("Time", brief_to(4, over), "s"), ("Samples", data.times.len().to_string(), "")];
    facts.extend(of_body(&data.evidence));
    facts.extend(data.bounds.iter().flat_map(of_bounds));
    if let Some(all) = data.departures() {
        let most = |of: fn(&Departure) -> f64| brief_to(2, all.iter().map(of).fold(0.0, f64::max));
        facts.push(("Largest position error", most(|d| d.position), "m"));
        facts.push(("Largest rate error", most(|d| d.angular_velocity), "rad/s"));
    }
    facts
}

/// Mass and principal moments, with deviations where they were estimated.
pub(super) fn of_body(evidence: &[Evidence]) -> Vec<(&'static str, String, &'static str)> {
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
pub(super) fn of_bounds(bounds: &Bounds) -> Vec<(&'static str, String, &'static str)> {
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
        None => vec![first, ("Upper bound", "unbounded".to_owned(), "")],
    }
}

/// The head that all pages share, with what a page adds to their style.
pub(super) fn head(title: &str, style: &str) -> io::Result<String> {
    let mut head = Vec::new();
    fill(HEAD, &[("title", escape_text(title)), ("style", STYLE.to_owned() + style)], &mut head)?;
    Ok(String::from_utf8_lossy(&head).into_owned())
}

/// Writes a page with each `{{name}}` in it replaced by the part of that name.
pub(super) fn fill(page: &str, parts: &[(&str, String)], mut to: impl Write) -> io::Result<()> {
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

/// Keeps text in JSON strings from ending the element that holds it.
fn escape_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}
