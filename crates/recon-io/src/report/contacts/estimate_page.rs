use super::super::encode::level;
use super::super::page::{escape_text, fill, head};
use super::super::{Evidence, EvidenceValue, Level};
use super::bands::bands;
use super::estimate::EstimateData;
use super::page::{STYLE, fact};
use super::picture::drawn;
use super::spans::estimated_mode_spans;
use crate::number::{brief_to, with_brief_numbers};
use crate::planar_figures::write_figures;
use std::io::{self, Write};

const PAGE: &str = include_str!("../assets/estimate.html");
const OBJECT: &str = "The grey area is what the contacts of the whole log that are relied on span, moved with the estimated motion: the object itself goes beyond it. Lines on it are the contact curves, where they are seen, in the colours of the palms.";
const NO_OBJECT: &str =
    "The object is not drawn: where it was touched is not known under a motion that is not to be relied on.";

/// Writes a motion that was estimated from contacts of any palms as one HTML page that needs nothing else: the verdict, pictures,
/// curves with their uncertainty, contact modes, mass and inertia.
///
/// # Errors
/// Those of `to`, and [`io::ErrorKind::InvalidInput`] where not everything has an entry at each of two samples or more.
pub fn write_estimate_report(data: &EstimateData, to: impl Write) -> io::Result<()> {
    if !data.fits() {
        let what = "a report needs two samples or more, and a state, modes and contacts at each";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    let (times, found) = (data.log.times(), &data.estimate);
    let (pictures, doubtful) = (data.pictures(), data.doubtful());
    let relied = found.relied_on.iter().filter(|relied| **relied).count();
    // Nearly all is not all.
    let share = 1000.0 * relied as f64 / times.len() as f64;
    let mut facts = vec![
        ("Time", brief_to(4, data.log.duration()), "s"),
        ("Samples", times.len().to_string(), ""),
        ("Relied on", brief_to(3, share.floor() / 10.0), "%"),
        ("Mass", brief_to(4, found.mass), "kg"),
    ];
    if found.axes_deviations.is_none() {
        facts.push(("Its deviation", brief_to(2, 100.0 * found.mass_deviation), "%"));
    }
    if let Some(bounds) = &data.bounds {
        let upper = bounds.upper.as_ref();
        facts.push(("Lower bound", brief_to(4, bounds.lower.volume), "m³"));
        facts.push(match upper {
            Some(upper) => ("Upper bound", brief_to(4, upper.volume), "m³"),
            None => ("Upper bound", "unbounded".to_owned(), ""),
        });
    }
    let spans: Vec<_> =
        (0..data.log.palms().len()).map(|palm| estimated_mode_spans(times, found, palm)).collect();
    let marks: Vec<f64> = pictures.iter().map(|picture| picture.t).collect();
    let mut curves = Vec::new();
    write_figures(&data.panels(), &mut curves)?;
    let dashed = if data.truth.is_some() { " Dashed: the true motion, from the log." } else { "" };
    let parts = [
        ("head", head(&data.title, STYLE)?),
        ("title", escape_text(&data.title)),
        ("verdict", verdict(data)),
        ("facts", facts.iter().map(fact).collect()),
        ("pictures", drawn(&pictures)),
        ("object", if relied > 0 { OBJECT } else { NO_OBJECT }.to_owned()),
        ("bands", bands(&spans, &marks, &doubtful)),
        ("curves", String::from_utf8_lossy(&curves).into_owned()),
        ("dashed", dashed.to_owned()),
        ("evidence", data.evidence.iter().map(row).collect()),
    ];
    fill(PAGE, &parts, to)
}

/// The verdict in a sentence, the note and the warnings.
fn verdict(data: &EstimateData) -> String {
    let word = match data.verdict.level {
        Level::Good => "Reliable",
        Level::Caution => "With care",
        Level::Bad => "Unreliable",
        Level::Neutral => "Note",
    };
    let notice = |level: Level, word: &str, text: &str| {
        let (level, text) = (self::level(level), escape_text(&with_brief_numbers(text)));
        format!("<p class=\"notice {level}\"><strong>{word}</strong>{text}</p>\n")
    };
    let warnings = data.warnings.iter().map(|warning| notice(Level::Caution, "Warning", warning));
    let note = notice(Level::Neutral, "Note", &data.note);
    [notice(data.verdict.level, word, &data.verdict.text), note].into_iter().chain(warnings).collect()
}

/// A row of the table of what the result rests on.
fn row(of: &Evidence) -> String {
    let mark = match of.level {
        Level::Good => "✓",
        Level::Caution => "!",
        Level::Bad => "✕",
        Level::Neutral => "·",
    };
    let (class, value) = match &of.value {
        EvidenceValue::Number(v) => ("number", brief_to(4, *v)),
        EvidenceValue::Count(n) => ("number", n.to_string()),
        EvidenceValue::Text(text) => ("words", escape_text(&with_brief_numbers(text))),
    };
    let (name, unit, meaning) = (escape_text(&of.name), escape_text(&of.unit), escape_text(&of.meaning));
    format!(
        "<tr><td><span class=\"mark {}\">{mark}</span>{name}</td><td class=\"{class}\">{value} {unit}</td><td class=\"meaning\">{meaning}</td></tr>\n",
        level(of.level)
    )
}
