use super::super::evidence_table::rows;
use super::super::notices::{next, notice, notices};
use super::super::page::{Fact, Page, curves_section, evidence_section, of_body, of_bounds};
use super::super::{Evidence, Level, Verdict};
use super::bands::modes_section;
use super::estimate::EstimateData;
use super::picture::Pictures;
use super::spans::{ModeSpan, estimated_mode_spans};
use crate::number::brief_to;
use crate::planar_figures::FigurePanel;
use recon::object_dynamics::Rhythm;
use std::io::{self, Write};

const OBJECT: &str = "The grey area is what the contacts of the whole log that are relied on span, moved with the estimated motion: the object itself goes beyond it. Lines on it are the contact curves, where they are seen, in the colours of the palms; in a long log dots. The dot in it is the centre of mass.";
const PATHS: &str = "Faint lines on the palms are where each was touched until then.";
const CAPTION: &str = "Coloured dots are contacts, also those behind the object, in the colours of the modes below, arrows their forces; g is gravity. Flat palms go on beyond what is drawn.";
const TRUE_SHAPE: &str = " Dashed: the outline of the true shape, from the scene.";
const NO_OBJECT: &str = "Object and centre of mass are not drawn: where they are is not known from a motion that is not to be relied on.";

pub(super) const KICKER: &str = "Motion, mass and inertia from contacts of any palms";
const BANDS: &str = "Bands hold 95 % of what the estimate may be off by, or a reading by its noise, as standard deviations say.";
const DASHED: &str = " Dashed: the true motion, from the log.";
const MODES: &str = "Modes from the ratio of friction to normal force and from the slip: the paler, the less sure. Time in s.";
const MARKS: &str = " Dashed lines: the instants of the small pictures.";
const LEFT_OUT: &str = "What was modelled, what was left out, what that costs";

/// What the page of an estimate is made of, in space and in the plane alike.
pub(super) struct EstimatePage<'a> {
    pub(super) kicker: &'a str,
    pub(super) title: &'a str,
    pub(super) verdict: &'a Verdict,
    pub(super) note: &'a str,
    pub(super) next: &'a str,
    pub(super) warnings: &'a [String],
    pub(super) facts: Vec<Fact>,
    pub(super) pictures: Pictures,
    /// What is said of the pictures.
    pub(super) caption: String,
    /// What each palm's contact does.
    pub(super) spans: Vec<Vec<ModeSpan>>,
    /// Of the samples, s.
    pub(super) times: &'a [f64],
    pub(super) relied_on: &'a [bool],
    pub(super) panels: &'a [FigurePanel],
    /// Views of the bounds, and of what is not smooth.
    pub(super) shape: &'a [FigurePanel],
    pub(super) has_truth: bool,
    pub(super) evidence: &'a [Evidence],
    /// What was modelled and what was left out, where an accuracy was wanted.
    pub(super) least_model: &'a [Evidence],
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
    facts.extend(data.marks.iter().cloned());
    facts.extend(data.largest_errors());
    let object = if found.relied_on.contains(&true) { OBJECT } else { NO_OBJECT };
    let truth = if data.true_shape.is_some() && object == OBJECT { TRUE_SHAPE } else { "" };
    let page = EstimatePage {
        kicker: KICKER,
        title: &data.title,
        verdict: &data.verdict,
        note: &data.note,
        next: &data.next,
        warnings: &data.warnings,
        facts,
        pictures: data.pictures(),
        caption: format!("Seen obliquely from above, to one scale. {object} {PATHS} {CAPTION}{truth}"),
        spans: (0..data.log.palms().len())
            .map(|palm| estimated_mode_spans(times, &found.modes, found.mode_odds.as_ref(), palm))
            .collect(),
        times,
        relied_on: &found.relied_on,
        panels: &data.panels(),
        shape: &data.shape,
        has_truth: data.truth.is_some(),
        evidence: &data.evidence,
        least_model: &data.least_model,
    };
    page.write(to)
}

impl EstimatePage<'_> {
    /// Time, samples, and how many of them are relied on.
    pub(super) fn common_facts(duration: f64, relied_on: &[bool]) -> Vec<Fact> {
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
        let [doubtful, gaps] = [doubtful_spans(self.times, self.relied_on), sample_gaps(self.times)];
        let no_samples = if gaps.is_empty() { "" } else { " Grey, where lines are broken: no samples." };
        let dashed = if self.has_truth { DASHED } else { "" };
        let body = self.pictures.section(&self.caption)
            + &curves_section(
                "Motion over time",
                self.panels,
                &format!("{BANDS}{dashed} Shaded: not relied on.{no_samples}"),
            )
            + &self.modes(&doubtful, &gaps)
            + &curves_section("Bounds on the shape", self.shape, &of_shape(self.shape))
            + &evidence_section(LEFT_OUT, &rows(self.least_model))
            + &evidence_section("Mass, inertia, and what the result rests on", &rows(self.evidence));
        let mut verdict = notices(self.verdict, ["Reliable", "With care", "Unreliable"], self.warnings);
        if !self.note.is_empty() {
            verdict += &notice(Level::Neutral, "Note", self.note);
        }
        if !self.next.is_empty() {
            verdict += &next(self.next);
        }
        Page { kicker: self.kicker, title: self.title, verdict, facts: &self.facts, body }.write(to)
    }

    /// What contacts do, where that is told.
    fn modes(&self, doubtful: &[[f64; 2]], gaps: &[[f64; 2]]) -> String {
        if self.spans.is_empty() {
            return String::new();
        }
        let marks = self.pictures.times();
        let pictures = if marks.is_empty() { "" } else { MARKS };
        modes_section(&self.spans, &marks, Some(doubtful), gaps, &format!("{MODES}{pictures}"))
    }
}

/// What is said of the views of the bounds: of what is drawn alone.
fn of_shape(views: &[FigurePanel]) -> String {
    let drawn =
        |name: &str| views.iter().flat_map(|view| &view.curves).any(|curve| curve.name.starts_with(name));
    let bounds = match (drawn("lower"), drawn("upper")) {
        (true, true) => "The object lies between the lower and the upper bound",
        (true, false) => "The object holds the lower bound, and goes beyond it",
        (false, true) => "The object lies within the upper bound",
        (false, false) => "Where the object was touched, in its own axes",
    };
    let next = if drawn("touch next") {
        "; the arrow shows where they are farthest apart: a touch there tells most."
    } else {
        "."
    };
    format!("{bounds}{next}")
}

/// Gaps that are marked, at most: the longest. Of a log that has more none stands out.
const MARKED: usize = 100;

/// Stretches of time without samples, s: longer than one and a half of the usual time between two.
#[must_use]
pub fn sample_gaps(times: &[f64]) -> Vec<[f64; 2]> {
    let mut gaps: Vec<[f64; 2]> = Rhythm::of(times).silences.iter().map(|gap| [gap.from, gap.to]).collect();
    gaps.sort_by(|a, b| (b[1] - b[0]).total_cmp(&(a[1] - a[0])));
    gaps.truncate(MARKED);
    gaps.sort_by(|a, b| a[0].total_cmp(&b[0]));
    gaps
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
