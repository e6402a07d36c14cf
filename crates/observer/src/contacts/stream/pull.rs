//! What pulls at the constants of a known body, window after window.
//!
//! One window may not tell a wrong inertia; all of them together do. A known constant is held by an information of its own: where it ends beside its
//! value, that times the departure is the slope of chi-squared that the data have there. Slopes of windows without a common sample add, and so does
//! their information: a score test of what was stated.

use crate::contacts::axes::CONTRADICTED;
use crate::contacts::body::CONSTANTS;
use crate::contacts::problem::Problem;
use crate::contacts::solve::{Covariances, Solved};
use nalgebra::{SMatrix, SVector};

/// Constants that are stated: logarithms of the mass and of the roots of the principal second moments.
const STATED: usize = 4;
/// Deviation beforehand of what a constant may be off by: a direction that no window tells anything of adds nothing.
const OFF: f64 = 0.7;

/// Slopes and information of the windows so far.
#[derive(Default)]
pub(super) struct Pull {
    slope: SVector<f64, STATED>,
    information: SMatrix<f64, STATED, STATED>,
    /// Number of the last sample that was counted.
    until: Option<usize>,
}

impl Pull {
    /// Counts a window from sample `from` to sample `to`, unless it shares samples with one that was counted.
    pub(super) fn add(
        &mut self,
        problem: &Problem,
        solved: &Solved<CONSTANTS>,
        covariances: &Covariances<CONSTANTS>,
        (from, to): (usize, usize),
    ) {
        if self.until.is_some_and(|until| from < until) {
            return;
        }
        let first =
            |of: &SMatrix<f64, CONSTANTS, CONSTANTS>| of.fixed_view::<STATED, STATED>(0, 0).into_owned();
        let held = first(&problem.body_information());
        let departure = solved.unknowns.body.from(&problem.body.0).fixed_rows::<STATED>(0).into_owned();
        let Some(all) = first(&covariances.body).cholesky() else { return };
        let noise = solved.misfit().max(1.0);
        self.slope += held * departure / noise;
        self.information += (all.inverse() - held) / noise;
        self.until = Some(to);
    }

    /// Whether the data of all windows speak against what was stated.
    pub(super) fn contradicts(&self) -> bool {
        let known = self.information + SMatrix::identity() * OFF.powi(-2);
        known.cholesky().is_some_and(|factor| self.slope.dot(&factor.solve(&self.slope)) > CONTRADICTED)
    }
}
