//! How far twists of palms that follow from their poses may be off: those of palms that shake faster than they are sampled, whose poses are noisy, or that
//! start and stop.

use super::record::Contact;
use crate::predicted::{Predicted, kinks, predicted};
use glam::DMat3;
use object_dynamics::{ContactLog, LoggedPalm, TwistSource};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;

/// Velocity that is missed, over what a sample is predicted wrongly by and the spacing, of poses that alternate: half of pi, and of a spline through resolved
/// ones not more.
const OF_ALTERNATING: f64 = 1.6;

/// Times what all samples are predicted wrongly by from which on one that is tells of a palm that starts or stops there: next to it the spline errs by far
/// more than elsewhere.
const KINKED: f64 = 3.0;
/// Velocity that is missed there, over what a sample is predicted wrongly by and the spacing: 0.13 where the third derivative jumps, 0.2 to 0.5 where the
/// second one does; samples so far away are off by a quarter of that and less.
const OF_KINK: f64 = 0.3;
const FROM_KINK: usize = 2;

/// Deviations of a palm's velocity (m/s) and angular velocity (rad/s): none of twists that were stated.
#[derive(Clone, Default)]
pub(super) struct MissedTwist {
    /// In root mean square.
    velocity: f64,
    spin: f64,
    /// At samples next to which the palm starts or stops, by their numbers.
    near_kinks: BTreeMap<usize, [f64; 2]>,
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
        let place = |k: usize| pose(k).p_WP.to_array();
        // A small turn moves each of two axes by its angle.
        let turn = |k: usize| (DMat3::from_quat(pose(k).R_WP) * FRAC_1_SQRT_2).to_cols_array();
        let (moved, turned) = (predicted(times, place), predicted(times, turn));
        let mut near_kinks = BTreeMap::<usize, [f64; 2]>::new();
        let mut add = |axis: usize, of: Option<Predicted>, kinks: &dyn Fn(f64) -> Vec<(usize, f64)>| {
            let Some(Predicted { off, spacing, .. }) = of else { return };
            for (k, by) in kinks(KINKED * off) {
                for near in k.saturating_sub(FROM_KINK)..=k + FROM_KINK {
                    let most = &mut near_kinks.entry(near).or_default()[axis];
                    *most = most.max(OF_KINK * by / spacing);
                }
            }
        };
        add(0, moved, &|off| kinks(times, place, off));
        add(1, turned, &|off| kinks(times, turn, off));
        Self { velocity: moved.map_or(0.0, missed), spin: turned.map_or(0.0, missed), near_kinks }
    }

    /// Of the material at a contact of sample `k`, m/s, so far from the origin of the palm's frame.
    pub(super) fn at(&self, k: usize, arm: f64) -> f64 {
        let [velocity, spin] = self.near_kinks.get(&k).copied().unwrap_or_default();
        self.velocity.hypot(velocity).hypot(self.spin.hypot(spin) * arm)
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

    fn told_by(times: &[f64], poses: Vec<SurfacePose>) -> ContactLog {
        let record = PalmRecord {
            surface: PalmSurface::Plane,
            friction: Some(0.0),
            motion: RecordedMotion::Poses(poses),
            contacts: ContactPoints::World(vec![None; times.len()]),
            force: ForceChannel::Missing,
            impulse: ForceChannel::Missing,
            torque: None,
            hinge: None,
            truth: None,
            largest_offset: f64::INFINITY,
        };
        ContactLog::new(times.to_vec(), vec![record], None).expect("a log")
    }

    /// A palm that moves and turns as a sine, of which each sample is `step` rad of its phase later; true rates over its amplitudes, and those told.
    fn shaking(step: f64, phase: f64) -> ([f64; 2], MissedTwist) {
        let h = 0.01;
        let (amplitude, rate) = (0.01, step / h);
        let times: Vec<f64> = (0..300).map(|k| f64::from(k) * h).collect();
        let of = |t: f64| amplitude * (rate * t + phase).sin();
        let pose =
            |t: &f64| SurfacePose::new(DVec3::X * of(*t), DQuat::from_rotation_y(of(*t))).expect("finite");
        let log = told_by(&times, times.iter().map(pose).collect());
        let palm = &log.palms()[0];
        let squares = times.iter().enumerate().skip(10).take(280).map(|(k, t)| {
            let truth = amplitude * rate * (rate * t + phase).cos();
            let motion = palm.motion(k);
            [(motion.v_WP.x - truth).powi(2), (motion.w_WP.y - truth).powi(2)]
        });
        let sum = squares.fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
        (sum.map(|of| (of / 280.0).sqrt()), MissedTwist::of(&log)[0].clone())
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

    /// Of a palm that turns from rest to rest as a quintic between samples, wherever between two it starts, what is missed is within three times what
    /// is told, next to either end within twice, and no more than half of that is told elsewhere.
    #[test]
    fn what_a_spline_misses_where_a_palm_starts_and_stops_is_told() {
        let h = 0.002;
        for part in [0.0, 0.2, 0.5, 0.9] {
            let (start, lasts) = ((100.0 + part) * h, 0.3);
            let share = |t: f64| ((t - start) / lasts).clamp(0.0, 1.0);
            let angle = |t: f64| 0.6 * share(t).powi(3) * (10.0 - 15.0 * share(t) + 6.0 * share(t).powi(2));
            let rate = |t: f64| 0.6 * 30.0 * share(t).powi(2) * (1.0 - share(t)).powi(2) / lasts;
            let times: Vec<f64> = (0..400).map(|k| f64::from(k) * h).collect();
            let pose =
                |t: &f64| SurfacePose::new(DVec3::ZERO, DQuat::from_rotation_y(angle(*t))).expect("finite");
            let log = told_by(&times, times.iter().map(pose).collect());
            let told = &MissedTwist::of(&log)[0];
            let off = |k: usize| (log.palms()[0].motion(k).w_WP.y - rate(times[k])).abs();
            let worst = (5..395).map(off).fold(0.0, f64::max);
            let most = (0..400).map(|k| told.at(k, 1.0)).fold(0.0, f64::max);
            // Where it starts at a sample there the spline follows.
            assert!(worst < 2.0 * most && (part == 0.0 || worst > 0.1 * most), "{part}: {worst} {most}");
            for k in 5..395 {
                assert!(
                    off(k) < 3.0 * told.at(k, 1.0).max(1e-9),
                    "{part} {k}: {} {}",
                    off(k),
                    told.at(k, 1.0)
                );
            }
            assert!(told.at(50, 1.0) < 0.5 * most && told.at(175, 1.0) < 0.5 * most, "{part}");
        }
    }

    /// A palm that moves steadily, or whose twists are stated, is off by rounding alone.
    #[test]
    fn nothing_is_missed_of_a_steady_palm() {
        let ([v, _], told) = shaking(1e-3, 0.0);
        assert!(told.velocity < 1e-8 && v < 1e-8, "{} {v}", told.velocity);
    }
}
