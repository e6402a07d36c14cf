use super::super::evidence_table::row;
use super::super::notices::{next, notice, notices};
use super::super::page::{escape_text, fill, head, of_body, of_bounds};
use super::super::{Evidence, Level, Verdict};
use super::bands::{LEGEND, bands};
use super::estimate::EstimateData;
use super::page::{STYLE, fact};
use super::picture::{Picture, drawn};
use super::spans::{ModeSpan, estimated_mode_spans};
use crate::number::brief_to;
use crate::planar_figures::{FigurePanel, figures_in_page};
use std::io::{self, Write};

const PAGE: &str = include_str!("../assets/estimate.html");
const OBJECT: &str = "The grey area is what the contacts of the whole log that are relied on span, moved with the estimated motion: the object itself goes beyond it. Lines on it are the contact curves, where they are seen, in the colours of the palms.";
const CAPTION: &str = "Coloured dots are contacts, also those behind the object, in the colours of the modes below, arrows their forces; the other dot is the centre of mass, g gravity. Flat palms go on beyond what is drawn.";
const NO_OBJECT: &str =
    "The object is not drawn: where it was touched is not known under a motion that is not to be relied on.";

/// Key figures: name, value and unit.
pub(super) type Facts = Vec<(&'static str, String, &'static str)>;

/// What the page of an estimate is made of, in space and in the plane alike.
pub(super) struct EstimatePage<'a> {
    pub(super) title: &'a str,
    pub(super) verdict: &'a Verdict,
    pub(super) note: &'a str,
    pub(super) next: &'a str,
    pub(super) warnings: &'a [String],
    pub(super) facts: Facts,
    pub(super) pictures: Vec<Picture>,
    /// What is said of the pictures.
    pub(super) caption: String,
    /// What each palm's contact does.
    pub(super) spans: Vec<Vec<ModeSpan>>,
    /// Of the samples, s.
    pub(super) times: &'a [f64],
    pub(super) relied_on: &'a [bool],
    pub(super) panels: &'a [FigurePanel],
    pub(super) has_truth: bool,
    pub(super) evidence: &'a [Evidence],
}

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
    let mut facts = EstimatePage::common_facts(data.log.duration(), &found.relied_on);
    facts.extend(of_body(&data.evidence));
    facts.extend(data.bounds.iter().flat_map(of_bounds));
    facts.extend(data.marks.iter().flat_map(|marks| marks.facts.clone()));
    let object = if found.relied_on.contains(&true) { OBJECT } else { NO_OBJECT };
    let page = EstimatePage {
        title: &data.title,
        verdict: &data.verdict,
        note: &data.note,
        next: &data.next,
        warnings: &data.warnings,
        facts,
        pictures: data.pictures(),
        caption: format!("Seen obliquely from above, to one scale. {object} {CAPTION}"),
        spans: (0..data.log.palms().len())
            .map(|palm| estimated_mode_spans(times, &found.modes, found.mode_odds.as_ref(), palm))
            .collect(),
        times,
        relied_on: &found.relied_on,
        panels: &data.panels(),
        has_truth: data.truth.is_some(),
        evidence: &data.evidence,
    };
    page.write(to)
}

impl EstimatePage<'_> {
    /// Time, samples, and how many of them are relied on.
    pub(super) fn common_facts(duration: f64, relied_on: &[bool]) -> Facts {
        let relied = relied_on.iter().filter(|relied| **relied).count();
        // Nearly all is not all.
        let share = 1000.0 * relied as f64 / relied_on.len() as f64;
        vec![
            ("Time", brief_to(4, duration), "s"),
            ("Samples", relied_on.len().to_string(), ""),
            ("Relied on", brief_to(3, share.floor() / 10.0), "%"),
        ]
    }

    pub(super) fn write(&self, to: impl Write) -> io::Result<()> {
        let marks: Vec<f64> = self.pictures.iter().map(|picture| picture.t).collect();
        let doubtful = doubtful_spans(self.times, self.relied_on);
        let dashed = if self.has_truth { " Dashed: the true motion, from the log." } else { "" };
        let parts = [
            ("head", head(self.title, STYLE)?),
            ("title", escape_text(self.title)),
            (
                "verdict",
                notices(self.verdict, ["Reliable", "With care", "Unreliable"], self.warnings)
                    + &notice(Level::Neutral, "Note", self.note)
                    + &next(self.next),
            ),
            ("facts", self.facts.iter().map(fact).collect()),
            ("pictures", drawn(&self.pictures)),
            ("caption", self.caption.clone()),
            ("legend", LEGEND.to_owned()),
            ("bands", bands(&self.spans, &marks, &doubtful)),
            ("curves", figures_in_page(self.panels)?),
            ("dashed", dashed.to_owned()),
            ("evidence", self.evidence.iter().map(row).collect()),
        ];
        fill(PAGE, &parts, to)
    }
}

/// Stretches of time whose motion is not relied on, s: each sample stands for half the time to its neighbours.
#[must_use]
pub fn doubtful_spans(times: &[f64], relied_on: &[bool]) -> Vec<[f64; 2]> {
    let middle = |a: usize, b: usize| 0.5 * (times[a] + times[b]);
    let mut found: Vec<[f64; 2]> = Vec::new();
    for k in (0..times.len()).filter(|k| !relied_on[*k]) {
        let span = [middle(k.saturating_sub(1), k), middle(k, (k + 1).min(times.len() - 1))];
        match found.last_mut() {
            Some(last) if last[1] >= span[0] => last[1] = span[1],
            _ => found.push(span),
        }
    }
    found
}
