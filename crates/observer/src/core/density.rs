//! How probable the newest sample was, from an estimate that already rests on it.

use super::model::{Model, Sample};
use nalgebra::{SMatrix, SVector};

/// Logarithm of the density of `sample` given all else that `state` and its covariance rest on.
///
/// An innovation `v` with covariance `S` leaves the residual `r = R S^-1 v` and the covariance `A = R - R S^-1 R` of the
/// corrected outputs. Solved for them, `v' S^-1 v = r' (R - A)^-1 r` and `S = R (R - A)^-1 R`. None where `R - A` is not
/// positive definite: the outputs were fitted by this sample alone, and nothing predicted it.
pub(super) fn log_density<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    sample: &Sample<Mo::Input, M>,
    state: &SVector<f64, N>,
    covariance: &SMatrix<f64, N, N>,
) -> Option<f64> {
    let (y, h) = model.output(state, &sample.input);
    // In deviations of the noise; a channel that was not measured has neither residual nor derivative.
    let root = sample.information.map(|i| if i > 0.0 { i.sqrt() } else { 0.0 });
    let residual =
        SVector::<f64, M>::from_fn(
            |c, _| {
                if root[c] > 0.0 { (sample.measured[c] - y[c]) * root[c] } else { 0.0 }
            },
        );
    let rows = SMatrix::<f64, M, N>::from_fn(|c, j| h[(c, j)] * root[c]);
    let left = SMatrix::<f64, M, M>::identity() - rows * covariance * rows.transpose();
    let left = left.cholesky()?;
    let log_left: f64 = left.l_dirty().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
    let measured = sample.information.iter().filter(|i| **i > 0.0);
    let log_noise: f64 = measured.map(|i| (std::f64::consts::TAU / i).ln()).sum();
    let log_density = -0.5 * (log_noise - log_left + residual.dot(&left.solve(&residual)));
    log_density.is_finite().then_some(log_density)
}
