//! Information on the inertia that noise alone makes the equations claim, and covariances without it.
//!
//! A link weighs an inertia by the change of the angular velocity along it. Where noise makes much of that change, its square
//! adds to the information what is not there: the same that in regression on noisy regressors makes a slope look sure. With `B` the
//! information as the equations have it, `N` what noise adds to it on average and `C = B - N` what is left, the estimate departs from the truth by `C^-1`
//! times a score of covariance `B`, so that its covariance is `C^-1 B C^-1`.

use super::body::{Body, CONSTANTS, INERTIA};
use super::equations::{Equations, LinkEquation};
use super::flow::Transition;
use super::problem::{FROZEN, Problem, Unknowns};
use super::solve::{Covariances, Solved};
use super::state::{MOTION, Motion};
use crate::rigid::cross_matrix;
use glam::{DMat3, DVec3};
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen};

/// What of the information is left at least, in any direction: a deviation is then twenty times what the equations claim.
const LEAST: f64 = 0.05;
/// Error of the derivative of a condition by a constant in natural units: where conditions are far better than that, it poses as information; and
/// the share of such information from which on it is worth nothing.
const INEXACT: f64 = 1e-6;
const CLAIMED: f64 = 0.5;
/// Share of the information that was there beforehand from which on a combination keeps its value by itself.
pub(super) const KEPT: f64 = 0.99;

type OfBody = SMatrix<f64, CONSTANTS, CONSTANTS>;

/// Shares of noise in the information that the equations claim on the body.
struct Shares {
    values: SVector<f64, CONSTANTS>,
    /// Factor of the claimed covariance, its columns turned to the directions of the shares.
    axes: OfBody,
}

impl Solved<CONSTANTS> {
    /// Without what noise alone makes the equations claim. None where the equations are singular.
    pub(super) fn covariances(&self, problem: &Problem) -> Option<Covariances<CONSTANTS>> {
        let claimed = self.equations.covariances(&problem.natural_information())?;
        let widened = claimed.widened(problem, &self.equations, &self.unknowns)?;
        widened.centre_widened(&self.equations, &self.unknowns)
    }
}

impl Covariances<CONSTANTS> {
    /// Combinations of the body's constants, in units of their claimed deviations, that are known better beforehand than an estimate makes
    /// them, whose variance is `B / C^2`. None where the covariance has no inverse.
    pub(super) fn frozen(
        &self,
        problem: &Problem,
        equations: &Equations<CONSTANTS>,
        at: &Unknowns,
    ) -> Option<Vec<SVector<f64, CONSTANTS>>> {
        let Shares { values, axes } = self.shares(problem, equations, at)?;
        let rows = axes.try_inverse()?;
        let beforehand = axes.transpose() * problem.body.1 * axes;
        // What windows before tell hangs together: known along a combination, it may be little of that which keeps its value.
        let alone = if problem.first.is_handed_on() { Some(beforehand.try_inverse()?) } else { None };
        let better = |&i: &usize| {
            let known = alone.as_ref().map_or(beforehand[(i, i)], |variances| 1.0 / variances[(i, i)]);
            known < KEPT && known > (1.0 - values[i]).max(0.0).powi(2)
        };
        Some((0..CONSTANTS).filter(better).map(|i| rows.row(i).transpose()).collect())
    }

    /// With the covariance of the body widened where noise poses as information, and by what was known beforehand of what is
    /// frozen. None where it has no inverse.
    pub(super) fn widened(
        self,
        problem: &Problem,
        equations: &Equations<CONSTANTS>,
        at: &Unknowns,
    ) -> Option<Self> {
        let Shares { values, axes } = self.shares(problem, equations, at)?;
        let wider = values.map(|share| (1.0 - share).clamp(LEAST, 1.0).powi(-2));
        let mut body = axes * OfBody::from_diagonal(&wider) * axes.transpose();
        body += held(problem, &self.body)?;
        Self { body, ..self }.without_inexact(problem, equations, at)
    }

    /// With the covariance of the centre of mass widened in the same way.
    ///
    /// Where it is in the body follows from how velocity changes with the spin: contacts tell the twist of the body, and forces how the
    /// velocity of the centre changes, so that a link weighs a shift that turns with the body by the change of its product with the angular velocity.
    pub(super) fn centre_widened(mut self, equations: &Equations<CONSTANTS>, at: &Unknowns) -> Option<Self> {
        let first = self.motions[0].0.fixed_view::<3, 3>(0, 0).into_owned();
        let factor = first.cholesky()?.l();
        let eigen = SymmetricEigen::new(factor.transpose() * self.spurious_of_centre(equations, at) * factor);
        let axes = factor * eigen.eigenvectors;
        let more = eigen.eigenvalues.map(|share| (1.0 - share).clamp(LEAST, 1.0).powi(-2) - 1.0);
        let more = axes * Matrix3::from_diagonal(&more) * axes.transpose();
        let turned = at.motions[0].q.conjugate();
        for ((own, _), motion) in self.motions.iter_mut().zip(&at.motions) {
            // A shift in the world at the first node turns with the body.
            let turn = Matrix3::from(DMat3::from_quat((motion.q * turned).normalize()));
            let spin = Matrix3::from(cross_matrix(at.body.turn(motion.q, motion.L).w));
            let mut by = SMatrix::<f64, MOTION, 3>::zeros();
            by.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
            by.fixed_view_mut::<3, 3>(3, 0).copy_from(&(spin * turn));
            *own += by * more * by.transpose();
        }
        Some(self)
    }

    fn spurious_of_centre(&self, equations: &Equations<CONSTANTS>, at: &Unknowns) -> Matrix3<f64> {
        let turned = at.motions[0].q.conjugate();
        let mut all = Matrix3::zeros();
        for (j, link) in equations.links.iter().enumerate() {
            let ends = [&at.motions[j], &at.motions[j + 1]];
            let slopes: [_; 3] = std::array::from_fn(|i| {
                ends.map(|motion| Matrix3::from(cross_matrix(motion.q * turned * DVec3::AXES[i])))
            });
            self.add_claimed((j, link, 3), at, &slopes, |i, k, share| all[(i, k)] += share);
        }
        0.5 * (all + all.transpose())
    }

    /// What noise of the angular velocities adds to the information on constants of which a link's momenta (`from` which number on) fall by `slopes`
    /// times these at its ends: of each pair of constants.
    fn add_claimed<const N: usize>(
        &self,
        (j, link, from): (usize, &LinkEquation<CONSTANTS>, usize),
        at: &Unknowns,
        slopes: &[[Matrix3<f64>; 2]; N],
        mut add: impl FnMut(usize, usize, f64),
    ) {
        let left = self.left(j, link, from);
        let ends = [&at.motions[j], &at.motions[j + 1]];
        let noise = Spins::new(ends, &at.body, &self.motions[j].0, &self.motions[j + 1].0, &self.next[j]);
        for (i, slope) in slopes.iter().enumerate() {
            // The trace of what is left times the covariance of two changes is the sum of products of entries.
            let weighted = noise.of_change(slope).map(|of| left * of);
            for (k, other) in slopes.iter().enumerate() {
                add(i, k, weighted[0].dot(&other[0]) + weighted[1].dot(&other[1]));
            }
        }
    }

    /// What the residual of a link says of constants by three of its numbers from one on, the motions free to follow.
    fn left(&self, j: usize, link: &LinkEquation<CONSTANTS>, from: usize) -> Matrix3<f64> {
        let (before, after, cross) = (&self.motions[j].0, &self.motions[j + 1].0, &self.next[j]);
        let (by_motion, _) = link.adjusted.derivatives();
        let rows = link.information.fixed_rows::<3>(from).into_owned();
        let carried = rows * by_motion;
        let mixed = carried * cross * rows.transpose();
        let residual = rows * after * rows.transpose() + carried * before * carried.transpose();
        rows.fixed_columns::<3>(from) - (residual - mixed - mixed.transpose())
    }

    /// With what was known beforehand alone along directions of the body's constants of which errors of derivatives may claim as much as the
    /// equations do.
    fn without_inexact(
        mut self,
        problem: &Problem,
        equations: &Equations<CONSTANTS>,
        at: &Unknowns,
    ) -> Option<Self> {
        if !problem.exact {
            return Some(self);
        }
        let of_condition = INEXACT * problem.units.speed / problem.condition_deviation();
        let all = of_condition * of_condition * equations.conditions as f64;
        let units = at.body.inertia_units();
        let inexact =
            SVector::<f64, CONSTANTS>::from_fn(|i, _| if i > 0 { all / units[i - 1].powi(2) } else { 0.0 });
        let factor = self.body.cholesky()?.l();
        let eigen = SymmetricEigen::new(factor.transpose() * OfBody::from_diagonal(&inexact) * factor);
        let axes = factor * eigen.eigenvectors;
        for i in (0..CONSTANTS).filter(|&i| eigen.eigenvalues[i] > CLAIMED) {
            let axis = axes.column(i).into_owned();
            let beforehand = (problem.body.1 * axis).dot(&axis);
            self.body += axis * axis.transpose() / beforehand.max(f64::MIN_POSITIVE);
        }
        Some(self)
    }

    fn shares(&self, problem: &Problem, equations: &Equations<CONSTANTS>, at: &Unknowns) -> Option<Shares> {
        // In units of the deviations as claimed: the information is one, and what noise adds to it a share.
        let factor = self.body.cholesky()?.l();
        let spurious = problem.first.spurious + self.spurious(equations, at);
        let eigen = SymmetricEigen::new(factor.transpose() * spurious * factor);
        Some(Shares { values: eigen.eigenvalues, axes: factor * eigen.eigenvectors })
    }

    /// What noise adds to the information on the body.
    pub(super) fn spurious(&self, equations: &Equations<CONSTANTS>, at: &Unknowns) -> OfBody {
        let mut all = OfBody::zeros();
        for (j, link) in equations.links.iter().enumerate() {
            let ends = [&at.motions[j], &at.motions[j + 1]];
            let slope =
                |motion: &Motion, i| Matrix3::from(at.body.slope_along(DMat3::from_quat(motion.q), i));
            let slopes: [_; INERTIA] = std::array::from_fn(|i| ends.map(|motion| slope(motion, i)));
            self.add_claimed((j, link, 6), at, &slopes, |i, k, share| all[(i + 1, k + 1)] += share);
        }
        0.5 * (all + all.transpose())
    }
}

/// What a change of a frozen combination's value from beforehand would do to all constants, of which `claimed` is the covariance with it frozen.
pub(super) fn follows(claimed: &OfBody, combination: &SVector<f64, CONSTANTS>) -> SVector<f64, CONSTANTS> {
    claimed * combination * FROZEN
}

/// By how much that covariance is larger for what was known beforehand of what is frozen. None where nothing was known of a constant.
pub(super) fn held(problem: &Problem, claimed: &OfBody) -> Option<OfBody> {
    let beforehand = problem.body.1.try_inverse()?;
    let one = |combination: &SVector<f64, CONSTANTS>| {
        let follows = follows(claimed, combination);
        follows * follows.transpose() * combination.dot(&(beforehand * combination))
    };
    Some(problem.frozen.iter().map(one).sum())
}

/// Covariances of the angular velocities at the ends of a link.
struct Spins {
    own: [Matrix3<f64>; 2],
    between: Matrix3<f64>,
}

impl Spins {
    fn new(
        ends: [&Motion; 2],
        body: &Body,
        before: &Transition,
        after: &Transition,
        cross: &Transition,
    ) -> Self {
        let [a, b] = ends.map(|motion| motion.spin_derivatives(body).0);
        let own = [a * before * a.transpose(), b * after * b.transpose()];
        Self { own, between: a * cross * b.transpose() }
    }

    /// Of the change along the link of a matrix times the angular velocity, the matrix as it is at both ends, with the angular velocities at them.
    fn of_change(&self, [a0, a1]: &[Matrix3<f64>; 2]) -> [Matrix3<f64>; 2] {
        [a0 * self.own[0] - a1 * self.between.transpose(), a1 * self.own[1] - a0 * self.between]
    }
}
