//! What an observer says about its estimate beside the estimate.

use super::eigen::{Eigen, symmetric_eigen};
use nalgebra::{SMatrix, SVector};
use thiserror::Error;

/// Eigenvalues of the scaled information below this share of the largest are rounding noise: information matrices are
/// sums of squares, so their small eigenvalues carry an error of about the machine precision times the largest.
const RANK_SHARE: f64 = 1e-13;
/// A direction counts as observed when its standard deviation is below this share of the states' natural sizes; beyond
/// it the estimate says less than knowing how large the scene is.
const OBSERVED_SHARE: f64 = 0.3;

/// How an estimate stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// The last step was small against the standard deviations (or against rounding, without noise).
    Converged,
    /// The estimate still moves by more than a tenth of its standard deviation a step.
    Moving,
    /// Some direction is not observed: see rank, smallest information and direction in the report.
    NotObservable,
    /// Residuals are too large for the noise that was stated: wrong minimum, wrong constants, or lost contact.
    Inconsistent,
    /// The iteration left the numbers that make sense.
    Diverged,
}

/// Why an observer cannot start.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ObserverError {
    /// Too few samples.
    #[error("{found} sample(s) given, at least {needed} are needed")]
    TooFewSamples {
        /// How many there are.
        found: usize,
        /// How many it takes.
        needed: usize,
    },
    /// A start value or an option is not a usable number.
    #[error("{what} is {value}; it must be {needed}")]
    Value {
        /// What the number is.
        what: &'static str,
        /// As given.
        value: f64,
        /// What it has to be.
        needed: &'static str,
    },
}

/// Evidence beside an estimate of `N` states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report<const N: usize> {
    /// How the estimate stands.
    pub status: Status,
    /// Number of samples that it rests on.
    pub samples: usize,
    /// Root mean square of the residuals in units of their standard deviations; about one when all is as stated. NaN
    /// when no channel was measured.
    pub residual: f64,
    /// Number of directions in state space that the data (and a prior) determine at all.
    pub rank: usize,
    /// Smallest eigenvalue of the information matrix in natural units: one over the variance, in units of the states'
    /// scales, of the least known direction.
    pub smallest_information: f64,
    /// That direction, a unit vector in natural units.
    pub direction: SVector<f64, N>,
    /// Ratio of the largest to the smallest singular value of the scaled Jacobian (square root of the eigenvalues').
    pub condition: f64,
    /// Covariance of the estimate, in units of the states. Directions without information have the variance of their
    /// natural scale divided by [`f64::EPSILON`]: large enough to cover the truth, finite enough to compute with.
    pub covariance: SMatrix<f64, N, N>,
}

impl<const N: usize> Report<N> {
    /// Standard deviation of each state.
    #[must_use]
    pub fn deviations(&self) -> SVector<f64, N> {
        self.covariance.diagonal().map(|v| v.max(0.0).sqrt())
    }

    /// The least known direction in words: the states that make it up, largest first, with their shares.
    ///
    /// ```
    /// # use nalgebra::SVector;
    /// let words = observer::describe_direction(&SVector::<f64, 3>::new(0.1, -0.99, 0.3), &["x", "angular velocity", "y"]);
    /// assert_eq!(words, "angular velocity (0.99), y (-0.30)");
    /// ```
    #[must_use]
    pub fn direction_in_words(&self, names: &[&'static str; N]) -> String {
        describe_direction(&self.direction, names)
    }

    /// Normalised estimation error squared, `e' P^-1 e`, for an error `e` of the estimate; its mean is `N` when the
    /// covariance is true. Infinite where the covariance is singular.
    #[must_use]
    pub fn nees(&self, error: &SVector<f64, N>) -> f64 {
        let scale = self.deviations().map(|d| d.max(f64::MIN_POSITIVE));
        let scaled = SMatrix::<f64, N, N>::from_fn(|i, j| self.covariance[(i, j)] / scale[i] / scale[j]);
        let e = error.component_div(&scale);
        scaled.cholesky().map_or(f64::INFINITY, |c| e.dot(&c.solve(&e)))
    }
}

/// A direction in state space in words: components above 0.25, largest first, the sign such that the first is positive.
#[must_use]
pub fn describe_direction<const N: usize>(direction: &SVector<f64, N>, names: &[&'static str; N]) -> String {
    direction_words(direction.as_slice(), |i| names[i])
}

/// As [`describe_direction`], for any number of states.
pub(crate) fn direction_words<T: std::fmt::Display>(direction: &[f64], name: impl Fn(usize) -> T) -> String {
    let mut order: Vec<usize> = (0..direction.len()).collect();
    order.sort_by(|&i, &j| direction[j].abs().total_cmp(&direction[i].abs()));
    let sign = order.first().map_or(1.0, |&i| direction[i].signum());
    let parts: Vec<String> = order
        .iter()
        .enumerate()
        .filter(|&(place, &i)| place == 0 || direction[i].abs() > 0.25)
        .map(|(_, &i)| format!("{} ({:.2})", name(i), sign * direction[i]))
        .collect();
    parts.join(", ")
}

/// Information matrix in natural units with its eigenvalues.
pub(super) struct ScaledInformation<const N: usize> {
    scales: SVector<f64, N>,
    eigen: Eigen<N>,
    floor: f64,
}

impl<const N: usize> ScaledInformation<N> {
    pub(super) fn new(information: &SMatrix<f64, N, N>, scales: &SVector<f64, N>) -> Self {
        let scaled = SMatrix::from_fn(|i, j| {
            0.5 * (information[(i, j)] + information[(j, i)]) * scales[i] * scales[j]
        });
        let eigen = symmetric_eigen(&scaled);
        let largest = if N == 0 { 0.0 } else { eigen.values[N - 1] };
        Self { scales: *scales, eigen, floor: (RANK_SHARE * largest).max(f64::MIN_POSITIVE) }
    }

    /// From a covariance: the eigenvalues are one over the covariance's, in ascending order again.
    pub(super) fn from_covariance(covariance: &SMatrix<f64, N, N>, scales: &SVector<f64, N>) -> Self {
        let inverse_scales = scales.map(|s| 1.0 / s);
        let Self { eigen, .. } = Self::new(covariance, &inverse_scales);
        let values = SVector::from_fn(|i, _| 1.0 / eigen.values[N - 1 - i].max(f64::MIN_POSITIVE));
        let vectors = SMatrix::from_fn(|i, j| eigen.vectors[(i, N - 1 - j)]);
        // A variance of the natural scale over epsilon stands for no information, as in `covariance`.
        Self { scales: *scales, eigen: Eigen { values, vectors }, floor: 2.0 * f64::EPSILON }
    }

    /// Largest eigenvalue, at least the smallest positive number.
    pub(super) fn largest(&self) -> f64 {
        self.eigen.values[N - 1].max(f64::MIN_POSITIVE)
    }

    pub(super) fn rank(&self) -> usize {
        self.eigen.values.iter().filter(|&&v| v > self.floor).count()
    }

    pub(super) fn observed(&self) -> bool {
        self.rank() == N && self.eigen.values[0] * OBSERVED_SHARE * OBSERVED_SHARE >= 1.0
    }

    /// Solves `(information + damping / scales^2) x = b`, leaving directions without information alone.
    pub(super) fn solve(&self, b: &SVector<f64, N>, damping: f64) -> SVector<f64, N> {
        let mut x = SVector::<f64, N>::zeros();
        let scaled = b.component_mul(&self.scales);
        for (value, vector) in self.eigen.values.iter().zip(self.eigen.vectors.column_iter()) {
            if *value > self.floor {
                x += vector * (vector.dot(&scaled) / (value + damping));
            }
        }
        x.component_mul(&self.scales)
    }

    pub(super) fn covariance(&self) -> SMatrix<f64, N, N> {
        let mut p = SMatrix::<f64, N, N>::zeros();
        for (value, vector) in self.eigen.values.iter().zip(self.eigen.vectors.column_iter()) {
            let variance = if *value > self.floor { 1.0 / value } else { 1.0 / f64::EPSILON };
            p += vector * vector.transpose() * variance;
        }
        SMatrix::from_fn(|i, j| p[(i, j)] * self.scales[i] * self.scales[j])
    }

    /// A report with this information; the covariance is given apart because it may belong to another instant.
    pub(super) fn report(
        &self,
        status: Status,
        samples: usize,
        residual: f64,
        covariance: SMatrix<f64, N, N>,
    ) -> Report<N> {
        let values = &self.eigen.values;
        let smallest = values[0].max(0.0);
        Report {
            status,
            samples,
            residual,
            rank: self.rank(),
            smallest_information: smallest,
            direction: self.eigen.vectors.column(0).into_owned(),
            condition: if smallest > 0.0 { (values[N - 1] / smallest).sqrt() } else { f64::INFINITY },
            covariance,
        }
    }
}
