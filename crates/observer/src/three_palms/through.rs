//! Motion at every sample from states at some, and what it leaves of the contact conditions.

use super::momentum::{Kinematics, MomentumProblem, MotionState, StartState};
use super::sensitivity::{exponential, logarithm};
use super::track::Integrals;
use glam::DVec3;

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

    /// Root mean square of the contact conditions along a motion, and what contact noise of the given deviation leaves of
    /// it, m/s.
    pub(super) fn residuals_along(&self, motion: &[MotionState], noise: f64) -> (Vec<[f64; 3]>, f64) {
        let mut expected = 0.0;
        let residuals = motion
            .iter()
            .enumerate()
            .map(|(k, m)| {
                std::array::from_fn(|i| {
                    let [a, b] = self.by_contact(k, i, m.w_WO);
                    expected += noise * noise * (a * a + b * b);
                    self.residual(k, i, &Kinematics { v: m.v_WCm, p: m.p_WCm, L: DVec3::ZERO }, m.w_WO)
                })
            })
            .collect();
        (residuals, (expected / (3 * motion.len().max(1)) as f64).sqrt())
    }
}
