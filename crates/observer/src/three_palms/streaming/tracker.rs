//! The observer of the motion, node by node, with a test of its innovations.

use crate::core::{Arrival, Model, NewtonObserver, NewtonOptions, ObserverError, Report, Sample, Start};
use crate::three_palms::momentum::StartState;
use crate::three_palms::state_space::{NodeInput, Parameters, ThreePalmModel};
use nalgebra::{SMatrix, SVector};

/// Blocks in the window: what comes before is carried along as a quadratic cost.
pub(super) const WINDOW: usize = 12;
/// Weight of a new channel in the running mean of normalised innovations: a memory of about a hundred, two thirds of a
/// second at 50 blocks a second.
const MEMORY: f64 = 0.01;
/// Damping of a step: as a prior that knows the natural sizes, it keeps what is not observed from running away.
const DAMPING: f64 = 1.0;
/// A channel's squared innovation counts up to this many expected ones: an outlier alone is no evidence.
const LARGEST: f64 = 25.0;

/// A windowed Gauss-Newton observer of `N` states.
pub(super) struct Tracker<const N: usize> {
    observer: NewtonObserver<ThreePalmModel<N>, N, 3>,
    innovation: f64,
}

/// The state at a node, with its evidence.
pub(super) struct Tracked<const N: usize> {
    pub(super) motion: StartState,
    pub(super) parameters: Parameters,
    pub(super) report: Report<N>,
}

impl<const N: usize> Tracker<N> {
    pub(super) fn new(model: ThreePalmModel<N>, start: Start<N>) -> Result<Self, ObserverError> {
        let options =
            NewtonOptions { window: WINDOW, steps: 1, damping: DAMPING, arrival: Arrival::Carry(1.0) };
        Ok(Self { observer: NewtonObserver::new(model, options, start)?, innovation: 1.0 })
    }

    /// Takes a node of the past along the motion that was started from: what it says is gathered, nothing moves.
    pub(super) fn catch_up(&mut self, input: NodeInput, touching: [bool; 3]) {
        self.observer.append(sample(input, &touching));
    }

    /// Takes a node; conditions of palms without contact are not looked at.
    pub(super) fn take(&mut self, input: NodeInput, touching: [bool; 3]) -> Tracked<N> {
        let sample = sample(input, &touching);
        self.test(&sample);
        let estimate = self.observer.push(sample);
        let model = self.observer.model();
        Tracked {
            motion: model.motion(&estimate.state),
            parameters: model.parameters(&estimate.state),
            report: estimate.report,
        }
    }

    /// Squared innovations over what is expected of them, in the mean of the latest hundred; one when all is as stated.
    pub(super) fn innovation(&self) -> f64 {
        self.innovation
    }

    fn test(&mut self, sample: &Sample<NodeInput, 3>) {
        let Sample { input, information, .. } = sample;
        let Some(before) = self.observer.estimate() else { return };
        if before.report.rank < N {
            return;
        }
        let model = self.observer.model();
        let (state, transition) = model.flow(&before.state, input);
        let mut covariance = transition * before.report.covariance * transition.transpose();
        covariance += model.process_noise(&before.state, input).unwrap_or_else(SMatrix::zeros);
        let (y, h) = model.output(&state, input);
        for i in (0..3).filter(|&i| information[i] > 0.0) {
            let row = h.row(i).transpose();
            let expected = 1.0 + row.dot(&(covariance * row));
            let square = (y[i] * y[i] / expected).min(LARGEST);
            // What is not a number is no evidence of anything but trouble.
            let square = if square.is_nan() { LARGEST } else { square };
            self.innovation += MEMORY * (square - self.innovation);
        }
    }
}

/// A node as the observer takes it: all conditions shall be zero, those of palms without contact do not count.
fn sample(input: NodeInput, touching: &[bool; 3]) -> Sample<NodeInput, 3> {
    let information = SVector::<f64, 3>::from_fn(|i, _| if touching[i] { 1.0 } else { 0.0 });
    Sample { input, measured: SVector::zeros(), information }
}
