//! One sample of a window as Gauss-Newton sees it, and what is known before the first.

use nalgebra::{SMatrix, SVector};

/// Quadratic model of the cost-to-go from one sample on, and the flow into it.
#[derive(Clone, Copy)]
pub(super) struct Node<const N: usize, const M: usize> {
    pub(super) x: SVector<f64, N>,
    /// Where the rest was linearised; differs from `x` after a step.
    pub(super) at: SVector<f64, N>,
    /// Derivative of the flow from the node before, and that flow's end minus this state.
    pub(super) transition: SMatrix<f64, N, N>,
    pub(super) defect: SVector<f64, N>,
    /// `(I + Q L)^-1` and `Q` for the flow into this node, where there is process noise.
    pub(super) noise: Option<(SMatrix<f64, N, N>, SMatrix<f64, N, N>)>,
    pub(super) own_information: SMatrix<f64, N, N>,
    pub(super) own_vector: SVector<f64, N>,
    pub(super) information: SMatrix<f64, N, N>,
    pub(super) vector: SVector<f64, N>,
}

impl<const N: usize, const M: usize> Node<N, M> {
    pub(super) fn new(x: SVector<f64, N>) -> Self {
        let zero = SMatrix::zeros();
        Self {
            x,
            at: x,
            transition: zero,
            defect: SVector::zeros(),
            noise: None,
            own_information: zero,
            own_vector: SVector::zeros(),
            information: zero,
            vector: SVector::zeros(),
        }
    }

    /// How the deviation here follows that of the node before, all data considered.
    pub(super) fn link(&self) -> Link<N> {
        match &self.noise {
            Some((gain, q)) => Link { transition: gain * self.transition, noise: gain * q },
            None => Link { transition: self.transition, noise: SMatrix::zeros() },
        }
    }

    /// Covariance here, all data considered, from that of the node before.
    pub(super) fn carried(&self, before: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
        let Link { transition, noise } = self.link();
        let p = transition * before * transition.transpose() + noise;
        (p + p.transpose()) * 0.5
    }
}

/// How the deviation of a state follows that of the one before, all data considered: `d_k = transition d_(k-1)` and an
/// independent deviation. With the covariance of the first state it is the joint distribution of all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link<const N: usize> {
    /// Derivative by the deviation before.
    pub transition: SMatrix<f64, N, N>,
    /// Covariance of the independent part.
    pub noise: SMatrix<f64, N, N>,
}

/// Knowledge of the first state: cost `d' L d / 2 - v' d`, `d` the step that leads to it from `at`.
#[derive(Clone, Copy)]
pub(super) struct Prior<const N: usize> {
    pub(super) at: SVector<f64, N>,
    pub(super) information: SMatrix<f64, N, N>,
    pub(super) vector: SVector<f64, N>,
}

impl<const N: usize> Prior<N> {
    /// Negative gradient of the cost after a step.
    pub(super) fn pull(&self, d: &SVector<f64, N>) -> SVector<f64, N> {
        self.vector - self.information * d
    }

    /// Twice the cost after a step, up to a constant.
    pub(super) fn cost(&self, d: &SVector<f64, N>) -> f64 {
        d.dot(&(self.information * d - self.vector * 2.0))
    }
}
