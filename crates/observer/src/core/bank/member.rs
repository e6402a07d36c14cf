//! One mode of a bank.

use super::super::kalman::{correct, predict};
use super::super::model::Model;
use super::error::BankError;
use super::gaussian::{Branch, Gaussian};
use super::merge::{StatesOf, merge};
use nalgebra::{DMatrix, SMatrix, SVector};

/// One mode of a bank: it predicts its own state, which may differ in size from that of other modes, and gives the density of
/// the outputs, which are the same for all modes: same entries, same units, noise and determinants included. Odds between
/// modes mean nothing without that.
///
/// [`KalmanMember`] makes one of any [`Model`].
pub trait Member<I>: Send {
    /// Number of states.
    fn states(&self) -> usize;

    /// Number of outputs.
    fn outputs(&self) -> usize;

    /// Carries mean and covariance over the interval of `input`.
    fn predict(&self, state: &mut Gaussian, input: &I);

    /// Takes in the outputs that were measured, and returns the logarithm of their density given all before them. None where
    /// the covariance of the outputs is not positive definite. Called with at least one measured output; what was not measured
    /// is `None` and stays out of the density.
    fn correct(&self, state: &mut Gaussian, input: &I, measured: &[Option<f64>]) -> Option<f64>;

    /// Puts a mixture into one Gaussian with the same moments. The weights sum to one.
    fn merge(&self, branches: &[Branch], into: &mut Gaussian);

    /// Derivative of the flow of [`Self::predict`] with respect to the state: what smoothing needs beside it.
    fn transition(&self, state: &Gaussian, input: &I) -> DMatrix<f64>;
}

/// An extended Kalman filter's step as a member of a bank: a model, and the noise of its outputs.
pub struct KalmanMember<Mo, const N: usize, const M: usize> {
    model: Mo,
    variances: SVector<f64, M>,
}

impl<Mo: Model<N, M>, const N: usize, const M: usize> KalmanMember<Mo, N, M> {
    /// A mode with independent noise of these variances on the outputs, each in its output's unit squared. They may differ from
    /// mode to mode: the density is normalised.
    ///
    /// # Errors
    /// [`BankError::Value`] for a variance that is not positive and finite.
    pub fn new(model: Mo, variances: SVector<f64, M>) -> Result<Self, BankError> {
        match variances.iter().find(|v| !(v.is_finite() && **v > 0.0)) {
            Some(&value) => {
                Err(BankError::Value { what: "variance of an output", value, needed: "positive and finite" })
            }
            None => Ok(Self { model, variances }),
        }
    }
}

impl<Mo: Model<N, M> + Send, const N: usize, const M: usize> Member<Mo::Input> for KalmanMember<Mo, N, M> {
    fn states(&self) -> usize {
        N
    }

    fn outputs(&self) -> usize {
        M
    }

    fn predict(&self, state: &mut Gaussian, input: &Mo::Input) {
        let (mut x, mut p) = state.read::<N>();
        predict(&self.model, &mut x, &mut p, input);
        state.write(&x, &p);
    }

    fn correct(&self, state: &mut Gaussian, input: &Mo::Input, measured: &[Option<f64>]) -> Option<f64> {
        let (mut x, mut p) = state.read::<N>();
        let (mut log_density, mut positive) = (0.0, true);
        let channel = |c: usize| Some((measured.get(c).copied().flatten()?, self.variances[c]));
        correct(&self.model, &mut x, &mut p, input, channel, |c, residual, variance| {
            // A semidefinite covariance adds to the noise; one below it is no covariance.
            positive &= variance >= self.variances[c] * (1.0 - LOST_POSITIVITY);
            log_density -= 0.5 * (residual * residual / variance + (std::f64::consts::TAU * variance).ln());
        });
        state.write(&x, &p);
        positive.then_some(log_density)
    }

    fn merge(&self, branches: &[Branch], into: &mut Gaussian) {
        merge::<N>(&StatesOf::<_, M>(&self.model), branches, into);
    }

    fn transition(&self, state: &Gaussian, input: &Mo::Input) -> DMatrix<f64> {
        let transition: SMatrix<f64, N, N> = self.model.flow(&state.read::<N>().0, input).1;
        DMatrix::from_column_slice(N, N, transition.as_slice())
    }
}

/// Share of the noise variance by which that of an innovation may fall below it: rounding of the covariance, where it is
/// nearly singular, in units of the noise.
const LOST_POSITIVITY: f64 = 1e-6;
