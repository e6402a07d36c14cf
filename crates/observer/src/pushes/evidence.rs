//! How probable an outline is by the touches, whatever its unknowns are: how well it meets them, how much of what was known beforehand it had to give up
//! for that (Laplace's approximation), and what a push may be that is no touch of it.

use super::fit::{Fitted, Matrix, Point, Problem, Vector};
use super::shape::MOST;
use nalgebra::Cholesky;

/// Density of a touch's distribution where it is largest: Student's of four degrees of freedom.
const AT_TOUCH: f64 = 0.375;
/// Share of pushes that are no touch of the outline.
const STRAY: f64 = 0.02;
/// Readings of each kind that a fit must leave free.
const FREE: f64 = 1.0;

impl Fitted {
    /// Negative logarithm of the evidence over that of another fit, but for the push that speaks most for the other, as far as one that is no touch is to
    /// be expected among so many.
    pub(super) fn against(&self, other: &Self) -> f64 {
        let most =
            self.of_pushes.iter().zip(&other.of_pushes).map(|(own, other)| own - other).fold(0.0, f64::max);
        0.5 * (self.misfit - other.misfit - most * (STRAY * self.of_pushes.len() as f64).min(1.0))
    }
}

impl Problem<'_> {
    /// What the readings tell beside how well they are met: shares of those of each kind that are left free, and twice the logarithm of by how much
    /// they narrow what was known of the shape beforehand. None where nothing is left free to tell how far they are off.
    pub(super) fn told(&self, point: &Point) -> Option<([f64; 2], f64)> {
        let (rows, _) = self.rows(point)?;
        let (readings, prior) = rows.split_at(4 * self.touches.len());
        let of = |rows: &[Vector]| rows.iter().fold(Matrix::zeros(), |sum, row| sum + row * row.transpose());
        let used = point.shape.unknowns();
        let told = of(readings);
        let mut all = told + of(prior);
        (used..MOST).for_each(|j| all[(j, j)] += 1.0);
        let inverse = Cholesky::new(all)?.inverse();
        let count = self.touches.len() as f64;
        let free = [0, 1].map(|i| {
            let taken: f64 = readings.iter().skip(i).step_by(4).map(|row| row.dot(&(inverse * row))).sum();
            1.0 - taken / count
        });
        let width = Vector::from_fn(|j, _| if j < used { point.shape.beforehand(j) } else { 0.0 });
        let wide = Matrix::identity() + Matrix::from_diagonal(&width) * told * Matrix::from_diagonal(&width);
        let narrowed = Cholesky::new(wide)?.l_dirty().diagonal().map(f64::ln).sum();
        free.iter().all(|free| free * count > FREE).then_some((free, 2.0 * narrowed))
    }

    /// The cost of each push at a point, and of all else, where a push may be no touch of this outline at all and its finger anywhere: going after one
    /// gains no more than the odds of that.
    pub(super) fn with_strays(&self, point: &Point) -> Option<(Vec<f64>, f64)> {
        let residuals = self.residuals(point)?;
        let (readings, prior) = residuals.split_at(4 * self.touches.len());
        let [mean, half] = self.deviations.map(|d| d / (AT_TOUCH * self.size));
        let stray = STRAY * mean * half / (1.0 - STRAY);
        let square = |of: &[f64]| of.iter().map(|r| r * r).sum::<f64>();
        let one = |of: &[f64]| {
            2.0 * (stray.ln_1p() - ((-0.5 * square(&of[..2])).exp() + stray).ln()) + square(&of[2..])
        };
        Some((readings.chunks_exact(4).map(one).collect(), square(prior)))
    }
}
