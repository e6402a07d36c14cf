//! How far an estimate of the body is from what a linear model makes of it.
//!
//! The most probable motion and body together are not the most probable body: what counts for that is how many motions go with it as
//! well. If that changes much over one deviation of a constant, the estimate may be off by more than its deviation says. To second order
//! the most probable body is shifted by the slope of the logarithm of that volume (Tierney and Kadane 1986); the slope that is
//! taken here feels noise itself, so that the shift says how large an error may be, and not which.

use super::body::CONSTANTS;
use super::problem::{Problem, Unknowns};
use super::solve::{Covariances, Solved, Step};
use nalgebra::{SMatrix, SVector};

/// Length of a difference, in claimed deviations.
const STEP: f64 = 0.3;
/// Deviations of logarithms of constants, and of turns in rad, up to which nothing is looked at: the shift adds a hundredth to a variance there,
/// and takes twice the time of the solution.
pub(super) const SMALL: f64 = 0.02;
/// Deviation of the error, as a share of the shift.
const SHARE: f64 = 0.3;

impl Solved<CONSTANTS> {
    /// Without what noise alone makes the equations claim, and with what is beyond first order. None where the equations are singular.
    pub(super) fn covariances(&self, problem: &Problem) -> Option<Covariances<CONSTANTS>> {
        let claimed = self.equations.covariances(&problem.natural_information())?;
        let of_body = claimed.body;
        let widened = claimed.widened(problem, &self.equations, &self.unknowns)?;
        let widened = widened.centre_widened(&self.equations, &self.unknowns)?;
        widened.beyond_first_order(problem, self, &of_body)
    }
}

impl Covariances<CONSTANTS> {
    /// With the covariance of the body widened by what is beyond first order; `claimed` is that of the equations alone. Where the problem
    /// cannot be evaluated a step away, the body is known no better than beforehand. None where nothing was known then.
    fn beyond_first_order(
        mut self,
        problem: &Problem,
        solved: &Solved<CONSTANTS>,
        claimed: &SMatrix<f64, CONSTANTS, CONSTANTS>,
    ) -> Option<Self> {
        if claimed.diagonal().max() < SMALL * SMALL {
            return Some(self);
        }
        let Some(shift) = self.shift(problem, solved, claimed) else {
            self.body += problem.body.1.cholesky()?.inverse();
            return Some(self);
        };
        let error = shift * SHARE;
        // However far it may be shifted, it is off by no more than what was known beforehand leaves.
        let beforehand = (problem.body.1 * error).dot(&error);
        self.body += error * error.transpose() / beforehand.max(1.0);
        Some(self)
    }

    /// From the most probable motion and body to the most probable body. None where the problem cannot be evaluated a step away.
    fn shift(
        &self,
        problem: &Problem,
        solved: &Solved<CONSTANTS>,
        claimed: &SMatrix<f64, CONSTANTS, CONSTANTS>,
    ) -> Option<SVector<f64, CONSTANTS>> {
        let factor = claimed.cholesky()?.l();
        let volume = |by: SVector<f64, CONSTANTS>| {
            let motions = self.motions.iter().map(|(_, follows)| follows * by).collect();
            let step = Step { motions, body: by };
            log_volume(problem, &problem.trial(&solved.unknowns, &step, &solved.equations)?.unknowns)
        };
        let mut shift = SVector::<f64, CONSTANTS>::zeros();
        for column in factor.column_iter() {
            let step = column * STEP;
            shift += column * ((volume(step)? - volume(-step)?) / (2.0 * STEP));
        }
        Some(shift)
    }
}

/// Logarithm of the volume of the motions that go with a body about as well as the best one, less that of all readings.
fn log_volume(problem: &Problem, at: &Unknowns) -> Option<f64> {
    let equations = problem.linearise::<CONSTANTS>(at)?;
    let links =
        equations.links.iter().map(|link| link.information.cholesky().map(|of| of.determinant().ln()));
    let readings = links.sum::<Option<f64>>()? + problem.conditions_log_information(at);
    Some(0.5 * (readings - equations.motions_log_information()?)).filter(|volume| volume.is_finite())
}
