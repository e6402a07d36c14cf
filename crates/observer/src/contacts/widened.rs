//! Covariances that count errors beside noise, of which it is known where each carries the solution.

use super::flow::Transition;
use super::solve::{Covariances, Step};
use super::state::MOTION;
use nalgebra::{DVector, SMatrix, SVector};

/// Share of each variance of the constants that is added to it, so that what is known for sure has a factor.
const RIDGE: f64 = 1e-12;

/// Of one motion for given constants, how it follows these, and their covariance.
pub(super) type Folded<const P: usize> = (Transition, SMatrix<f64, MOTION, P>, SMatrix<f64, P, P>);

impl<const P: usize> Covariances<P> {
    /// Beside independent errors, each of which carries the solution by a step.
    pub(super) fn with_errors(mut self, errors: impl IntoIterator<Item = Step<P>>) -> Self {
        self.errors.extend(errors);
        self
    }

    /// Of the constants, with all errors.
    pub(super) fn of_body(&self) -> SMatrix<f64, P, P> {
        self.errors.iter().fold(self.body, |sum, step| sum + step.body * step.body.transpose())
    }

    /// Of the motion at node `j`, with all errors.
    pub(super) fn of_motion(&self, j: usize) -> Transition {
        let (own, follows) = &self.motions[j];
        let all = own + follows * self.body * follows.transpose();
        self.errors.iter().fold(all, |sum, step| sum + step.motions[j] * step.motions[j].transpose())
    }

    /// Of the motion at node `j` and the constants, with all errors.
    pub(super) fn folded(&self, j: usize) -> Folded<P> {
        let (own, follows) = &self.motions[j];
        if self.errors.is_empty() {
            return (*own, *follows, self.body);
        }
        let cross = |sum, step: &Step<P>| sum + step.motions[j] * step.body.transpose();
        let cross = self.errors.iter().fold(follows * self.body, cross);
        let body = self.of_body();
        let follows = divided(&cross, &body).unwrap_or_else(SMatrix::zeros);
        (self.of_motion(j) - follows * body * follows.transpose(), follows, body)
    }
}

/// `cross` times the inverse of a covariance, of which no number may be known at all. None where it has no inverse.
fn divided<const P: usize>(
    cross: &SMatrix<f64, MOTION, P>,
    of: &SMatrix<f64, P, P>,
) -> Option<SMatrix<f64, MOTION, P>> {
    let scale =
        SVector::<f64, P>::from_fn(|i, _| if of[(i, i)] > 0.0 { of[(i, i)].sqrt().recip() } else { 1.0 });
    let scaled = |i: usize, j: usize| of[(i, j)] * scale[i] * scale[j] + if i == j { RIDGE } else { 0.0 };
    let factor = nalgebra::DMatrix::from_fn(P, P, scaled).cholesky()?;
    let mut all = SMatrix::zeros();
    for row in 0..MOTION {
        let right = DVector::from_fn(P, |i, _| cross[(row, i)] * scale[i]);
        let solved = factor.solve(&right);
        (0..P).for_each(|i| all[(row, i)] = solved[i] * scale[i]);
    }
    Some(all)
}

#[cfg(test)]
mod tests {
    use super::super::chain::Chain;
    use super::super::state::Tangent;
    use super::*;
    use crate::random::Normal;
    use nalgebra::Matrix3;

    /// With errors that move a motion and the constants together, what is folded into the motion, its slopes and the constants has their joint
    /// covariance: that of noise and the squares of the errors.
    #[test]
    fn folded_errors_have_their_joint_covariance() {
        let mut normal = Normal::seeded(7);
        let own = Transition::from_fn(|_, _| normal.draw());
        let root = Matrix3::from_fn(|_, _| normal.draw());
        let follows = SMatrix::<f64, MOTION, 3>::from_fn(|_, _| normal.draw());
        let mut step = || Step::<3> {
            motions: vec![Tangent::from_fn(|_, _| normal.draw())],
            body: SVector::from_fn(|_, _| normal.draw()),
        };
        let errors = [step(), step()];
        let (own, mut body) = (own * own.transpose(), root * root.transpose());
        for known in [false, true] {
            if known {
                body *= 1e-20;
            }
            let mut cross = follows * body;
            let mut motion = own + cross * follows.transpose();
            let mut constants = body;
            for error in &errors {
                motion += error.motions[0] * error.motions[0].transpose();
                cross += error.motions[0] * error.body.transpose();
                constants += error.body * error.body.transpose();
            }
            let of = Covariances {
                motions: vec![(own, follows)],
                next: Vec::new(),
                body,
                chain: Chain::default(),
                mended: 0.0,
                beyond: Vec::new(),
                errors: Vec::new(),
            };
            assert_eq!(of.folded(0), (own, follows, body));
            let of = of.with_errors(errors.iter().map(|error| error.scaled(1.0)));
            let (own, follows, body) = of.folded(0);
            assert!((body - constants).norm() < 1e-12);
            let all = own + follows * body * follows.transpose();
            assert!((all - motion).norm() < 1e-9 * motion.norm(), "{known}");
            // Two errors of three constants that are known for sure otherwise leave no inverse but a ridge's.
            let least = if known { 1e-5 } else { 1e-9 };
            assert!((follows * body - cross).norm() < least * cross.norm(), "{known}");
        }
    }
}
