//! From the end of a window to the newest sample: the motion that the forces since then make.

use super::estimate::StreamMotion;
use super::sample::Felt;
use super::solution::Solution;
use crate::contacts::body::CONSTANTS;
use crate::contacts::flow::{Carried, Transition};
use crate::contacts::link::link_covariance;
use crate::contacts::noise::{WrenchNoise, force_trace};
use crate::contacts::record::{Interval, six};
use crate::contacts::state::{MOTION, Motion, tangent};
use crate::contacts::verdict::UNEXPLAINED;
use glam::{DMat3, DVec3};
use nalgebra::{Matrix3, Matrix6, SMatrix};
use object_dynamics::BodyState;

/// Share of what the bend of a force between samples adds to its impulse that is not known: of a force that changes as a body moves, sampled
/// ten times in a radian or more, the next term is smaller than that.
const BENT: f64 = 0.3;

/// Times the interval before from which on an interval is a gap.
const LONG: f64 = 2.5;
/// The same in times over which it was looked what the trapezoidal rule misses, from which on the motion is not stated any more.
pub(super) const FORGOTTEN: f64 = 2.5;
/// Share of the variance of an impulse that a bend must make to be seen: noise makes half of it once in some hundred samples.
const SEEN: f64 = 0.5;

/// A motion that follows the samples one by one, by parabolas through three of them.
pub(super) struct Front {
    solution: Solution,
    gravity: DVec3,
    carried: Carried<CONSTANTS>,
    at: Felt,
    /// The sample before that.
    before: Option<Felt>,
    noise: Matrix6<f64>,
    /// Whether samples were missing for so long that only later contacts can tell how the motion went on.
    pub(super) gapped: bool,
}

impl Front {
    /// At the sample that the solution ends with.
    pub(super) fn new(solution: Solution, at: Felt, gravity: DVec3) -> Self {
        let carried = Carried::new(solution.motion, &solution.body);
        Self { solution, gravity, carried, at, before: None, noise: Matrix6::zeros(), gapped: false }
    }

    pub(super) fn solution(&self) -> &Solution {
        &self.solution
    }

    pub(super) fn advance(&mut self, next: &Felt) {
        let h = next.t - self.at.t;
        let wrenches = [&self.at.wrench, &next.wrench];
        let mut white = self.at.noise * (h * h);
        let mut interval = Interval::trapezoid(h, wrenches, WrenchNoise::default());
        let before = self.before.replace(self.at);
        let usual = |before: &Felt| h < LONG * (self.at.t - before.t);
        if before.is_some() && !before.as_ref().is_some_and(usual) {
            let (over, missed) = self.solution.missed;
            // The rule's error grows with the third power of the time, that of its noise with the first.
            let share = (h / over).max((h / over).powi(3));
            white += missed * (share * share);
            self.gapped |= h > FORGOTTEN * over;
        } else if let Some(before) = before {
            let slope = |from: &Felt, to: &Felt| (to.wrench + from.wrench * -1.0) * (1.0 / (to.t - from.t));
            let bend =
                (slope(&self.at, next) + slope(&before, &self.at) * -1.0) * (1.0 / (next.t - before.t));
            let less = bend * (-h * h * h / 6.0);
            // The bend of noise makes this much of its own.
            if less.force.length_squared() > SEEN * force_trace(&white) {
                interval.impulse = interval.impulse + less;
                interval.first += bend.force * (-h * h * h * h / 12.0);
                let unknown = six(less.force, less.moment) * BENT;
                white.ger(1.0, &unknown, &unknown, 1.0);
            }
        }
        self.carried.advance(&interval, wrenches, &self.solution.body, self.gravity);
        self.noise += white;
        self.at = *next;
    }

    /// Gives the moment of an impulse back, N m s, that was taken a few samples ago.
    pub(super) fn give_back(&mut self, moment: DVec3) {
        self.carried.shift(&tangent(&[DVec3::ZERO, DVec3::ZERO, moment, DVec3::ZERO]), &self.solution.body);
    }

    /// Whether this motion has foretold another one of the same sample to within the deviations of both: a window that no longer holds the data of
    /// the one before it may know less.
    pub(super) fn foretold(&self, other: &Self) -> bool {
        let (own, other) = (self.motion(), other.motion());
        let parts = |m: &StreamMotion| [m.state.p_WCm, m.state.v_WCm, m.state.w_WO];
        let (own_parts, other_parts) = (parts(&own), parts(&other));
        (0..9).all(|i| {
            let apart = own_parts[i / 3][i % 3] - other_parts[i / 3][i % 3];
            let variance = own.covariance[(i, i)] + other.covariance[(i, i)];
            apart * apart <= UNEXPLAINED * UNEXPLAINED * variance
        })
    }

    /// At the sample that was taken last.
    pub(super) fn motion(&self) -> StreamMotion {
        let Solution { body, own, misfit, t, .. } = &self.solution;
        let Motion { p, v, q, .. } = self.carried.motion;
        let state = BodyState { p_WCm: p, v_WCm: v, w_WO: self.carried.turn.w, R_WO: (q * *own).normalize() };
        StreamMotion {
            state,
            covariance: self.covariance(body),
            body: self.solution.stated,
            misfit: *misfit,
            corrected: *t,
        }
    }

    fn covariance(&self, body: &crate::contacts::body::Body) -> SMatrix<f64, MOTION, MOTION> {
        let Solution { covariance, follows, of_body, known, .. } = &self.solution;
        let (F, E) = self.carried.derivatives();
        let mut own = F * covariance * F.transpose();
        if self.carried.after > 0.0 {
            own += self.wandered(body);
        }
        let mut by_body = F * follows + E;
        // From angular momenta to angular velocities.
        let (spin, spin_by_body) = self.carried.motion.spin_derivatives(body);
        let mut to = Transition::identity();
        to.fixed_view_mut::<3, MOTION>(6, 0).copy_from(&spin);
        by_body = to * by_body;
        let mut direct = by_body.fixed_view_mut::<3, 6>(6, 1);
        direct += spin_by_body;
        if *known {
            // Own axes are those of the motion, turned by how they lie in it.
            let mut axes = by_body.fixed_view_mut::<3, 3>(9, 4);
            axes += Matrix3::from(DMat3::from_quat(self.carried.motion.q));
        }
        to * own * to.transpose() + by_body * of_body * by_body.transpose()
    }

    /// What noise of the forces did since the window's end.
    fn wandered(&self, body: &crate::contacts::body::Body) -> Transition {
        let noise = WrenchNoise { white: self.noise, ..WrenchNoise::default() }.about(self.carried.motion.p);
        link_covariance(&noise, self.carried.after, body, &self.carried.turn)
    }
}
