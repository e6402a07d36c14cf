//! Logs of the plane as logs of space: the plane is that of the world's x and z, whose y axis points away from who looks at it.
//!
//! Lines are planes along y, arcs and cups are spheres. What moves in the plane obeys the same laws in both, so that one estimator serves
//! them.

use super::contact_log::{ContactLog as PlanarContactLog, ContactLogSample, PalmSample};
use super::lagrange::lagrange;
use super::log::{PlanarLog, PlanarSample, PlanarTruth};
use crate::BodyState;
use crate::contact_log::{
    ContactLog, ContactLogError, ContactPoints, ForceChannel, PalmRecord, RecordedMotion,
};
use contact_kinematics::planar::PalmSurface as PlanarSurface;
use contact_kinematics::{PalmSurface, SurfacePose, planar};
use glam::{DQuat, DVec2, DVec3};

/// A vector of the plane in space.
#[must_use]
pub fn in_space(v: DVec2) -> DVec3 {
    DVec3::new(v.x, 0.0, v.y)
}

/// The part of a vector of space in the plane.
#[must_use]
pub fn in_plane(v: DVec3) -> DVec2 {
    DVec2::new(v.x, v.z)
}

/// A counter-clockwise turn of the plane, rad, in space.
#[must_use]
pub fn turn_in_space(angle: f64) -> DQuat {
    DQuat::from_axis_angle(-DVec3::Y, angle)
}

impl PlanarTruth {
    /// The same state in space.
    #[must_use]
    pub fn in_space(&self) -> BodyState {
        BodyState {
            p_WCm: in_space(self.p_WCm),
            R_WO: turn_in_space(self.phi0),
            v_WCm: in_space(self.v_WCm),
            w_WO: -DVec3::Y * self.omega0,
        }
    }
}

impl PlanarContactLog {
    /// The log in space, of palms of the given coefficients of friction where they are known: along the normal alone where it is zero.
    ///
    /// # Errors
    /// [`ContactLogError`] for what a log of space does not take, such as a palm that jumps.
    pub fn in_space(&self, friction: &[Option<f64>]) -> Result<ContactLog, ContactLogError> {
        let times = self.samples().iter().map(|sample| sample.t).collect();
        let palm = |(i, surface): (usize, &PlanarSurface)| {
            let readings = self.samples().iter().map(|sample| sample.palms[i]);
            record(*surface, friction.get(i).copied().flatten(), readings)
        };
        let palms = self.surfaces().iter().enumerate().map(palm).collect();
        let truth = self.truth().map(|truth| truth.iter().map(PlanarTruth::in_space).collect());
        ContactLog::new(times, palms, truth)
    }
}

fn record(
    surface: PlanarSurface,
    friction: Option<f64>,
    readings: impl Iterator<Item = PalmSample> + Clone,
) -> PalmRecord {
    let pose = |pose: planar::SurfacePose| SurfacePose {
        p_WP: in_space(pose.p_WP),
        R_WP: turn_in_space(pose.angle).normalize(),
    };
    let impulses: Option<Vec<DVec3>> = readings.clone().map(|r| r.impulse.map(in_space)).collect();
    let first = readings.clone().next().map(|r| r.pose);
    let moves = readings.clone().any(|r| Some(r.pose) != first);
    PalmRecord {
        surface: match surface {
            PlanarSurface::Line => PalmSurface::Plane,
            PlanarSurface::Arc { radius } => PalmSurface::Sphere { radius },
            PlanarSurface::Cup { radius } => PalmSurface::Cup { radius },
        },
        friction,
        motion: match first {
            Some(first) if !moves => RecordedMotion::Fixed(pose(first)),
            _ => RecordedMotion::Poses(readings.clone().map(|r| pose(r.pose)).collect()),
        },
        contacts: ContactPoints::World(readings.clone().map(|r| r.p_WC.map(in_space)).collect()),
        force: ForceChannel::Three(readings.map(|r| in_space(r.force)).collect()),
        impulse: impulses.map_or(ForceChannel::Missing, ForceChannel::Three),
        torque: None,
        hinge: None,
        truth: None,
        largest_offset: f64::INFINITY,
    }
}

impl PlanarLog {
    /// What the two hinged palms sensed as a log of any palms, with normal forces, N: those that were measured, else those of the motor torques
    /// for palms with moments of inertia about the hinge, kg m^2: `f_1 = (tau_1 - I_1 A_1) / s_1`, `f_2 = (I_2 A_2 - tau_2) / s_2`. None where
    /// neither was measured at some sample, or a torque has no lever.
    #[must_use]
    pub fn contact_log(&self, palm_inertias: [f64; 2]) -> Option<PlanarContactLog> {
        let samples = self.samples();
        let at = |k: usize| -> Option<ContactLogSample> {
            let sample = &samples[k];
            let pair = sample.palms().ok()?;
            let (along, normals) = (pair.along(), pair.normals());
            let forces = match sample.forces {
                Some(forces) => forces,
                None => forces_of_torques(samples, k, palm_inertias)?,
            };
            let palm = |i: usize| PalmSample {
                pose: planar::SurfacePose {
                    p_WP: DVec2::ZERO,
                    angle: pair.angles()[i] + if i == 1 { std::f64::consts::PI } else { 0.0 },
                },
                p_WC: sample.contacts[i].map(|s| along[i] * s),
                force: if sample.contacts[i].is_some() { normals[i] * forces[i] } else { DVec2::ZERO },
                impulse: None,
            };
            Some(ContactLogSample { t: sample.t, palms: vec![palm(0), palm(1)] })
        };
        let all = (0..samples.len()).map(at).collect::<Option<Vec<_>>>()?;
        PlanarContactLog::new(vec![PlanarSurface::Line; 2], all, self.truth().map(<[_]>::to_vec)).ok()
    }
}

/// Smallest distance of a contact from the hinge, over that of the other one, that is a lever.
const LEAST_LEVER: f64 = 1e-3;

fn forces_of_torques(samples: &[PlanarSample], k: usize, inertias: [f64; 2]) -> Option<[f64; 2]> {
    let torques = samples[k].torques?;
    let contacts = samples[k].contacts;
    let longest = contacts.into_iter().flatten().fold(0.0, |far: f64, s| far.max(s.abs()));
    let mut forces = [0.0; 2];
    for i in 0..2 {
        let Some(s) = contacts[i] else { continue };
        if s.abs() < LEAST_LEVER * longest || s == 0.0 {
            return None;
        }
        let inertial = if inertias[i] == 0.0 { 0.0 } else { inertias[i] * acceleration(samples, k, i) };
        let moment = if i == 0 { torques[0] - inertial } else { inertial - torques[1] };
        forces[i] = moment / s;
    }
    Some(forces)
}

/// Samples that the polynomial through a palm's angles is laid through.
const AROUND: usize = 7;

/// Angular acceleration of a palm, rad/s^2: that of the polynomial through its angles at the samples around, whose error falls with the fifth
/// power of the time between them.
fn acceleration(samples: &[PlanarSample], k: usize, palm: usize) -> f64 {
    let count = AROUND.min(samples.len());
    let from = k.saturating_sub(count / 2).min(samples.len() - count);
    let around = &samples[from..from + count];
    let angle = |s: &PlanarSample| if palm == 0 { s.angles[0] } else { s.angles[0] + s.angles[1] };
    let base = angle(&around[0]);
    // Relative to the first angle: the weights add up to zero, and large angles would cancel.
    let one =
        |s: &PlanarSample| lagrange(around.iter().map(|s| s.t), s.t, samples[k].t)[2] * (angle(s) - base);
    around.iter().map(one).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plane_turns_as_space_does() {
        let (v, angle) = (DVec2::new(0.3, -1.2), 0.7);
        let turned = in_space(DVec2::from_angle(angle).rotate(v));
        assert!((turn_in_space(angle) * in_space(v) - turned).length() < 1e-15);
        assert!((in_plane(turned) - DVec2::from_angle(angle).rotate(v)).length() < 1e-15);
        // Of an arm and an angular velocity the velocity.
        let truth = PlanarTruth { omega0: 2.0, ..PlanarTruth::default() };
        assert!((truth.in_space().w_WO.cross(in_space(v)) - in_space(2.0 * v.perp())).length() < 1e-15);
    }

    #[test]
    fn accelerations_of_polynomials_are_exact() {
        let at = |t: f64| 0.2 + t - 1.5 * t * t + 0.4 * t.powi(5);
        let times = [0.0, 0.01, 0.025, 0.03, 0.04, 0.06, 0.07, 0.08];
        let samples: Vec<PlanarSample> = times
            .iter()
            .map(|&t| PlanarSample { t, angles: [at(t), 1.0], ..PlanarSample::default() })
            .collect();
        for (k, t) in times.iter().enumerate() {
            for palm in 0..2 {
                let error = acceleration(&samples, k, palm) - (8.0 * t.powi(3) - 3.0);
                assert!(error.abs() < 1e-9, "{k}: {error}");
            }
        }
    }
}
