//! From contacts and palm poses alone.

use super::bounds::NOTABLE_NOISE;
use super::bounds::{BoundsResult, bounds};
use super::folder::write_touch_folder;
use super::sensor_words::UNEXPLAINED;
use super::without_forces_page::without_forces_page;
use crate::error::CliError;
use crate::progress::Progress;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{Direction, PalmFrame};
use recon::object_dynamics::SensorLog;
use recon::observer::faults::Suspect;
use recon::observer::three_palms::no_force::{KnownTouch, NoForceEstimate, estimate_without_forces};
use recon::shape_bounds::ContactSample;
use recon_io::{FolderTarget, MotionState, Scene, SummaryOf, brief, brief_to, sensor_fault, status_in_words};
use serde_json::{Value, json};
use std::error::Error;

/// Where the entries of the inertia over mass begin in the covariance.
const FIRST_OF_INERTIA: usize = 12;

/// What contacts and poses of three flat palms tell.
pub(crate) struct WithoutForces {
    pub(crate) found: NoForceEstimate,
    /// Contacts at the nodes of the estimate, body axes, m from the centre of mass.
    pub(crate) points: Vec<DVec3>,
    /// Bounds on the shape, where contacts are exact.
    pub(crate) bounded: Option<BoundsResult>,
    pub(crate) warnings: Vec<String>,
}

/// Motion and shape of an ellipsoid, and its bounds.
pub(crate) fn without_forces(
    log: SensorLog,
    mut warnings: Vec<String>,
    scene: &Scene,
    progress: &Progress,
) -> Result<WithoutForces, CliError> {
    let (log, _) = log.split_truth();
    progress.step("estimating motion and shape");
    let known = KnownTouch {
        gravity: DVec3::new(0.0, 0.0, -scene.gravity),
        contact_noise: scene.sensors.contact_std.filter(|noise| *noise > 0.0),
    };
    let found = estimate_without_forces(&log, &known)?;
    progress.step("bounding the shape");
    let noise = found.evidence.noise_explains;
    let contacts = contacts(&log, &found);
    let against = contradicted(&found.evidence.suspects);
    let bounded = if let Some(against) = against {
        warnings.push(format!(
            "The contacts speak against what the scene and the log say of the palms: {against}. It counts in all deviations; bounds on the shape, which \
             take palms as they are said to stand, are not given."
        ));
        None
    } else if noise > NOTABLE_NOISE * found.shape.semi_axes.max_element() {
        warnings.push(format!(
            "There are no bounds on the shape: means of contacts are noisy by {noise:.1e} m, and without forces it is not known \
             how far that moves the poses. The fitted ellipsoid comes with its deviations."
        ));
        None
    } else {
        match bounds(&contacts) {
            Ok(mut bounded) => {
                warnings.append(&mut bounded.warnings);
                Some(bounded)
            }
            Err(error) => {
                let why = error.source().map_or_else(|| error.to_string(), ToString::to_string);
                warnings.push(format!("The contacts give no bounds under this motion ({why})."));
                None
            }
        }
    };
    let points = contacts.iter().map(|contact| contact.point).collect();
    Ok(WithoutForces { found, points, bounded, warnings })
}

/// The constant that is farthest from what it was taken for, if chance does not take it there.
fn contradicted(suspects: &[Suspect]) -> Option<&Suspect> {
    let most = suspects.iter().max_by(|a, b| a.score().abs().total_cmp(&b.score().abs()))?;
    (most.score().abs() > UNEXPLAINED).then_some(most)
}

impl WithoutForces {
    /// Times of the motion, s.
    pub(crate) fn times(&self) -> Vec<f64> {
        self.found.motion.iter().map(|m| m.t).collect()
    }

    pub(crate) fn motion(&self) -> Vec<MotionState> {
        let state = |m: &recon::observer::three_palms::MotionState| MotionState {
            p_WCm: m.p_WCm,
            R_WO: m.R_WO,
            v_WCm: m.v_WCm,
            w_WO: m.w_WO,
        };
        self.found.motion.iter().map(state).collect()
    }

    /// Writes its folder, whose page is under a title; returns the summary.
    pub(crate) fn write(&self, target: FolderTarget, title: &str) -> Result<Value, CliError> {
        let figures = self.figures();
        let page = without_forces_page(title, self);
        let motion = (&self.motion()[..], &self.found.deviations[..]);
        write_touch_folder(target, &self.times(), motion, self.bounded.as_ref(), (&page, &figures))?;
        Ok(figures)
    }

    /// Moments and products of the inertia over mass (xx, yy, zz, xy, xz, yz), m^2, with their standard deviations.
    pub(crate) fn inertia_over_mass(&self) -> [(f64, f64); 6] {
        let (known, covariance) = (six(&self.found.inertia_per_mass), &self.found.covariance);
        std::array::from_fn(|i| {
            let at = FIRST_OF_INERTIA + i;
            (known[i], covariance[(at, at)].max(0.0).sqrt())
        })
    }

    /// The summary.
    pub(crate) fn figures(&self) -> Value {
        figures(self)
    }

    /// What came out, in words.
    pub(crate) fn describe(&self) -> String {
        describe(self)
    }
}

/// Contacts in body axes with outward normals, at the nodes of the estimate.
fn contacts(log: &SensorLog, found: &NoForceEstimate) -> Vec<ContactSample> {
    let mut all = Vec::new();
    for motion in &found.motion {
        let samples = log.samples();
        // Nodes stand at samples.
        let after = samples.partition_point(|s| s.t < motion.t - 1e-9);
        let Some(sample) = samples.get(after) else { continue };
        let turn = motion.R_WO.inverse();
        for palm in &sample.palms {
            let Some((frame, s)) = PalmFrame::from_normal(palm.normal).ok().zip(palm.contact) else {
                continue;
            };
            let point = turn * (frame.contact_from_sensor(s) - motion.p_WCm);
            let normal = Direction::new_unchecked(turn * -frame.n);
            all.push(ContactSample { point, normal });
        }
    }
    all
}

fn six(m: &DMat3) -> [f64; 6] {
    [m.x_axis.x, m.y_axis.y, m.z_axis.z, m.y_axis.x, m.z_axis.x, m.z_axis.y]
}

fn figures(made: &WithoutForces) -> Value {
    let WithoutForces { found, bounded, warnings, .. } = made;
    let NoForceEstimate { shape, evidence, covariance, .. } = found;
    let deviations = |first: usize| -> Vec<f64> {
        (first..first + 6).map(|i| covariance[(i, i)].max(0.0).sqrt()).collect()
    };
    let q = shape.orientation;
    SummaryOf::WithoutForces.named(json!({
        "method": "motion of an ellipsoid fitted to contacts and palm poses",
        "status": status_in_words(evidence.status),
        "semi_axes_m": shape.semi_axes.to_array(),
        "centre_m": shape.centre.to_array(),
        "orientation_wxyz": [q.w, q.x, q.y, q.z],
        "inertia_over_mass_m2": six(&found.inertia_per_mass),
        "std_inertia_over_mass_m2": deviations(FIRST_OF_INERTIA),
        "samples": evidence.samples,
        "residual_rms_m": evidence.residual_rms,
        "noise_explains_m": evidence.noise_explains,
        "rank": evidence.rank,
        "condition": evidence.condition,
        "weakest": evidence.weakest,
        "std_weakest": evidence.weakest_deviation,
        "sensor_faults": evidence.suspects.iter().filter(|of| of.deviation.is_finite()).map(sensor_fault).collect::<Vec<_>>(),
        "bounds": bounded.as_ref().map(|b| json!({
            "lower_volume_m3": b.drawn.lower.volume,
            "upper_volume_m3": b.drawn.upper.as_ref().map(|u| u.volume),
            "contradiction_m": b.contradiction,
        })),
        "warnings": warnings,
    }))
}

fn describe(made: &WithoutForces) -> String {
    let WithoutForces { found, bounded, warnings, .. } = made;
    let NoForceEstimate { shape, evidence, .. } = found;
    let a = shape.semi_axes;
    let mut lines = vec![format!(
        "An ellipsoid in its motion fits the contacts to {:.1e} m (noise: {:.1e} m); the least certain is {} ({:.1e}).",
        evidence.residual_rms, evidence.noise_explains, evidence.weakest, evidence.weakest_deviation
    )];
    lines.extend(warnings.iter().map(|w| format!("Warning: {w}")));
    lines.push(format!("  semi-axes              {}, {}, {} m", brief(a.x), brief(a.y), brief(a.z)));
    let c = shape.centre;
    lines.push(format!(
        "  centre                 ({}, {}, {}) m from the centre of mass",
        brief(c.x),
        brief(c.y),
        brief(c.z)
    ));
    let known = made.inertia_over_mass();
    for (of, range) in [("moments over mass", 0..3), ("products over mass", 3..6)] {
        let words = range.map(|i| format!("{} +- {}", brief(known[i].0), brief_to(2, known[i].1)));
        lines.push(format!("  {of:<22} {} m^2", words.collect::<Vec<_>>().join(", ")));
    }
    if let Some(bounded) = bounded {
        lines.push(format!("  lower bound            {} m^3", brief(bounded.drawn.lower.volume)));
        if let Some(upper) = &bounded.drawn.upper {
            lines.push(format!("  upper bound            {} m^3", brief(upper.volume)));
        }
    }
    lines.push(
        "  next                   forces, where palms measure them, tell the mass too (without --without-forces)"
            .to_owned(),
    );
    lines.join("\n")
}
