//! What is known beforehand of the first motion of a record, and how the windows of a stream hand on what is known.
//!
//! What all before a node tell of the motion there and of the body is what is left of their equations when the motions before it are eliminated. It is
//! counted in numbers in which conditions are straight: contacts tell the twist about a point of space, whatever centre of mass and inertia the
//! body has.

use super::body::{Body, CONSTANTS};
use super::equations::Equations;
use super::flow::Transition;
use super::problem::{Beforehand, Problem};
use super::solve::{Solved, Step};
use super::spurious::{follows, held};
use super::state::{MOTION, Motion, Tangent, tangent};
use crate::rigid::{cross_matrix, logarithm, logarithm_slope};
use glam::{DQuat, DVec3};
use nalgebra::{Matrix3, SMatrix};

/// Deviation of the orientation of a body that has no axes but those it is given, rad.
const FIRST_TURN: f64 = 1e-7;

/// By how the numbers of a motion rise with the body's constants.
type Follows = SMatrix<f64, MOTION, CONSTANTS>;
/// Of the body's constants.
type OfBody = SMatrix<f64, CONSTANTS, CONSTANTS>;

/// What is known of the first motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct First {
    /// Centre of mass from the world's origin, velocity of the body at that point of space, angular velocity, orientation.
    p: DVec3,
    v: DVec3,
    w: DVec3,
    q: DQuat,
    /// By how much the most probable ones are others, of a body beside which constants are counted.
    beside: Tangent,
    /// Information on them for given constants of the body, and how they rise with the constants.
    information: Transition,
    follows: Option<(Follows, Body)>,
    /// Information on the body that noise alone made the equations before claim.
    pub(super) spurious: OfBody,
}

impl First {
    /// Nothing but how the body's axes are chosen.
    pub(super) fn of_axes(q: DQuat) -> Self {
        Self::turned(q, FIRST_TURN)
    }

    /// Nothing but an orientation, to within a deviation (rad).
    pub(super) fn turned(q: DQuat, deviation: f64) -> Self {
        let known = |i: usize| if i < 9 { 0.0 } else { deviation.powi(-2) };
        Self {
            p: DVec3::ZERO,
            v: DVec3::ZERO,
            w: DVec3::ZERO,
            q,
            beside: Tangent::zeros(),
            information: Transition::from_diagonal(&Tangent::from_fn(|i, _| known(i))),
            follows: None,
            spurious: OfBody::zeros(),
        }
    }

    /// Whether it is what all before tell, beside what is known of the body.
    pub(super) fn is_handed_on(&self) -> bool {
        self.follows.is_some()
    }

    /// What all before node `m` of a solution tell of the motion there and of the body. None where that is not all of both.
    pub(super) fn at(problem: &Problem, solved: &Solved<CONSTANTS>, m: usize) -> Option<(Self, Beforehand)> {
        let claimed = solved.equations.covariances(&problem.natural_information())?;
        let at = &solved.unknowns;
        let mut before = problem.linearised::<CONSTANTS>(at, 0..m)?;
        problem.add_prior(at, &mut before);
        let (chain, mended) = before.solver(&problem.natural_information())?;
        let (own, with_body) = chain.last().filter(|_| mended == 0.0)?;
        // The most probable ones by what lies before alone.
        let Step { motions, body: constants } = chain.step(&before.gradient());
        let step = motions[m];
        let of_body = &chain.body;
        let mut spurious = problem.first.spurious + claimed.spurious(&before, at);
        for combination in &problem.frozen {
            // It is known as it was: what equations claim of it counts no more than what noise makes of that.
            let follows = follows(of_body, combination);
            let others = OfBody::identity() - follows * combination.transpose() / follows.dot(combination);
            spurious = others.transpose() * spurious * others;
        }
        let covariance = of_body + held(problem, of_body)?;

        let motion = &at.motions[m];
        let (w, origin) = (at.body.spin(motion.q, motion.L), problem.record.origin);
        let here = Self { p: motion.p + origin, v: motion.v, w, ..Self::of_axes(motion.q) };
        let (by_motion, slopes) = here.slopes(motion, &at.body, origin);
        let straight = by_motion.try_inverse()?;
        let follows = slopes + by_motion * with_body;
        let first = Self {
            beside: by_motion * step + slopes * constants - follows * constants,
            information: symmetric(straight.transpose() * own.cholesky()?.inverse() * straight),
            follows: Some((follows, at.body)),
            spurious,
            ..here
        };
        let body = at.body.beside(constants[0], &constants.fixed_rows::<6>(1).into_owned());
        // Counted from there.
        let back = at.body.slope_from(&body).try_inverse()?;
        let information = covariance.cholesky()?.inverse();
        Some((first, (body, symmetric(back.transpose() * information * back))))
    }

    /// How far a motion, whose positions are from `origin`, is from what is known of it.
    fn departure(&self, motion: &Motion, body: &Body, origin: DVec3) -> Tangent {
        let (place, w) = (motion.p + origin - self.p, body.spin(motion.q, motion.L));
        let apart = tangent(&[place, motion.v - w.cross(place) - self.v, w - self.w, self.turn(motion)]);
        let follows =
            self.follows.as_ref().map_or_else(Tangent::zeros, |(follows, of)| follows * body.from(of));
        apart - self.beside - follows
    }

    fn turn(&self, motion: &Motion) -> DVec3 {
        logarithm((motion.q * self.q.conjugate()).normalize())
    }

    /// How that changes with the motion and with the body's constants.
    fn slopes(&self, motion: &Motion, body: &Body, origin: DVec3) -> (Transition, Follows) {
        let (place, w) = (motion.p + origin - self.p, body.spin(motion.q, motion.L));
        let (spin, spin_by_body) = motion.spin_derivatives(body);
        let about = Matrix3::from(cross_matrix(place));
        let turn = Matrix3::from(logarithm_slope(self.turn(motion)));
        let mut by_motion = Transition::identity();
        by_motion.fixed_view_mut::<3, 3>(9, 9).copy_from(&turn);
        by_motion.fixed_rows_mut::<3>(6).copy_from(&spin);
        let mut velocity = by_motion.fixed_rows_mut::<3>(3);
        velocity += about * spin;
        let mut of_place = by_motion.fixed_view_mut::<3, 3>(3, 0);
        of_place -= Matrix3::from(cross_matrix(w));
        let follows = self.follows.as_ref();
        let mut by_body = follows.map_or_else(Follows::zeros, |(follows, of)| -follows * body.slope_from(of));
        let mut spins = by_body.fixed_view_mut::<3, 6>(6, 1);
        spins += spin_by_body;
        let mut velocities = by_body.fixed_view_mut::<3, 6>(3, 1);
        velocities += about * spin_by_body;
        (by_motion, by_body)
    }

    /// Chi-squared of a motion.
    pub(super) fn cost(&self, motion: &Motion, body: &Body, origin: DVec3) -> f64 {
        let apart = self.departure(motion, body, origin);
        (self.information * apart).dot(&apart)
    }

    /// Adds what is known to equations.
    pub(super) fn add<const P: usize>(
        &self,
        motion: &Motion,
        body: &Body,
        origin: DVec3,
        all: &mut Equations<P>,
    ) {
        let (by_motion, by_body) = self.slopes(motion, body, origin);
        let by_body = by_body.fixed_columns::<P>(0);
        let rows = self.information * by_motion;
        let pull = self.information * self.departure(motion, body, origin);
        let node = &mut all.nodes[0];
        node.own += by_motion.transpose() * rows;
        node.body += rows.transpose() * by_body;
        node.gradient += by_motion.transpose() * pull;
        all.body += by_body.transpose() * self.information * by_body;
        all.body_gradient += by_body.transpose() * pull;
    }
}

fn symmetric<const N: usize>(of: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    0.5 * (of + of.transpose())
}
