//! How far twists of palms that follow from their poses may be off: those of palms that shake faster than they are sampled, or whose poses are noisy.

use super::record::Contact;
use crate::predicted::{Predicted, predicted};
use glam::DMat3;
use object_dynamics::{ContactLog, LoggedPalm, TwistSource};
use std::f64::consts::FRAC_1_SQRT_2;

/// Velocity that is missed, over what a sample is predicted wrongly by and the spacing, of poses that alternate: half of pi, and of a spline through resolved
/// ones not more.
const OF_ALTERNATING: f64 = 1.6;

/// Deviations of a palm's velocity (m/s) and angular velocity (rad/s) in root mean square: none of twists that were stated.
#[derive(Clone, Copy, Default)]
pub(super) struct MissedTwist {
    velocity: f64,
    spin: f64,
}

impl MissedTwist {
    /// Of all palms of a log.
    pub(super) fn of(log: &ContactLog) -> Vec<Self> {
        log.palms().iter().map(|palm| Self::of_palm(log.times(), palm)).collect()
    }

    fn of_palm(times: &[f64], palm: &LoggedPalm) -> Self {
        if palm.twist_source() != TwistSource::FromPoses {
            return Self::default();
        }
        let pose = |k: usize| palm.motion(k).pose;
        // As a spline is of higher order at samples, the error falls once more.
        let missed = |of: Predicted| OF_ALTERNATING * of.off * of.falls / of.spacing;
        let velocity = predicted(times, |k| pose(k).p_WP.to_array()).map_or(0.0, missed);
        // A small turn moves each of two axes by its angle.
        let spin = predicted(times, |k| DMat3::from_quat(pose(k).R_WP).to_cols_array()).map_or(0.0, missed);
        Self { velocity, spin: spin * FRAC_1_SQRT_2 }
    }

    /// Of the material at a contact, m/s, so far from the origin of the palm's frame.
    pub(super) fn at(&self, arm: f64) -> f64 {
        self.velocity.hypot(self.spin * arm)
    }
}

impl Contact {
    /// Deviation of its condition by itself, m/s, of which `floor` is that of all.
    pub(super) fn floor(&self, floor: f64) -> f64 {
        floor.hypot(self.u_deviation / self.samples.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact_kinematics::{PalmSurface, SurfacePose};
    use glam::{DQuat, DVec3};
    use object_dynamics::{ContactPoints, ForceChannel, PalmRecord, RecordedMotion};

    /// A palm that moves and turns as a sine, of which each sample is `step` rad of its phase later; true rates over its amplitudes, and those told.
    fn shaking(step: f64, phase: f64) -> ([f64; 2], MissedTwist) {
        let h = 0.01;
        let (amplitude, rate) = (0.01, step / h);
        let times: Vec<f64> = (0..300).map(|k| f64::from(k) * h).collect();
        let of = |t: f64| amplitude * (rate * t + phase).sin();
        let pose =
            |t: &f64| SurfacePose::new(DVec3::X * of(*t), DQuat::from_rotation_y(of(*t))).expect("finite");
        let record = PalmRecord {
            surface: PalmSurface::Plane,
            friction: Some(0.0),
            motion: RecordedMotion::Poses(times.iter().map(pose).collect()),
            contacts: ContactPoints::World(vec![None; times.len()]),
            force: ForceChannel::Missing,
            impulse: ForceChannel::Missing,
            torque: None,
            hinge: None,
            truth: None,
            largest_offset: f64::INFINITY,
        };
        let log = ContactLog::new(times.clone(), vec![record], None).expect("a log");
        let palm = &log.palms()[0];
        let squares = times.iter().enumerate().skip(10).take(280).map(|(k, t)| {
            let truth = amplitude * rate * (rate * t + phase).cos();
            let motion = palm.motion(k);
            [(motion.v_WP.x - truth).powi(2), (motion.w_WP.y - truth).powi(2)]
        });
        let sum = squares.fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
        (sum.map(|of| (of / 280.0).sqrt()), MissedTwist::of(&log)[0])
    }

    /// From well resolved to more than half a turn from sample to sample: what is told is what is missed or up to seven times as much.
    #[test]
    fn what_a_spline_misses_of_a_palm_that_shakes_is_told() {
        for step in [0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 2.6, 3.0, 3.12, 3.3] {
            let ([v, w], told) = shaking(step, 0.4);
            for (truth, told) in [(v, told.velocity), (w, told.spin)] {
                assert!(told > 0.8 * truth && told < 7.5 * truth, "{step}: {truth} {told}");
            }
        }
    }

    /// A palm that moves steadily, or whose twists are stated, is off by rounding alone.
    #[test]
    fn nothing_is_missed_of_a_steady_palm() {
        let ([v, _], told) = shaking(1e-3, 0.0);
        assert!(told.velocity < 1e-8 && v < 1e-8, "{} {v}", told.velocity);
    }
}
