//! The observer of the motion, node by node, with a test of its innovations.

use super::estimate::StreamBody;
use crate::core::{Arrival, Model, NewtonObserver, NewtonOptions, ObserverError, Report, Sample, Start};
use crate::least_squares::Fit;
use crate::three_palms::momentum::StartState;
use crate::three_palms::state_space::{
    BODY, INERTIA_NUMBERS, MOTION_STATES, NodeInput, Parameters, ThreePalmModel, inertia_of_numbers,
};
use glam::{DMat3, DVec3};
use nalgebra::{SMatrix, SVector};

/// Blocks in the window: what comes before is carried along as a quadratic cost.
pub(super) const WINDOW: usize = 12;
/// Weight that what was known keeps from node to node: errors of linearisations long ago fade in some 40 s at 50 nodes a
/// second. The motion itself is forgotten in a second or two anyway, since forces are noisy.
const MEMORY_OF_NODES: f64 = 0.9995;
/// Weight of a new channel in the running mean of normalised innovations: a memory of about a hundred, two thirds of a
/// second at 50 blocks a second.
const MEMORY: f64 = 0.01;
/// Deviations to which the fit of the search is believed when its data are gone through again, with noise where it
/// enters. Data are counted once, and an eighth of that again.
pub(super) const LOOSE: f64 = 3.0;
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

impl<const N: usize> Tracked<N> {
    /// Mass and inertia, where they are states; both or none are.
    pub(super) fn body(&self) -> Option<StreamBody> {
        if N < MOTION_STATES + BODY.len() {
            return None;
        }
        let Parameters { mass, inertia, .. } = self.parameters;
        let covariance = |i: usize, j: usize| self.report.covariance[(MOTION_STATES + i, MOTION_STATES + j)];
        // By differences: the tensor is quadratic and exponential in its numbers, which are of the order of one.
        let slopes: [DMat3; INERTIA_NUMBERS] = std::array::from_fn(|k| {
            let moved = |h: f64| {
                let mut numbers = inertia;
                numbers[k] += h;
                inertia_of_numbers(&numbers)
            };
            (moved(1e-6) - moved(-1e-6)) * 5e5
        });
        let deviation = |row: usize, column: usize| {
            let slope = |k: usize| slopes[k].col(column)[row];
            let terms = (0..INERTIA_NUMBERS)
                .flat_map(|k| (0..INERTIA_NUMBERS).map(move |l| (k, l)))
                .map(|(k, l)| slope(k) * covariance(1 + k, 1 + l) * slope(l));
            terms.sum::<f64>().max(0.0).sqrt()
        };
        let column = |j: usize| DVec3::new(deviation(0, j), deviation(1, j), deviation(2, j));
        Some(StreamBody {
            mass,
            mass_deviation: mass * covariance(0, 0).max(0.0).sqrt(),
            inertia: inertia_of_numbers(&inertia),
            inertia_deviation: DMat3::from_cols(column(0), column(1), column(2)),
        })
    }
}

impl<const N: usize> Tracker<N> {
    pub(super) fn new(model: ThreePalmModel<N>, start: Start<N>) -> Result<Self, ObserverError> {
        let options = NewtonOptions {
            window: WINDOW,
            steps: 1,
            damping: DAMPING,
            arrival: Arrival::Carry(MEMORY_OF_NODES),
        };
        Ok(Self { observer: NewtonObserver::new(model, options, start)?, innovation: 1.0 })
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

/// The information of a fit, believed to [`LOOSE`] of its deviations; `scales` are the natural sizes of its unknowns.
pub(super) fn loose_information<Point, const N: usize>(
    fit: &Fit<Point, N>,
    scales: &SVector<f64, N>,
) -> SMatrix<f64, N, N> {
    let share = 1.0 / (LOOSE * fit.normal.rms()).powi(2);
    SMatrix::from_fn(|i, j| fit.normal.information[(i, j)] * share / (scales[i] * scales[j]))
}

/// A node as the observer takes it: all conditions shall be zero, those of palms without contact do not count.
pub(super) fn sample(input: NodeInput, touching: &[bool; 3]) -> Sample<NodeInput, 3> {
    let information = SVector::<f64, 3>::from_fn(|i, _| if touching[i] { 1.0 } else { 0.0 });
    Sample { input, measured: SVector::zeros(), information }
}
