//! Several Gaussians into one with the same mean and covariance.

use super::super::model::Model;
use super::gaussian::{Branch, Gaussian};
use nalgebra::{SMatrix, SVector};

/// Steps towards the mean: in a vector space the first one arrives; for rotations each gains about two digits.
const STEPS: usize = 30;

/// Where states live: how a step leads from one to another.
pub(super) trait Space<const N: usize> {
    fn retract(&self, at: &SVector<f64, N>, step: &SVector<f64, N>) -> SVector<f64, N>;
    fn difference(&self, to: &SVector<f64, N>, from: &SVector<f64, N>) -> SVector<f64, N>;
    fn slope(&self, to: &SVector<f64, N>, from: &SVector<f64, N>) -> SMatrix<f64, N, N>;
}

/// The space of a model's states.
pub(super) struct StatesOf<'a, Mo, const M: usize>(pub(super) &'a Mo);

impl<Mo: Model<N, M>, const N: usize, const M: usize> Space<N> for StatesOf<'_, Mo, M> {
    fn retract(&self, at: &SVector<f64, N>, step: &SVector<f64, N>) -> SVector<f64, N> {
        self.0.retract(at, step)
    }
    fn difference(&self, to: &SVector<f64, N>, from: &SVector<f64, N>) -> SVector<f64, N> {
        self.0.difference(to, from)
    }
    fn slope(&self, to: &SVector<f64, N>, from: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        self.0.difference_slope(to, from)
    }
}

/// Moment matching: the mean `m` with `sum w_i d_i = 0`, `d_i` the step from `m` to branch `i`, found from the heaviest
/// branch on; the covariance `sum w_i (J_i P_i J_i' + d_i d_i')`, `J_i` the slope of that step, which brings the covariance
/// from the tangent space at the branch to that at `m`. Zero weights for no branch at all: the result is then NaN.
pub(super) fn merge<const N: usize>(space: &impl Space<N>, branches: &[Branch], into: &mut Gaussian) {
    let heaviest = branches.iter().max_by(|a, b| a.weight.total_cmp(&b.weight));
    let Some(heaviest) = heaviest else {
        return into.write(&SVector::<f64, N>::from_element(f64::NAN), &SMatrix::from_element(f64::NAN));
    };
    let (mut mean, mut last) = (heaviest.gaussian.read::<N>().0, f64::INFINITY);
    for _ in 0..STEPS {
        let mut step = SVector::<f64, N>::zeros();
        for branch in branches {
            step += space.difference(&branch.gaussian.read::<N>().0, &mean) * branch.weight;
        }
        mean = space.retract(&mean, &step);
        let length = step.norm();
        // Once rounding is all that is left, steps no longer shrink.
        if length == 0.0 || length > 0.5 * last || length.is_nan() {
            break;
        }
        last = length;
    }
    let mut covariance = SMatrix::<f64, N, N>::zeros();
    for branch in branches {
        let (at, p) = branch.gaussian.read::<N>();
        let d = space.difference(&at, &mean);
        let slope = space.slope(&at, &mean);
        covariance += (slope * p * slope.transpose() + d * d.transpose()) * branch.weight;
    }
    into.write(&mean, &covariance);
}
