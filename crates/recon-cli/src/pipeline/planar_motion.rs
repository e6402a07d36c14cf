//! Motion, mass and shape of a body in the plane from contacts of any palms.

use super::advice::Advice;
use super::any_palms::as_stated;
use super::any_palms_words::mode_doubts;
use super::bounds::CONFIDENCE;
use super::least_model::{choice_figures, choice_rows};
use super::planar_motion_bounds::motion_bounds;
use super::planar_motion_words::{NOTE, evidence, verdict};
use super::plane::PlanarBounds;
use super::repeated::plane_without_repeated;
use crate::error::CliError;
use recon::least_model::{Accuracy, Choice, least_plane_estimate, one_of_plane};
use recon::object_dynamics::planar::{ContactLog, PlanarMass, PlanarTruth};
use recon::observer::contacts::ContactNoiseLevel;
use recon::observer::planar::{PlaneEstimate, PlaneOptions, estimate_plane, plane_noise};
use recon_io::{
    Evidence, Level, PlanarKnown, PlaneEstimateData, Sensors, SummaryOf, Verdict, brief, brief_to,
    explanation, mode_figures, sensor_fault, verdict_figures, write_plane_estimate_report,
};
use serde_json::{Value, json};
use std::error::Error;
use std::io::{self, Write};

/// Share of the samples whose motion must be relied on for a result without reservations.
pub(super) const ENOUGH: f64 = 0.5;

/// A log in the plane and what was estimated from it.
pub(crate) struct PlanarMotion {
    pub(super) log: ContactLog,
    pub(super) noise: ContactNoiseLevel,
    pub(super) estimate: PlaneEstimate,
    known_body: bool,
    /// Bounds on the outline, where there are any.
    pub(super) bounds: Option<PlanarBounds>,
    /// What is to be said of readings that repeat.
    of_readings: Vec<String>,
    /// What is to be said of the bounds.
    of_bounds: Vec<String>,
    /// Why it was modelled as it is, where an accuracy was wanted.
    pub(crate) choice: Option<Choice>,
}

/// Estimates the motion, by the least model that serves where an accuracy is wanted, and of all poses their covariances where those are wanted; truth in
/// the log is only compared with.
pub(crate) fn planar_motion(
    log: ContactLog,
    known: &PlanarKnown,
    accuracy: Option<Accuracy>,
    covariances: bool,
) -> Result<PlanarMotion, CliError> {
    let friction: Vec<_> = known.palms.iter().map(|(_, friction)| *friction).collect();
    let (log, of_readings) = plane_without_repeated(log, &friction)?;
    let noise = noise(&log, known)?;
    let options = PlaneOptions {
        body: known.mass,
        size: known.size,
        suspects: true,
        mode_odds: true,
        pose_covariances: covariances,
        ..PlaneOptions::new(noise, known.gravity, friction)
    };
    let (log, estimate, known_body, choice) = match accuracy {
        None => {
            let estimate = estimate_plane(&log, &options)?;
            (log, estimate, known.mass.is_some(), None)
        }
        Some(wanted) => {
            let least = least_plane_estimate(&log, &options, wanted)?;
            let log = one_of_plane(&log, least.every)?;
            (log, least.estimate, least.is_of_known_body, Some(least.choice))
        }
    };
    let noise = noise.times(estimate.evidence.rougher);
    let (bounds, of_bounds) = bounded(&log, &estimate, noise.contact);
    Ok(PlanarMotion { log, noise, estimate, known_body, of_readings, bounds, of_bounds, choice })
}

/// Bounds on the outline, and what is to be said of them.
fn bounded(
    log: &ContactLog,
    estimate: &PlaneEstimate,
    contact_noise: f64,
) -> (Option<PlanarBounds>, Vec<String>) {
    if !estimate.reliability.is_reliable() {
        let why = "There are no bounds on the outline: the motion is not to be relied on.".to_owned();
        return (None, vec![why]);
    }
    match motion_bounds(log, estimate, contact_noise, CONFIDENCE) {
        Ok(Some(bounds)) => {
            let warnings = bounds.warnings.clone();
            (Some(bounds), warnings)
        }
        Ok(None) => {
            (None, vec!["There are no bounds on the outline: no sample's motion is relied on.".to_owned()])
        }
        Err(error) => {
            let why = error.source().map_or_else(|| error.to_string(), ToString::to_string);
            (None, vec![format!("The contacts give no bounds on the outline ({why}).")])
        }
    }
}

/// As it is stated, and what is not from the roughness of the readings.
fn noise(log: &ContactLog, known: &PlanarKnown) -> Result<ContactNoiseLevel, CliError> {
    let sensors = &known.sensors;
    let length = known.size.unwrap_or_else(|| size(log));
    if length == 0.0 {
        return Err(CliError::SizeNotStated);
    }
    let guessed = ContactNoiseLevel::guessed_floor(known.gravity, length);
    let floor = sensors.contact_speed_std.unwrap_or(guessed);
    let friction: Vec<_> = known.palms.iter().map(|(_, friction)| *friction).collect();
    let rough =
        plane_noise(log, &friction, floor).map_err(recon::observer::planar::PlaneEstimateError::from)?;
    // Impulses are read where their noise is stated.
    Ok(as_stated(sensors, ContactNoiseLevel { impulse: None, ..rough }, 1.0))
}

/// Root mean square of the distance of contacts from the mean of those at the same time, m.
fn size(log: &ContactLog) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0_f64);
    for sample in log.samples() {
        let contacts: Vec<_> = sample.palms.iter().filter_map(|palm| palm.p_WC).collect();
        let mean = contacts.iter().sum::<glam::DVec2>() / contacts.len().max(1) as f64;
        squares += contacts.iter().map(|c| c.distance_squared(mean)).sum::<f64>();
        count += contacts.len() as f64;
    }
    (squares / count.max(1.0)).sqrt()
}

impl PlanarMotion {
    /// The log as it was estimated: fewer samples where an accuracy needs no more.
    pub(crate) fn log(&self) -> &ContactLog {
        &self.log
    }

    /// What was estimated from it.
    pub(crate) fn estimate(&self) -> &PlaneEstimate {
        &self.estimate
    }

    /// Whether mass and moment of inertia are as stated.
    pub(crate) fn is_of_known_body(&self) -> bool {
        self.known_body
    }

    /// Whether it is to be relied on, in a sentence.
    pub(crate) fn verdict(&self) -> String {
        self.judged().text
    }

    /// What it rests on.
    pub(crate) fn evidence(&self) -> Vec<Evidence> {
        let mut all = evidence(&self.estimate, &self.noise, self.share(), self.known_body);
        all.extend(self.choice.iter().flat_map(choice_rows));
        all
    }

    /// Whether it is to be relied on, at most samples.
    pub(crate) fn is_reliable(&self) -> bool {
        self.estimate.reliability.is_reliable() && self.share() >= ENOUGH
    }

    fn share(&self) -> f64 {
        let relied = self.estimate.relied_on.iter().filter(|relied| **relied).count();
        relied as f64 / self.estimate.relied_on.len().max(1) as f64
    }

    /// What the reader must know.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let mut all = self.of_readings.clone();
        // Of what is not to be relied on at all the verdict has the reasons.
        if self.estimate.reliability.is_reliable() && self.share() < 1.0 {
            let doubtful = self.estimate.relied_on.iter().filter(|relied| !**relied).count();
            all.push(format!(
                "at {doubtful} of {} samples the motion is not relied on (relied_on in motion.csv is 0)",
                self.estimate.relied_on.len()
            ));
        }
        all.extend(self.estimate.mode_odds.as_ref().and_then(mode_doubts));
        all.extend(self.of_bounds.iter().cloned());
        all.extend(self.choice.iter().filter(|choice| !choice.is_reached).map(Choice::verdict));
        all
    }

    /// Whether the motion may be relied on, and why.
    fn judged(&self) -> Verdict {
        verdict(&self.estimate, self.share(), self.known_body)
    }

    /// What to do next.
    fn next(&self) -> &'static str {
        let reliable = self.judged().level == Level::Good;
        // A moment that is known to half of itself is learned.
        let learned = self.estimate.inertia.1 < 0.5 * self.estimate.inertia.0;
        let (bounds, identified) = (self.bounds.as_ref().map(|bounds| bounds.areas), !self.known_body);
        Advice { reliable, bounds, identified, learned, in_plane: true }.next()
    }

    /// The page of the motion, under a title.
    pub(crate) fn write_report(&self, title: &str, to: &mut dyn Write) -> io::Result<()> {
        let estimate = &self.estimate;
        let page = PlaneEstimateData {
            title: title.to_owned(),
            verdict: self.judged(),
            note: NOTE.to_owned(),
            log: &self.log,
            estimate,
            areas: self.bounds.as_ref().map(|bounds| bounds.areas),
            panels: self.panels(),
            shape: self.bounds.iter().map(PlanarBounds::panel).collect(),
            evidence: self.evidence(),
            warnings: self.warnings(),
            next: self.next().to_owned(),
        };
        write_plane_estimate_report(&page, to)
    }

    /// Bounds on the outline, where there are any.
    pub(crate) fn bounds(&self) -> Option<&PlanarBounds> {
        self.bounds.as_ref()
    }

    /// Numbers for summary.json.
    pub(crate) fn figures(&self) -> Value {
        let Self { estimate, noise, .. } = self;
        let evidence = &estimate.evidence;
        let last = estimate.deviations.last().copied().unwrap_or_default();
        let faults = estimate.suspects.iter().filter(|of| of.deviation.is_finite()).map(sensor_fault);
        let verdict = self.judged();
        let times = self.log.samples();
        let mut figures = SummaryOf::PlaneReconstruction.named(json!({
            "method": "contacts and forces, nodes linked by measured impulses",
            "status": if evidence.settled { "converged" } else { "not settled" },
            "verdict": verdict_figures(&verdict),
            "t_first_s": times.first().map(|sample| sample.t),
            "t_last_s": times.last().map(|sample| sample.t),
            "relied_on_share": self.share(),
            "mass_kg": estimate.mass.0,
            "inertia_kg_m2": estimate.inertia.0,
            "body_as_stated": self.known_body,
            "samples": evidence.samples,
            "nodes": evidence.nodes,
            "conditions": evidence.conditions,
            "chi_squared": evidence.misfit,
            "iterations": evidence.iterations,
            "noise": {
                "contact_m": noise.contact,
                "force_n": noise.force_fixed,
                "force_share": noise.force_share,
                "contact_speed_m_per_s": noise.floor,
            },
            "std_at_the_end": {
                "position_m": last.p_WCm.to_array(),
                "orientation_rad": last.phi0,
                "velocity_m_per_s": last.v_WCm.to_array(),
                "angular_velocity_rad_per_s": last.omega0,
            },
            "warnings": self.warnings(),
        }));
        if let Some(choice) = &self.choice {
            figures["least_model"] = choice_figures(choice);
        }
        if !estimate.suspects.is_empty() {
            figures["sensor_faults"] = faults.collect();
        }
        if let Some(modes) = &estimate.mode_odds {
            mode_figures(modes, &mut figures);
        }
        if !estimate.explanations.is_empty() {
            figures["explanations"] = estimate.explanations.iter().map(explanation).collect();
        }
        if let Some(bounds) = &self.bounds {
            figures["bounds"] = bounds.figures();
            figures["bounds_about"] = bounds.about.clone();
            figures["bounds_frame"] = "axes of the world at the first sample, from the centre of mass".into();
        }
        if !self.known_body {
            figures["std_mass_kg"] = (estimate.mass.0 * estimate.mass.1).into();
            figures["std_inertia_kg_m2"] = estimate.inertia.1.into();
        }
        if let Some(errors) = self.errors() {
            let most = |of: fn(&[f64; 4]) -> f64| errors.iter().map(of).fold(0.0, f64::max);
            figures["largest_error"] =
                json!({ "position_m": most(|e| e[1].hypot(e[2])), "orientation_rad": most(|e| e[3].abs()) });
        }
        figures
    }

    /// In words for the console.
    pub(crate) fn describe(&self) -> String {
        let estimate = &self.estimate;
        let mut text = format!("{}\n", self.judged().text);
        text.extend(self.warnings().iter().map(|w| format!("Warning: {w}\n")));
        let times = self.log.samples();
        text += &format!(
            "{} samples from t = {} s to {} s\n",
            times.len(),
            brief(times[0].t),
            brief(times[times.len() - 1].t)
        );
        let mut line = |name: &str, value: String| text += &format!("  {name:<22} {value}\n");
        let as_stated = |(value, deviation): (f64, f64), unit: &str| match self.known_body {
            true => format!("{} {unit}, as stated", brief(value)),
            false => format!("{} +- {} {unit}", brief(value), brief_to(2, deviation)),
        };
        line("size, about", format!("{} m (lengths are in metres)", brief_to(3, size(&self.log))));
        let (mass, share) = estimate.mass;
        line("mass", as_stated((mass, mass * share), "kg"));
        line("moment of inertia", as_stated(estimate.inertia, "kg m^2"));
        line("chi-squared", format!("{} a condition", brief(estimate.evidence.misfit)));
        line("relied on", format!("{} % of the samples", brief((1000.0 * self.share()).floor() / 10.0)));
        if let Some(last) = estimate.deviations.last() {
            let place = last.p_WCm.max_element();
            line("known at the end to", format!("{} m, {} rad", brief(place), brief(last.phi0)));
        }
        if let Some(bounds) = &self.bounds {
            let [lower, upper] = bounds.areas.map(brief);
            let percent = brief(100.0 * CONFIDENCE);
            line("outline", format!("between {lower} and {upper} m^2 at {percent} %"));
        }
        line("next", self.next().to_owned());
        text
    }

    /// Time and errors of place (m) and turn (rad) at samples that are relied on, where the truth is known.
    pub(super) fn errors(&self) -> Option<Vec<[f64; 4]>> {
        let truth = self.log.truth()?;
        let one = |(k, truth_now): (usize, &PlanarTruth)| {
            let state = &self.estimate.states[k];
            let off = state.p_WCm - truth_now.p_WCm;
            let turn = state.phi0 - (truth_now.phi0 - truth[0].phi0);
            self.estimate.relied_on[k].then_some([self.log.samples()[k].t, off.x, off.y, turn])
        };
        Some(truth.iter().enumerate().filter_map(one).collect())
    }
}

/// What is known beside a log of two palms hinged at the origin, without friction.
pub(crate) fn hinged_pair(
    gravity: f64,
    mass: Option<PlanarMass>,
    contact_std: Option<f64>,
    force_std: Option<f64>,
) -> PlanarKnown {
    let sensors = Sensors { contact_std, force_std, ..Sensors::default() };
    let line = (recon::contact_kinematics::planar::PalmSurface::Line, Some(0.0));
    PlanarKnown { gravity, mass, size: None, palms: vec![line; 2], sensors }
}
