//! What an estimate knows of the outline: for the proof all of its contacts with their noise, for a planner some that stand for them.

use super::super::dynamics::Dynamics;
use super::super::track::Track;
use crate::knowledge::{Knowledge, KnowledgeError};
use crate::planar::PlanarKnowledge;
use contact_kinematics::planar::PalmSurface;
use glam::{DMat2, DVec2};
use object_dynamics::planar::ContactLog;
use observer::planar::{PlaneContact, PlaneDeviations, PlaneEstimate};
use shape_bounds::exact_hull::planar::Direction;
use shape_bounds::planar::ContactSample;
use shape_bounds::planar::noise::{ContactNoise, NoisyContact};
use std::f64::consts::TAU;

/// Samples whose contacts bound the body, at most: more of them gain next to nothing.
const SAMPLES: usize = 6000;

/// Contacts of each palm in body axes at the samples that are relied on, with the noise of the sensors along the palm (`contact_noise`, m), which
/// turns the normal of a curved one, and the deviations of the pose, which may be correlated from sample to sample in any way.
#[must_use]
pub fn noisy_curves(
    log: &ContactLog,
    estimate: &PlaneEstimate,
    contact_noise: f64,
) -> Vec<Vec<NoisyContact>> {
    let samples = estimate.states.len();
    let stride = samples.div_ceil(SAMPLES).max(1);
    let curve = |(surface, contacts): (&PalmSurface, &Vec<Option<PlaneContact>>)| -> Vec<NoisyContact> {
        let turning = contact_noise * curvature(*surface);
        let used = (0..samples).step_by(stride).filter(|k| estimate.relied_on[*k]);
        used.filter_map(|k| Some(noisy(&contacts[k]?, &estimate.deviations[k], [contact_noise, turning])))
            .collect()
    };
    log.surfaces().iter().zip(&estimate.contacts).map(curve).collect()
}

/// A contact with noise along the palm (m) and of the normal (rad), under a pose with these deviations.
fn noisy(contact: &PlaneContact, pose: &PlaneDeviations, [along, normal]: [f64; 2]) -> NoisyContact {
    let t = contact.normal.perp();
    NoisyContact {
        contact: ContactSample {
            point: contact.p_OC,
            normal: Direction::from_angle(contact.normal.to_angle()),
        },
        noise: ContactNoise {
            point: DMat2::from_cols(t * t.x, t * t.y) * (along * along),
            normal,
            // Along no axis is it more than both together, however they go along with each other.
            pose_translation: pose.p_WCm.length(),
            pose_rotation: pose.phi0,
        },
    }
}

/// By which noise along a palm turns its normal, 1/m.
fn curvature(surface: PalmSurface) -> f64 {
    match surface {
        PalmSurface::Line => 0.0,
        PalmSurface::Arc { radius } | PalmSurface::Cup { radius } => 1.0 / radius,
    }
}

/// What is known after a motion.
pub struct Look {
    /// The bounds, at their confidence.
    pub proven: PlanarKnowledge,
    /// Contacts that stand for all those about a normal, as if they were exact: what is planned on, never what is proven.
    pub planned_on: PlanarKnowledge,
    /// Where palms and body are.
    pub track: Track,
}

impl Look {
    /// Of an estimate that is relied on. Bounds hold with probability `level` and are stated at `stated` for all looks; contacts are planned on
    /// about `spacing` rad apart.
    ///
    /// # Errors
    /// [`KnowledgeError`] where contacts contradict each other beyond their noise.
    pub fn new(
        log: &ContactLog,
        estimate: &PlaneEstimate,
        contact_noise: f64,
        (level, stated): (f64, f64),
        spacing: f64,
        (palms, dynamics): ([f64; 2], Option<Dynamics>),
    ) -> Result<Self, KnowledgeError> {
        let curves = noisy_curves(log, estimate, contact_noise);
        let proven = PlanarKnowledge::estimated(&curves, level, stated)?;
        let phi = estimate.states.last().map_or(0.0, |state| state.phi0);
        let track = Track::about(palms, phi, DVec2::ZERO, dynamics);
        Ok(Self { planned_on: standing_for(&curves, spacing), proven, track })
    }
}

/// The mean contact of every sector of normals, where it does not contradict its neighbours.
fn standing_for(curves: &[Vec<NoisyContact>], spacing: f64) -> PlanarKnowledge {
    let count = (TAU / spacing).ceil().max(3.0);
    let mut sectors = vec![(DVec2::ZERO, DVec2::ZERO, 0.0); count as usize];
    for contact in curves.iter().flatten().map(|c| c.contact) {
        let sector = (contact.normal.angle().rem_euclid(TAU) / TAU * count) as usize;
        if let Some(sum) = sectors.get_mut(sector) {
            *sum = (sum.0 + contact.point, sum.1 + contact.normal.get(), sum.2 + 1.0);
        }
    }
    let mut known = PlanarKnowledge::exact();
    for (point, normal, number) in sectors.into_iter().filter(|sum| sum.2 > 0.0) {
        if let Ok(normal) = Direction::new(normal) {
            // One that is beyond the line of a neighbour, by noise, is left out: nothing is proven by these.
            drop(known.insert(ContactSample { point: point / number, normal }));
        }
    }
    known
}
