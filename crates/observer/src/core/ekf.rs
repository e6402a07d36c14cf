//! The extended Kalman filter: the cheap rival.
//!
//! The crate's first page has an example: a cart of which the position is measured.

use super::kalman::{correct, predict};
use super::model::{Model, Sample};
use super::newton::check_start;
use super::report::{ObserverError, Report, ScaledInformation, Status};
use super::window::Start;
use nalgebra::{SMatrix, SVector};

/// Weight of a new normalised innovation in their running mean square: a memory of about a hundred samples.
const INNOVATION_MEMORY: f64 = 0.01;
/// Running mean square of normalised innovations beyond which the filter contradicts its data (expected: one; a hundred
/// channels have a standard deviation of 0.14).
const CONSISTENT_INNOVATION: f64 = 4.0;

/// State at the newest sample with its evidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EkfEstimate<const N: usize> {
    /// State.
    pub state: SVector<f64, N>,
    /// Evidence; `residual` is the running root mean square of the normalised innovations.
    pub report: Report<N>,
}

/// Extended Kalman filter in Joseph form, one channel after the other: no matrix is inverted.
pub struct ExtendedKalmanFilter<Mo: Model<N, M>, const N: usize, const M: usize> {
    model: Mo,
    scales: SVector<f64, N>,
    state: SVector<f64, N>,
    covariance: SMatrix<f64, N, N>,
    innovation: f64,
    samples: usize,
}

impl<Mo: Model<N, M>, const N: usize, const M: usize> ExtendedKalmanFilter<Mo, N, M> {
    /// A filter that has seen no sample yet. Directions of `start` without information get the huge variance that
    /// [`Report::covariance`] describes; a filter linearises once, so it should start near the truth.
    ///
    /// # Errors
    /// [`ObserverError::Value`] for a start that is not finite.
    pub fn new(model: Mo, start: &Start<N>) -> Result<Self, ObserverError> {
        check_start(start)?;
        let scales = model.scales();
        let covariance = ScaledInformation::new(&start.information, &scales).covariance();
        Ok(Self { model, scales, state: start.state, covariance, innovation: 1.0, samples: 0 })
    }

    /// Takes a sample: predicts over its interval (not for the first one) and corrects.
    pub fn push(&mut self, sample: &Sample<Mo::Input, M>) {
        if self.samples > 0 {
            predict(&self.model, &mut self.state, &mut self.covariance, &sample.input);
        }
        self.samples += 1;
        let channel = |c: usize| {
            (sample.information[c] > 0.0).then(|| (sample.measured[c], 1.0 / sample.information[c]))
        };
        let innovation = &mut self.innovation;
        let seen = |_: usize, residual: f64, variance: f64| {
            *innovation += INNOVATION_MEMORY * (residual * residual / variance - *innovation);
        };
        correct(&self.model, &mut self.state, &mut self.covariance, &sample.input, channel, seen);
    }

    /// The state.
    #[must_use]
    pub fn state(&self) -> &SVector<f64, N> {
        &self.state
    }

    /// Its covariance.
    #[must_use]
    pub fn covariance(&self) -> &SMatrix<f64, N, N> {
        &self.covariance
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &Mo {
        &self.model
    }

    /// State and evidence. Costs an eigenvalue problem; the filter itself does not need it.
    #[must_use]
    pub fn estimate(&self) -> EkfEstimate<N> {
        let information = ScaledInformation::from_covariance(&self.covariance, &self.scales);
        let status = if !self.state.iter().all(|v| v.is_finite()) || !self.innovation.is_finite() {
            Status::Diverged
        } else if !information.observed() {
            Status::NotObservable
        } else if self.innovation > CONSISTENT_INNOVATION {
            Status::Inconsistent
        } else {
            Status::Converged
        };
        let report = information.report(status, self.samples, self.innovation.sqrt(), self.covariance);
        EkfEstimate { state: self.state, report }
    }
}
