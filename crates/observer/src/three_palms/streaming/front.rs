//! From the latest node to the newest sample: the motion that the forces since then make.

use super::pieces::Reading;
use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::momentum::{MotionState, StartState};
use crate::three_palms::sensitivity::cross_matrix;
use crate::three_palms::sensitivity::exponential;
use crate::three_palms::state_space::MOTION_STATES;
use glam::{DMat3, DVec3};
use nalgebra::{Matrix3, SMatrix, SVector};

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
    /// Time since the node, s.
    since: f64,
    /// Force on the body over that time, N s.
    impulse: DVec3,
}

impl Front {
    pub(super) fn new(state: StartState, at: Reading) -> Self {
        Self { state, at, since: 0.0, impulse: DVec3::ZERO }
    }

    pub(super) fn advance(&mut self, body: &Falling, next: &Reading) {
        let h = next.t - self.at.t;
        let StartState { p_WCm, v_WCm, L_WO, R_WO } = self.state;
        let force =
            |r: &Reading| -> DVec3 { (0..3).map(|i| r.node.forces[i] * r.node.palms[i].frame.n).sum() };
        let torque = |r: &Reading, p: DVec3| -> DVec3 {
            (0..3).map(|i| (r.node.p_WC[i] - p).cross(r.node.forces[i] * r.node.palms[i].frame.n)).sum()
        };
        let mean = 0.5 * (force(&self.at) + force(next));
        let a = body.gravity + mean / body.mass;
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
        self.since += h;
        self.impulse += h * mean;
    }

    /// Covariance at the sample that was taken last, from that at the node: to first order in the time between, which is
    /// a tenth of the natural one, with the noise of the forces and contacts that were integrated.
    pub(super) fn covariance(
        &self,
        body: &Falling,
        node: &SMatrix<f64, MOTION_STATES, MOTION_STATES>,
        noise: &NoiseLevel,
        spacing: f64,
    ) -> SMatrix<f64, MOTION_STATES, MOTION_STATES> {
        let time = self.since;
        let StartState { p_WCm, L_WO, R_WO, .. } = self.state;
        let R = DMat3::from_quat(R_WO);
        let K = R * body.inverse_inertia * R.transpose();
        let mut flow = SMatrix::<f64, MOTION_STATES, MOTION_STATES>::identity();
        let blocks = [
            (0, 3, DMat3::IDENTITY * time),
            (6, 0, cross_matrix(self.impulse)),
            (9, 6, K * time),
            (9, 9, DMat3::IDENTITY + K * cross_matrix(L_WO) * time),
        ];
        for (row, column, block) in blocks {
            flow.fixed_view_mut::<3, 3>(row, column).copy_from(&Matrix3::from(block));
        }
        let mut all = flow * node * flow.transpose();
        // White noise over a time: its mean moves the path by half of it, and what is left is independent of the mean.
        let mut add = |variance: f64, velocity: DVec3, momentum: DVec3| {
            let turned = K * momentum;
            for (path, size) in [(0.5 * time, 1.0), (time / 12f64.sqrt(), 0.0)] {
                let blocks = [velocity * path, velocity * size, momentum * size, turned * path];
                let kick = SVector::<f64, MOTION_STATES>::from_fn(|i, _| blocks[i / 3][i % 3]);
                all.ger(variance, &kick, &kick, 1.0);
            }
        };
        for i in 0..3 {
            let (palm, force) = (&self.at.node.palms[i].frame, self.at.node.forces[i]);
            if force > 0.0 {
                let lever = (self.at.node.p_WC[i] - p_WCm).cross(palm.n);
                add(noise.force * noise.force * time * spacing, palm.n / body.mass, lever);
                let of_contact = (noise.contact * force).powi(2) * time * spacing;
                add(of_contact, DVec3::ZERO, palm.t1);
                add(of_contact, DVec3::ZERO, palm.t2);
            }
        }
        all
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
