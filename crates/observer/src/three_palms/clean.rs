//! Logs with next to no noise: at how many samples derivatives are taken, and what is known of the unknowns.

use super::cold_start::{SAMPLES_PER_NATURAL_TIME, natural_time};
use super::correlation::correlation_samples;
use super::covariance::{Linearised, NoiseLevel, Sampling, propagate_to};
use super::momentum::Scales;
use super::track::Track;
use crate::least_squares::Observability;
use nalgebra::{SMatrix, SVector};

/// Samples that the covariance is computed from, at most: it varies as slowly as the motion.
const COVARIANCE_SAMPLES: usize = 400;
/// Smallest share of the largest information that still counts as information: rounding of `J' J`.
pub(super) const RANK_TOLERANCE: f64 = 1e-14;

/// Samples of a log with next to no noise for one at which derivatives are taken.
pub(super) fn stride(track: &Track, scales: &Scales) -> usize {
    let nodes = SAMPLES_PER_NATURAL_TIME * track.duration() / natural_time(track, scales.length);
    let nodes = nodes.min(COVARIANCE_SAMPLES as f64).max(1.0);
    // The line through the last two nodes needs two.
    ((track.len() as f64 / nodes) as usize).clamp(1, track.len() / 2)
}

/// What is known of the scaled unknowns of a fit.
pub(super) struct Clean<const P: usize> {
    pub(super) covariance: SMatrix<f64, P, P>,
    /// Residual that noise explains, m/s.
    pub(super) predicted: f64,
    /// Deviation of the contacts that would explain what is left beside it, m.
    pub(super) lasting: f64,
}

/// What is known of a fit to a log with next to no noise.
///
/// What noise does not explain is a lasting error of sensors or model: as many independent ones as there are correlation
/// times in the log.
pub(super) fn clean_covariance<const P: usize>(
    steps: &[Linearised],
    rows: &[[SVector<f64, P>; 3]],
    observability: &Observability<P>,
    noise: &NoiseLevel,
    stride: usize,
    residuals: &[[f64; 3]],
) -> Clean<P> {
    let per_node = stride as f64;
    let sampling = Sampling { per_node, weight: per_node, direct: per_node };
    let inverse = information_inverse(observability);
    let from_noise = propagate_to(steps, rows, &inverse, noise, sampling);
    let lasting = root_mean_square(residuals).powi(2) - from_noise.residual.powi(2);
    let excess = lasting.max(0.0) * correlation_samples(residuals);
    let slopes: f64 = steps.iter().flat_map(|s| s.by_contact).map(|[a, b]| a * a + b * b).sum();
    let slope = slopes / (3 * steps.len().max(1)) as f64;
    Clean {
        covariance: from_noise.covariance + inverse * excess + unknown(observability),
        predicted: from_noise.residual,
        lasting: if slope > 0.0 { (lasting.max(0.0) / slope).sqrt() } else { 0.0 },
    }
}

pub(super) fn root_mean_square(residuals: &[[f64; 3]]) -> f64 {
    (residuals.iter().flatten().map(|e| e * e).sum::<f64>() / (3 * residuals.len()) as f64).sqrt()
}

pub(super) fn information_inverse<const P: usize>(observability: &Observability<P>) -> SMatrix<f64, P, P> {
    let floor = RANK_TOLERANCE * observability.eigenvalues[P - 1];
    // Directions without information get the inverse of the floor: a variance that is plainly no knowledge.
    let inverse = observability.eigenvalues.map(|v| 1.0 / v.max(floor).max(f64::MIN_POSITIVE));
    observability.directions * SMatrix::from_diagonal(&inverse) * observability.directions.transpose()
}

/// Unit variance, in natural sizes, of the directions that the data say nothing of in double precision: there noise is
/// carried to the unknowns by zero over zero.
fn unknown<const P: usize>(observability: &Observability<P>) -> SMatrix<f64, P, P> {
    let floor = RANK_TOLERANCE * observability.eigenvalues[P - 1];
    let variance = observability.eigenvalues.map(|v| if v > floor { 0.0 } else { 1.0 });
    observability.directions * SMatrix::from_diagonal(&variance) * observability.directions.transpose()
}
