//! The observer of the motion, node by node, with a test of its innovations.

use super::estimate::StreamBody;
use crate::core::{Arrival, Model, NewtonObserver, NewtonOptions, Report, Sample, Smoother};
use crate::three_palms::momentum::StartState;
use crate::three_palms::state_space::{
    BODY, INERTIA_NUMBERS, MOTION_STATES, NodeInput, Parameters, ThreePalmModel, Touch, inertia_of_numbers,
};
use glam::{DMat3, DVec3};
use nalgebra::{SMatrix, SVector};

/// Blocks in the window: what comes before is carried along as a quadratic cost.
pub(super) const WINDOW: usize = 12;
/// Weight that what was known keeps from node to node: errors of linearisations long ago fade in some 40 s at 50 nodes a
/// second. The motion itself is forgotten in a second or two anyway, since forces are noisy.
pub(super) const MEMORY_OF_NODES: f64 = 0.9995;
/// Weight of a new channel in the running mean of normalised innovations: a memory of about a hundred, two thirds of a
/// second at 50 blocks a second.
const MEMORY: f64 = 0.01;
/// Damping of a step: as a prior that knows the natural sizes, it keeps what is not observed from running away.
const DAMPING: f64 = 1.0;
/// Neighbours on either side over which contacts are smoothed where derivatives are taken: some 0.05 s.
const SMOOTHED: usize = 2;
/// A channel's squared innovation counts up to this many expected ones: an outlier alone is no evidence.
const LARGEST: f64 = 25.0;

/// A windowed Gauss-Newton observer of `N` states.
pub(super) struct Tracker<const N: usize> {
    observer: NewtonObserver<ThreePalmModel<N>, N, 3>,
    innovation: f64,
    /// Variances of the rates at which the body turns against the palms at the latest node.
    slide: [f64; 3],
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
    /// Goes on from the last nodes of a motion that has settled.
    pub(super) fn going_on(settled: Smoother<ThreePalmModel<N>, N, 3>) -> Option<Self> {
        let options = NewtonOptions {
            window: WINDOW,
            steps: 1,
            damping: DAMPING,
            arrival: Arrival::Carry(MEMORY_OF_NODES),
        };
        let mut observer = settled.into_observer(options)?;
        observer.step();
        let slide = observer.samples().last()?.input.here.slide_variance;
        Some(Self { observer, innovation: 1.0, slide })
    }

    /// Takes a node; conditions of palms without contact are not looked at.
    pub(super) fn take(&mut self, input: NodeInput, touching: [bool; 3]) -> Tracked<N> {
        let mut sample = sample(input, &touching);
        self.test(&mut sample);
        let estimate = self.observer.push(sample);
        self.smooth();
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

    /// Gives derivatives at the node that now has [`SMOOTHED`] neighbours on either side what they must not take from its
    /// own noise, as the batch estimate does: contacts adjusted and smoothed, forces adjusted.
    fn smooth(&mut self) {
        let (all, model) = (2 * SMOOTHED + 1, self.observer.model());
        let window = self.observer.samples().len();
        let Some(first) = window.checked_sub(all + 1) else { return };
        // One node more, for the force before.
        let mut nodes = self.observer.trajectory().zip(self.observer.samples()).skip(first);
        let Some((mut before, _)) = nodes.next() else { return };
        let mut arms = [DVec3::ZERO; 3];
        let mut correction = DVec3::ZERO;
        for (j, (state, sample)) in nodes.enumerate() {
            let adjusted = model.adjusted_arms(state, &sample.input.here);
            for (sum, arm) in arms.iter_mut().zip(adjusted) {
                *sum += arm * parabola_weight(j);
            }
            if j == SMOOTHED {
                correction = model.missing_impulse(before, state, &sample.input);
            }
            before = state;
        }
        if let Some(sample) = self.observer.sample_mut(SMOOTHED) {
            sample.input.correction = correction;
            set_arms(&mut sample.input.here, &arms);
        }
        if let Some(next) = self.observer.sample_mut(SMOOTHED - 1) {
            set_arms(&mut next.input.from, &arms);
        }
    }

    fn test(&mut self, sample: &mut Sample<NodeInput, 3>) {
        let Sample { input, information, .. } = sample;
        input.from.slide_variance = self.slide;
        let Some(before) = self.observer.estimate() else { return };
        if before.report.rank < N {
            return;
        }
        let model = self.observer.model();
        let (state, transition) = model.flow(&before.state, input);
        let mut covariance = transition * before.report.covariance * transition.transpose();
        covariance += model.process_noise(&before.state, input).unwrap_or_else(SMatrix::zeros);
        self.slide = model.slide_variances(&state, &covariance, &input.here);
        input.here.slide_variance = self.slide;
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

/// Weight of neighbour `j` of `2 SMOOTHED + 1` in the value that a parabola through them has in the middle
/// (A. Savitzky, M. J. E. Golay, Anal. Chem. 36 (1964) 1627). Nodes are taken as evenly spaced.
fn parabola_weight(j: usize) -> f64 {
    let (r, j) = (SMOOTHED as f64, j as f64 - SMOOTHED as f64);
    3.0 * (3.0 * r * r + 3.0 * r - 1.0 - 5.0 * j * j) / ((2.0 * r - 1.0) * (2.0 * r + 1.0) * (2.0 * r + 3.0))
}

fn set_arms(touch: &mut Touch, arms: &[DVec3; 3]) {
    for (palm, &arm) in touch.palms.iter_mut().zip(arms) {
        (palm.smooth_arm, palm.own_share) = (arm, 0.0);
    }
}

/// A node as the observer takes it: all conditions shall be zero, those of palms without contact do not count.
pub(super) fn sample(input: NodeInput, touching: &[bool; 3]) -> Sample<NodeInput, 3> {
    let information = SVector::<f64, 3>::from_fn(|i, _| if touching[i] { 1.0 } else { 0.0 });
    Sample { input, measured: SVector::zeros(), information }
}
