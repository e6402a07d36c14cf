//! From the latest node to the newest sample: the motion that the forces since then make.

use super::pieces::Reading;
use crate::three_palms::momentum::{MotionState, StartState};
use crate::three_palms::sensitivity::exponential;
use glam::{DMat3, DVec3};

/// Body and gravity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Falling {
    pub(super) mass: f64,
    pub(super) inverse_inertia: DMat3,
    pub(super) gravity: DVec3,
}

/// A motion that follows the samples, one by one: means over each interval, with an error of second order in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Front {
    pub(super) state: StartState,
    at: Reading,
}

impl Front {
    pub(super) fn new(state: StartState, at: Reading) -> Self {
        Self { state, at }
    }

    pub(super) fn advance(&mut self, body: &Falling, next: &Reading) {
        let h = next.t - self.at.t;
        let StartState { p_WCm, v_WCm, L_WO, R_WO } = self.state;
        let force =
            |r: &Reading| -> DVec3 { (0..3).map(|i| r.node.forces[i] * r.node.palms[i].frame.n).sum() };
        let torque = |r: &Reading, p: DVec3| -> DVec3 {
            (0..3).map(|i| (r.node.p_WC[i] - p).cross(r.node.forces[i] * r.node.palms[i].frame.n)).sum()
        };
        let a = body.gravity + 0.5 * (force(&self.at) + force(next)) / body.mass;
        let p_next = p_WCm + h * v_WCm + 0.5 * h * h * a;
        let turning = 0.5 * (torque(&self.at, p_WCm) + torque(next, p_next));
        // Midpoint rule with the angular momentum at the middle.
        let middle_L = L_WO + 0.5 * h * turning;
        let half = exponential(0.5 * h * self.rate(body, L_WO)) * R_WO;
        let w = half * (body.inverse_inertia * (half.inverse() * middle_L));
        self.state = StartState {
            p_WCm: p_next,
            v_WCm: v_WCm + h * a,
            L_WO: L_WO + h * turning,
            R_WO: (exponential(h * w) * R_WO).normalize(),
        };
        self.at = *next;
    }

    fn rate(&self, body: &Falling, L: DVec3) -> DVec3 {
        let R = self.state.R_WO;
        R * (body.inverse_inertia * (R.inverse() * L))
    }

    /// The motion at the sample that was taken last.
    pub(super) fn motion(&self, body: &Falling) -> MotionState {
        let StartState { p_WCm, v_WCm, L_WO, R_WO } = self.state;
        MotionState { t: self.at.t, p_WCm, R_WO, v_WCm, w_WO: self.rate(body, L_WO) }
    }
}
