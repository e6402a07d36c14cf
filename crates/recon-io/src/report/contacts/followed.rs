//! The page of a motion that was followed while its log came.

use super::super::page::of_body;
use super::super::thin::thin;
use super::super::{Evidence, Verdict};
use super::estimate_curves::{AXES, BAND};
use super::estimate_page::{EstimatePage, doubtful_spans, sample_gaps};
use super::picture::Pictures;
use super::spans::{ModeSpan, followed_mode_spans};
use crate::number::brief_to;
use crate::planar_figures::{FigureCurve, FigurePanel};
use glam::DVec3;
use recon::observer::contacts::stream::{StreamEstimate, StreamMotion, StreamStage};
use std::io::{self, Write};

/// Estimates that are kept at most: more than a page shows.
const MOST: usize = 4000;

/// Estimates of a stream for a page, spread evenly however many there are.
#[derive(Clone, Debug, Default)]
pub struct FollowedMotion {
    kept: Vec<StreamEstimate>,
    samples: usize,
    relied_on: usize,
    /// Power of two: one of so many is kept.
    stride: u32,
}

impl FollowedMotion {
    /// Takes the estimate at the next sample.
    pub fn take(&mut self, estimate: &StreamEstimate) {
        if self.samples.is_multiple_of(1 << self.stride) {
            self.kept.push(*estimate);
        }
        self.samples += 1;
        self.relied_on += usize::from(relied_on(estimate));
        if self.kept.len() > MOST {
            let mut even = [true, false].into_iter().cycle();
            self.kept.retain(|_| even.next() == Some(true));
            self.stride += 1;
        }
    }
}

/// What the page of a stream shows.
#[derive(Clone, Debug)]
pub struct FollowedPage {
    /// Name of the log.
    pub title: String,
    /// What the motion is worth at the end.
    pub verdict: Verdict,
    /// What the reader must know.
    pub warnings: Vec<String>,
    /// What to do next.
    pub next: String,
    /// Estimates at the samples.
    pub motion: FollowedMotion,
    /// Palms whose modes are told.
    pub palms: usize,
    /// Mass, inertia, and what it rests on.
    pub evidence: Vec<Evidence>,
}

/// Writes a motion that was followed as one HTML page that needs nothing else: the verdict, curves with their uncertainty as it was known at each
/// sample, contact modes.
///
/// # Errors
/// Those of `to`, and [`io::ErrorKind::InvalidInput`] of less than two samples.
pub fn write_followed_report(page: &FollowedPage, to: impl Write) -> io::Result<()> {
    let FollowedMotion { kept, samples, relied_on, .. } = &page.motion;
    let (Some(first), Some(last)) = (kept.first(), kept.last().filter(|_| kept.len() > 1)) else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a report needs two samples or more"));
    };
    let times: Vec<f64> = kept.iter().map(|of| of.t).collect();
    let all: Vec<bool> = kept.iter().map(self::relied_on).collect();
    // Nearly all is not all.
    let share = (1000.0 * *relied_on as f64 / *samples as f64).floor() / 10.0;
    let mut facts = vec![
        ("Time", brief_to(4, last.t - first.t), "s"),
        ("Samples", samples.to_string(), ""),
        ("Relied on", brief_to(3, share), "%"),
    ];
    facts.extend(of_body(&page.evidence));
    let spans: Vec<Vec<ModeSpan>> = (0..page.palms).map(|palm| followed_mode_spans(kept, palm)).collect();
    EstimatePage {
        kicker: "Motion, sample by sample as its log came",
        title: &page.title,
        verdict: &page.verdict,
        note: "",
        next: &page.next,
        warnings: &page.warnings,
        facts,
        pictures: Pictures::default(),
        caption: String::new(),
        spans: spans.into_iter().filter(|spans| !spans.is_empty()).collect(),
        times: &times,
        relied_on: &all,
        panels: &panels(kept, &times, &all),
        shape: &[],
        has_truth: false,
        evidence: &page.evidence,
        least_model: &[],
    }
    .write(to)
}

fn relied_on(estimate: &StreamEstimate) -> bool {
    estimate.stage == StreamStage::Tracking
}

/// Curves with their bands; broken where there is no motion.
fn panels(all: &[StreamEstimate], times: &[f64], relied_on: &[bool]) -> Vec<FigurePanel> {
    let kept = thin(all.len());
    let curve = |name: &str, of: &dyn Fn(&StreamMotion) -> f64, deviation: &dyn Fn(&StreamMotion) -> f64| {
        let told =
            |k: usize, value: &dyn Fn(&StreamMotion) -> f64| all[k].motion.as_ref().map_or(f64::NAN, value);
        FigureCurve {
            name: name.to_owned(),
            points: kept.iter().map(|&k| [times[k], told(k, of)]).collect(),
            half_heights: kept.iter().map(|&k| BAND * told(k, deviation)).collect(),
            ..FigureCurve::default()
        }
    };
    let std = |motion: &StreamMotion, i: usize| motion.covariance[(i, i)].max(0.0).sqrt();
    let vector = |of: fn(&StreamMotion) -> DVec3, from: usize| -> Vec<FigureCurve> {
        let axis = |i: usize| curve(AXES[i], &|motion| of(motion)[i], &|motion| std(motion, from + i));
        (0..3).map(axis).collect()
    };
    let panel = |title: &str, unit: &str, curves| FigurePanel {
        title: title.to_owned(),
        axes: ["t in s".to_owned(), unit.to_owned()],
        curves,
        shaded: doubtful_spans(times, relied_on),
        missing: sample_gaps(times),
        ..FigurePanel::default()
    };
    let start = all.iter().find_map(|of| of.motion).map_or(glam::DQuat::IDENTITY, |motion| motion.state.R_WO);
    let turned = |motion: &StreamMotion| start.angle_between(motion.state.R_WO).to_degrees();
    let wide = |motion: &StreamMotion| (9..12).map(|i| std(motion, i)).fold(0.0, f64::max).to_degrees();
    let all = [
        panel("Centre of mass", "m", vector(|m| m.state.p_WCm, 0)),
        panel("Velocity", "m/s", vector(|m| m.state.v_WCm, 3)),
        panel("Angular velocity", "rad/s", vector(|m| m.state.w_WO, 6)),
        panel("Turn since it was found", "degrees", vec![curve("object", &turned, &wide)]),
    ];
    let is_told =
        |panel: &FigurePanel| panel.curves.iter().flat_map(|of| &of.points).any(|[_, y]| y.is_finite());
    all.into_iter().filter(is_told).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use recon::object_dynamics::MOST_PALMS;

    fn at(t: f64, stage: StreamStage) -> StreamEstimate {
        StreamEstimate { t, motion: None, stage, touching: [true; MOST_PALMS], modes: None }
    }

    #[test]
    fn however_many_samples_there_are_a_page_has_room() {
        let mut motion = FollowedMotion::default();
        (0..50_001).for_each(|k| motion.take(&at(f64::from(k) * 1e-3, StreamStage::Gathering)));
        (0..50_001).for_each(|k| motion.take(&at(50.001 + f64::from(k) * 1e-3, StreamStage::Tracking)));
        assert!((MOST / 2..=MOST).contains(&motion.kept.len()));
        assert_eq!((motion.samples, motion.relied_on), (100_002, 50_001));
        let steps: Vec<f64> = motion.kept.windows(2).map(|of| of[1].t - of[0].t).collect();
        assert!(steps.iter().all(|step| (step - steps[0]).abs() < 1e-9), "{steps:?}");
        let page = FollowedPage {
            title: "a <b>".to_owned(),
            verdict: Verdict { level: super::super::super::Level::Bad, text: "not known".to_owned() },
            warnings: Vec::new(),
            next: String::new(),
            motion,
            palms: 0,
            evidence: Vec::new(),
        };
        let mut out = Vec::new();
        write_followed_report(&page, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(
            text.contains("a &lt;b&gt;") && text.contains("50<small>%") && !text.contains("Contact modes")
        );
        let empty = FollowedPage { motion: FollowedMotion::default(), ..page };
        assert!(write_followed_report(&empty, Vec::new()).is_err());
    }
}
