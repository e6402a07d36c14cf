//! Motion at every sample from states at some, and what it leaves of the contact conditions.

use super::covariance::NoiseLevel;
use super::delassus::Push;
use super::momentum::{Kinematics, MomentumProblem, MotionState, StartState};
use super::sensitivity::{exponential, logarithm};
use super::track::Integrals;
use glam::{DMat3, DVec3};

impl MomentumProblem<'_> {
    /// Motion at every sample, through given states at some of them (`nodes`, ascending, the first and the last sample
    /// among them): between two of them as the data say, with what is then missing at the second spread evenly.
    pub(super) fn motion_through(&self, nodes: &[usize], states: &[StartState]) -> Vec<MotionState> {
        let times: Vec<f64> = self.track.times().collect();
        let mut all = Vec::with_capacity(self.end);
        for (pair, ends) in nodes.windows(2).zip(states.windows(2)) {
            let (from, to) = (pair[0], pair[1]);
            let start = self.start_through(from, &ends[0]);
            let mut part = Vec::with_capacity(to - from + 1);
            self.walk_part(&start, ends[0].R_WO, from..to + 1, |k, q, _| {
                let at = self.kinematics(&start, k);
                part.push(StartState { p_WCm: at.p, v_WCm: at.v, L_WO: at.L, R_WO: q });
            });
            let Some(reached) = part.last().copied() else { continue };
            let missing = (
                ends[1].p_WCm - reached.p_WCm,
                ends[1].v_WCm - reached.v_WCm,
                ends[1].L_WO - reached.L_WO,
                logarithm(ends[1].R_WO * reached.R_WO.inverse()),
            );
            // Each node belongs to the interval after it, the last to the one before.
            let count = if to + 1 == self.end { part.len() } else { part.len() - 1 };
            for (j, state) in part.iter().take(count).enumerate() {
                let k = from + j;
                let share = (self.track.t[k] - self.track.t[from]) / (self.track.t[to] - self.track.t[from]);
                let q = exponential(missing.3 * share) * state.R_WO;
                let L = state.L_WO + missing.2 * share;
                all.push(MotionState {
                    t: times[k],
                    p_WCm: state.p_WCm + missing.0 * share,
                    R_WO: q,
                    v_WCm: state.v_WCm + missing.1 * share,
                    w_WO: q * (self.mass.inverse_inertia() * (q.conjugate() * L)),
                });
            }
        }
        all
    }

    /// The start, orientation apart, from which the data lead through a state at sample `k`.
    fn start_through(&self, k: usize, state: &StartState) -> StartState {
        let t = self.track.t[k];
        let Integrals { impulse, first_moment, moment, velocity, position, .. } = self.track.integrals[k];
        let v_WCm = state.v_WCm - velocity;
        let p_WCm = state.p_WCm - v_WCm * t - position;
        let L_WO = state.L_WO - moment + p_WCm.cross(impulse) + v_WCm.cross(first_moment);
        StartState { p_WCm, v_WCm, L_WO, R_WO: state.R_WO }
    }

    /// The contact conditions along a motion, m/s.
    pub(super) fn residuals_along(&self, motion: &[MotionState]) -> Vec<[f64; 3]> {
        let residual = |k: usize, m: &MotionState| {
            let at = Kinematics { v: m.v_WCm, p: m.p_WCm, L: DVec3::ZERO };
            std::array::from_fn(|i| self.residual(k, i, &at, m.w_WO))
        };
        motion.iter().enumerate().map(|(k, m)| residual(k, m)).collect()
    }

    /// Root mean square of what noise leaves of the contact conditions along a motion through some nodes, m/s: that of the
    /// contacts at each sample, and that of the forces since the node before and until the next.
    pub(super) fn expected_through(
        &self,
        nodes: &[usize],
        motion: &[MotionState],
        noise: &NoiseLevel,
    ) -> f64 {
        let spacing = self.track.duration() / (self.track.len() - 1).max(1) as f64;
        let mut sum = 0.0;
        for (k, m) in motion.iter().enumerate() {
            let next = nodes.partition_point(|&node| node <= k);
            let between = match (nodes.get(next.wrapping_sub(1)), nodes.get(next)) {
                // White noise that is known to come to nothing at both ends: a Brownian bridge.
                (Some(&from), Some(&to)) => ((k - from) * (to - k)) as f64 / (to - from) as f64,
                _ => 0.0,
            };
            let of_impulse = (noise.force * spacing).powi(2) * between;
            let R = DMat3::from_quat(m.R_WO);
            let inverse = R * self.mass.inverse_inertia() * R.transpose();
            let node = &self.track.nodes[k];
            let push = |i: usize| Push::new(&node.palms[i].frame, node.p_WC[i], m.p_WCm);
            let pushes = [push(0), push(1), push(2)];
            for (i, palm) in pushes.iter().enumerate() {
                let [a, b] = self.by_contact(k, i, m.w_WO);
                sum += noise.contact * noise.contact * (a * a + b * b);
                let by = |other: &Push| palm.speed_by(other, self.mass.mass(), inverse).powi(2);
                sum += of_impulse * pushes.iter().map(by).sum::<f64>();
            }
        }
        (sum / (3 * motion.len().max(1)) as f64).sqrt()
    }
}
