//! What an observer must know about a system.

use nalgebra::{SMatrix, SVector};

/// A system in discrete time with `N` states and `M` output channels.
///
/// Sample `k` carries the input that drives the flow from sample `k - 1` to `k` and the output at `k`; whatever was
/// measured and is not predicted (inputs, times, angles) belongs there. Noise enters in two places: independent noise on
/// each output channel, whose information stands in the [`Sample`], and optional process noise of the flow.
///
/// See [`NewtonObserver`](crate::newton::NewtonObserver) for a worked example.
pub trait Model<const N: usize, const M: usize> {
    /// What drives the flow over one sampling interval and the output at its end.
    type Input;

    /// State at the sample of `input` from the state `x` one sample before, and its derivative with respect to `x`.
    fn flow(&self, x: &SVector<f64, N>, input: &Self::Input) -> (SVector<f64, N>, SMatrix<f64, N, N>);

    /// Outputs at state `x`, and their derivative with respect to `x`.
    fn output(&self, x: &SVector<f64, N>, input: &Self::Input) -> (SVector<f64, M>, SMatrix<f64, M, N>);

    /// Covariance of what the flow over this interval leaves out; none for a flow that is exact.
    fn process_noise(&self, _x: &SVector<f64, N>, _input: &Self::Input) -> Option<SMatrix<f64, N, N>> {
        None
    }

    /// The state alone, without derivative; override it where that is cheaper.
    fn advance(&self, x: &SVector<f64, N>, input: &Self::Input) -> SVector<f64, N> {
        self.flow(x, input).0
    }

    /// The state moved by a step. Override it, with [`Self::difference`], for states that are no vector space: the
    /// `N` numbers then store a point of the manifold (a rotation vector, say), and steps, derivatives, covariances and
    /// scales belong to its tangent space at that point.
    fn retract(&self, x: &SVector<f64, N>, step: &SVector<f64, N>) -> SVector<f64, N> {
        x + step
    }

    /// The step that leads from `from` to `to`: the inverse of [`Self::retract`].
    fn difference(&self, to: &SVector<f64, N>, from: &SVector<f64, N>) -> SVector<f64, N> {
        to - from
    }

    /// Derivative of `difference(retract(to, step), from)` with respect to `step`, at zero: the identity in a vector space,
    /// the inverse of the right Jacobian for rotations ([`rotation_slope`](crate::bank::rotation_slope)). Only a bank of modes asks
    /// for it, when it merges estimates that lie apart.
    fn difference_slope(&self, _to: &SVector<f64, N>, _from: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        SMatrix::identity()
    }

    /// Natural size of each state: the yardstick of ranks, conditions and of what counts as observed.
    fn scales(&self) -> SVector<f64, N>;

    /// Name of each state, as a report shall call it.
    fn names(&self) -> [&'static str; N];
}

/// One sample: the input up to it and what was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<I, const M: usize> {
    /// Input of the interval that ends here.
    pub input: I,
    /// Measured outputs; what stands in a channel without information is not looked at.
    pub measured: SVector<f64, M>,
    /// Information of each channel, one over its noise variance; zero for a channel that was not measured.
    pub information: SVector<f64, M>,
}
