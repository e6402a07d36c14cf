//! The two halves of a Kalman filter's step, for one filter and for a bank of them.

use super::model::Model;
use nalgebra::{SMatrix, SVector};

/// Over one interval: `x <- flow(x)`, `P <- F P F' + Q`.
pub(super) fn predict<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    state: &mut SVector<f64, N>,
    covariance: &mut SMatrix<f64, N, N>,
    input: &Mo::Input,
) {
    let (next, transition) = model.flow(state, input);
    *covariance = transition * *covariance * transition.transpose();
    if let Some(q) = model.process_noise(state, input) {
        *covariance += q;
    }
    *state = next;
}

/// Joseph form, one channel after the other: no matrix is inverted. `channel` tells what a channel measured and its noise
/// variance, none where it did not measure. Every innovation, given the channels before it, goes to `seen` with its variance:
/// their densities multiply to that of all channels.
pub(super) fn correct<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    state: &mut SVector<f64, N>,
    covariance: &mut SMatrix<f64, N, N>,
    input: &Mo::Input,
    channel: impl Fn(usize) -> Option<(f64, f64)>,
    mut seen: impl FnMut(usize, f64, f64),
) {
    let (y, h) = model.output(state, input);
    // One step from where the outputs were linearised, built up channel by channel.
    let mut step = SVector::<f64, N>::zeros();
    for c in 0..M {
        let Some((measured, noise)) = channel(c) else { continue };
        let row = h.row(c).transpose();
        let ph = *covariance * row;
        // Positive: the noise variance is, and the covariance is kept semidefinite.
        let variance = row.dot(&ph) + noise;
        let gain = ph / variance;
        let residual = measured - y[c] - row.dot(&step);
        step += gain * residual;
        let keep = SMatrix::identity() - gain * row.transpose();
        *covariance = keep * *covariance * keep.transpose() + gain * gain.transpose() * noise;
        seen(c, residual, variance);
    }
    *state = model.retract(state, &step);
    *covariance = (*covariance + covariance.transpose()) * 0.5;
}
