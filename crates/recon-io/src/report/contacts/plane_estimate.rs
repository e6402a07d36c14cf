//! A motion that was estimated in the plane, as its page shows it.

use super::super::page::{Fact, of_body, unbounded};
use super::super::{Evidence, Verdict};
use super::estimate::outline;
use super::estimate_page::{EstimatePage, KICKER};
use super::picture::{ForceScale, Line, Picture, Pictures, axes_of_plane};
use super::plane::{PalmAt, palm};
use super::spans::estimated_mode_spans;
use crate::number::brief;
use crate::planar_figures::FigurePanel;
use glam::DVec2;
use recon::object_dynamics::ContactMode;
use recon::object_dynamics::planar::ContactLog;
use recon::observer::planar::{PlaneContact, PlaneEstimate};
use std::io::{self, Write};

/// Points of a contact curve that are drawn at most.
const TRACED: usize = 200;
const OBJECT: &str = "To one scale. The grey area is what the contacts of the whole log that are relied on span, moved with the estimated motion: the object itself goes beyond it. Lines on it are the contact curves, in the colours of the palms; in a long log dots. The dot in it is the centre of mass.";
const NO_OBJECT: &str = "To one scale. Object and centre of mass are not drawn: where they are is not known from a motion that is not to be relied on.";
const CAPTION: &str = "Coloured dots are contacts, in the colours of the modes below, arrows their forces; g is gravity. Palms go on beyond what is drawn, but for circles.";

/// Everything that is told about a motion that was estimated in the plane.
#[derive(Clone, Debug)]
pub struct PlaneEstimateData<'a> {
    /// What was reconstructed, such as the name of the log.
    pub title: String,
    /// How far the result can be relied on.
    pub verdict: Verdict,
    /// How the estimate was made, in one sentence.
    pub note: String,
    /// What was sensed.
    pub log: &'a ContactLog,
    /// Motion, mass, inertia and contact modes.
    pub estimate: &'a PlaneEstimate,
    /// Areas of the lower and the upper bound on the outline, m^2.
    pub areas: Option<[f64; 2]>,
    /// Curves of the motion.
    pub panels: Vec<FigurePanel>,
    /// Views of the bounds.
    pub shape: Vec<FigurePanel>,
    /// What the numbers rest on.
    pub evidence: Vec<Evidence>,
    /// What the reader must know, in plain words.
    pub warnings: Vec<String>,
    /// What to do next, in plain words.
    pub next: String,
}

/// Writes a motion that was estimated in the plane as one HTML page that needs nothing else: as
/// [`write_estimate_report`](super::write_estimate_report) does of one in space.
///
/// # Errors
/// Those of `to`, and [`io::ErrorKind::InvalidInput`] where not everything has an entry at each sample.
pub fn write_plane_estimate_report(data: &PlaneEstimateData, to: impl Write) -> io::Result<()> {
    let (found, samples) = (data.estimate, data.log.samples());
    let lengths = [found.states.len(), found.deviations.len(), found.modes.len(), found.relied_on.len()];
    let curves = found.contacts.iter().map(Vec::len);
    if !lengths.into_iter().chain(curves).all(|length| length == samples.len()) {
        let what = "a report needs a state, modes and contacts at each sample";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    let times: Vec<f64> = samples.iter().map(|sample| sample.t).collect();
    let object = if found.relied_on.contains(&true) { OBJECT } else { NO_OBJECT };
    let page = EstimatePage {
        kicker: KICKER,
        title: &data.title,
        verdict: &data.verdict,
        note: &data.note,
        next: &data.next,
        warnings: &data.warnings,
        facts: facts(data, &times),
        pictures: data.pictures(),
        caption: format!("{object} {CAPTION}"),
        spans: (0..found.contacts.len())
            .map(|palm| estimated_mode_spans(&times, &found.modes, found.mode_odds.as_ref(), palm))
            .collect(),
        times: &times,
        relied_on: &found.relied_on,
        panels: &data.panels,
        shape: &data.shape,
        has_truth: data.log.truth().is_some(),
        evidence: &data.evidence,
        least_model: &[],
    };
    page.write(to)
}

fn facts(data: &PlaneEstimateData, times: &[f64]) -> Vec<Fact> {
    let found = data.estimate;
    let duration = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
    let mut facts = EstimatePage::common_facts(duration, &found.relied_on);
    facts.extend(of_body(&data.evidence));
    if let Some([lower, upper]) = data.areas {
        facts.push(("Lower bound", brief(lower), "m²"));
        facts.push(match upper.is_finite() {
            true => ("Upper bound", brief(upper), "m²"),
            false => unbounded(),
        });
    }
    facts
}

impl PlaneEstimateData<'_> {
    /// Contacts on the body that are relied on, of each palm; every so many of them.
    fn traces(&self) -> Vec<Vec<Option<&PlaneContact>>> {
        let found = self.estimate;
        let stride = found.states.len().div_ceil(TRACED).max(1);
        let trace = |contacts: &'_ Vec<Option<PlaneContact>>| -> Vec<usize> {
            (0..contacts.len()).step_by(stride).collect()
        };
        found
            .contacts
            .iter()
            .map(|contacts| {
                let relied = |k: usize| contacts[k].as_ref().filter(|_| found.relied_on[k]);
                trace(contacts).into_iter().map(relied).collect()
            })
            .collect()
    }

    /// Object and palms at a few instants.
    fn pictures(&self) -> Pictures {
        let samples: Vec<usize> = (0..self.log.samples().len()).collect();
        let traces = self.traces();
        let unknown = self.unknown();
        let reach = self.reach(unknown);
        let forces = self.log.samples().iter().flat_map(|sample| &sample.palms);
        let scale = ForceScale::new(reach, forces.map(|palm| palm.force.length()));
        Pictures::of(&samples, |k| self.picture(*k, unknown, (reach, scale), &traces))
    }

    /// The mean of all contacts, world axes, where no motion is relied on.
    fn unknown(&self) -> Option<DVec2> {
        if self.estimate.relied_on.contains(&true) {
            return None;
        }
        let touches = self.log.samples().iter().flat_map(|sample| &sample.palms).filter_map(|palm| palm.p_WC);
        let (sum, count) = touches.fold((DVec2::ZERO, 0.0), |(sum, count), p_WC| (sum + p_WC, count + 1.0));
        (count > 0.0).then(|| sum / count)
    }

    /// Largest distance of a contact from where the object is, m.
    fn reach(&self, unknown: Option<DVec2>) -> f64 {
        let largest = |lengths: &mut dyn Iterator<Item = f64>| lengths.fold(0.0, f64::max);
        match unknown {
            Some(about) => {
                let palms = self.log.samples().iter().flat_map(|sample| &sample.palms);
                largest(&mut palms.filter_map(|palm| Some(palm.p_WC?.distance(about))))
            }
            None => {
                let contacts = self.estimate.contacts.iter().flatten().flatten();
                largest(&mut contacts.map(|contact| contact.p_OC.length()))
            }
        }
    }

    fn picture(
        &self,
        k: usize,
        unknown: Option<DVec2>,
        (reach, scale): (f64, ForceScale),
        traces: &[Vec<Option<&PlaneContact>>],
    ) -> Picture {
        let (sample, state) = (&self.log.samples()[k], &self.estimate.states[k]);
        let about = unknown.unwrap_or(state.p_WCm);
        let surfaces = self.log.surfaces().iter().zip(&sample.palms).enumerate();
        let mut lines: Vec<Line> = surfaces
            .map(|(i, (surface, now))| {
                let (p_WP, angle) = (now.pose.p_WP, now.pose.angle);
                let at = PalmAt { p_WP, angle, p_WC: now.p_WC.unwrap_or(about) };
                palm(*surface, i, &at, about, reach)
            })
            .collect();
        let turn = DVec2::from_angle(state.phi0);
        let placed = |contact: &PlaneContact| state.p_WCm + turn.rotate(contact.p_OC);
        let all: Vec<DVec2> = traces.iter().flatten().flatten().map(|contact| placed(contact)).collect();
        lines.extend(outline("object", &all));
        for (i, trace) in traces.iter().enumerate() {
            let places = trace.iter().map(|contact| contact.map(placed));
            lines.extend(Line::through(&format!("trace p{}", i + 1), places, reach));
        }
        lines.extend(unknown.is_none().then(|| Line::centre(about)));
        for now in &sample.palms {
            lines.extend(now.p_WC.map(|p_WC| Line::force(p_WC, now.force, scale)));
        }
        for (now, mode) in sample.palms.iter().zip(&self.estimate.modes[k]) {
            if let Some(p_WC) = now.p_WC.filter(|_| *mode != ContactMode::Off) {
                lines.push(Line::touch(*mode, p_WC));
            }
        }
        Picture { t: sample.t, lines, axes: axes_of_plane() }
    }
}
