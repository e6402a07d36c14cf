//! The Newton-method observer on a moving window.
//!
//! A pendulum whose angle is measured, neither its speed nor its length known:
//!
//! ```
//! use nalgebra::{SMatrix, SVector};
//! use observer::newton::{Arrival, NewtonObserver, NewtonOptions};
//! use observer::{Model, Sample, Start, Status, rk4::rk4_linearised};
//!
//! struct Pendulum; // states: angle, speed, g / length; sampled at 100 Hz
//!
//! impl Model<3, 1> for Pendulum {
//!     type Input = ();
//!     fn flow(&self, x: &SVector<f64, 3>, (): &()) -> (SVector<f64, 3>, SMatrix<f64, 3, 3>) {
//!         rk4_linearised(x, 0.01, |_, x| {
//!             let (sin, cos) = x[0].sin_cos();
//!             let rate = SVector::<f64, 3>::new(x[1], -x[2] * sin, 0.0);
//!             let slope = SMatrix::<f64, 3, 3>::new(0.0, 1.0, 0.0, -x[2] * cos, 0.0, -sin, 0.0, 0.0, 0.0);
//!             (rate, slope)
//!         })
//!     }
//!     fn output(&self, x: &SVector<f64, 3>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 3>) {
//!         (SVector::<f64, 1>::new(x[0]), SMatrix::<f64, 1, 3>::new(1.0, 0.0, 0.0))
//!     }
//!     fn scales(&self) -> SVector<f64, 3> { SVector::<f64, 3>::new(1.0, 3.0, 10.0) }
//!     fn names(&self) -> [&'static str; 3] { ["angle", "angular velocity", "gravity over length"] }
//! }
//!
//! # fn main() -> Result<(), observer::ObserverError> {
//! let options = NewtonOptions { window: 100, steps: 1, damping: 0.0, arrival: Arrival::Forget };
//! let guess = Start::guess(SVector::<f64, 3>::new(0.9, 0.1, 8.0));
//! let mut observer = NewtonObserver::new(Pendulum, options, guess)?;
//! let mut truth = SVector::<f64, 3>::new(1.0, 0.0, 9.81);
//! for _ in 0..150 {
//!     let information = SVector::<f64, 1>::new(1e6); // one over (1 mrad)^2
//!     let sample = Sample { input: (), measured: SVector::<f64, 1>::new(truth[0]), information };
//!     let estimate = observer.push(sample);
//!     if estimate.report.status == Status::NotObservable {
//!         // the first samples: one angle says nothing about speed and length
//!         let names = Pendulum.names();
//!         assert!(!estimate.report.direction_in_words(&names).is_empty());
//!     }
//!     if estimate.report.status == Status::Converged {
//!         assert!((estimate.state[2] - 9.81).abs() < 5.0 * estimate.report.deviations()[2]);
//!     }
//!     truth = Pendulum.flow(&truth, &()).0;
//! }
//! # let last = observer.estimate().map(|e| e.state[2]);
//! # assert!(last.is_some_and(|g| (g - 9.81).abs() < 1e-9), "{last:?}");
//! # Ok(())
//! # }
//! ```

use super::density::log_density;
use super::model::{Model, Sample};
use super::report::{ObserverError, Report, Status};
use super::window::{Start, Window};
use nalgebra::SVector;
use std::collections::VecDeque;

/// A step below this share of the standard deviations counts as converged.
const CONVERGED_STEP: f64 = 0.1;
/// Normalised residuals above this are not noise: a chi-squared mean of ten or more samples does not exceed 9.
const CONSISTENT_RESIDUAL: f64 = 3.0;

/// What becomes of the knowledge in a sample that leaves the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arrival {
    /// It is forgotten: the moving window of Zimmer, whose memory is exactly the window.
    Forget,
    /// It is carried along as a quadratic cost on the first state of the window, weakened by this factor in `(0, 1]` a
    /// sample. With factor one the estimate rests on all data, like a filter, but linearised over and over in the window.
    Carry(f64),
}

/// How a [`NewtonObserver`] works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonOptions {
    /// Samples in the window, at least two.
    pub window: usize,
    /// Newton steps per sample, at least one.
    pub steps: usize,
    /// Levenberg's damping in natural units of the information; zero for pure Gauss-Newton.
    pub damping: f64,
    /// What becomes of samples that leave the window.
    pub arrival: Arrival,
}

/// State at the newest sample with its evidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonEstimate<const N: usize> {
    /// State at the newest sample.
    pub state: SVector<f64, N>,
    /// State at the oldest sample of the window.
    pub first_state: SVector<f64, N>,
    /// Evidence; the covariance belongs to `state`, rank, information and direction to the window as a whole (its
    /// first state).
    pub report: Report<N>,
}

/// Observer that minimises the output error over a moving window with one or a few Newton steps per sample
/// (G. Zimmer, State observation by on-line minimization, Int. J. Control 60 (1994) 595-606; the paper's reference 25).
///
/// The Gauss-Newton matrix takes the place of the Hessian: the second derivatives that it leaves out are multiplied by
/// the residuals, which vanish at the solution. Work and memory per sample are bounded by the window; nothing is allocated
/// after construction. Without process noise the window's states follow from its first one by the flow (single shooting);
/// with process noise all states of the window are free and the noise is estimated along.
pub struct NewtonObserver<Mo: Model<N, M>, const N: usize, const M: usize> {
    model: Mo,
    options: NewtonOptions,
    scales: SVector<f64, N>,
    samples: VecDeque<Sample<Mo::Input, M>>,
    window: Window<N, M>,
    last: Option<NewtonEstimate<N>>,
}

impl<Mo: Model<N, M>, const N: usize, const M: usize> NewtonObserver<Mo, N, M> {
    /// An observer that has seen no sample yet; `start` is the state at the first one.
    ///
    /// # Errors
    /// [`ObserverError`]: a window below two samples, no step, or a value that is not a usable number.
    pub fn new(model: Mo, options: NewtonOptions, start: Start<N>) -> Result<Self, ObserverError> {
        let NewtonOptions { window, steps, damping, arrival } = options;
        if window < 2 {
            return Err(ObserverError::TooFewSamples { found: window, needed: 2 });
        }
        if steps == 0 {
            return Err(ObserverError::Value {
                what: "Newton steps per sample",
                value: 0.0,
                needed: "at least 1",
            });
        }
        if !(damping >= 0.0 && damping.is_finite()) {
            return Err(ObserverError::Value {
                what: "damping",
                value: damping,
                needed: "finite and at least 0",
            });
        }
        if let Arrival::Carry(factor) = arrival
            && !(factor > 0.0 && factor <= 1.0)
        {
            return Err(ObserverError::Value { what: "arrival factor", value: factor, needed: "in (0, 1]" });
        }
        check_start(&start)?;
        let scales = model.scales();
        // One more than the window: a sample is appended before the oldest one is dropped.
        let samples = VecDeque::with_capacity(window + 1);
        Ok(Self { scales, samples, window: Window::new(&start, window + 1), model, options, last: None })
    }

    /// Takes a sample, steps, and returns the estimate at that sample.
    pub fn push(&mut self, sample: Sample<Mo::Input, M>) -> NewtonEstimate<N> {
        self.append(sample);
        self.improve()
    }

    /// Steps on the samples that are there; none before the first one.
    pub fn step(&mut self) -> Option<NewtonEstimate<N>> {
        (!self.samples.is_empty()).then(|| self.improve())
    }

    /// Takes a sample without stepping, as while too few of them have come for a step to make sense.
    pub fn append(&mut self, sample: Sample<Mo::Input, M>) {
        self.window.append(&self.model, &sample.input);
        self.samples.push_back(sample);
        if self.samples.len() > self.options.window {
            let keep = match self.options.arrival {
                Arrival::Forget => 0.0,
                Arrival::Carry(factor) => factor,
            };
            // Only the two oldest nodes matter here; they are not linearised when samples were appended without steps.
            if keep > 0.0 && self.window.linearised() < 2 {
                self.window.linearise(&self.model, self.samples.iter());
            }
            self.window.drop_first(&self.model, keep);
            self.samples.pop_front();
        }
    }

    /// Puts another sample in the place of the one `back` samples before the newest, as when its input becomes known better
    /// in hindsight; the next step takes it into account. False, and no change, where the window does not reach so far back.
    pub fn amend(&mut self, back: usize, sample: Sample<Mo::Input, M>) -> bool {
        let slot = self.samples.len().checked_sub(back + 1).and_then(|k| self.samples.get_mut(k));
        slot.map(|old| *old = sample).is_some()
    }

    /// Whether the next sample pushes the oldest one out of the window.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.samples.len() >= self.options.window
    }

    /// The latest estimate; none before the first sample.
    #[must_use]
    pub fn estimate(&self) -> Option<&NewtonEstimate<N>> {
        self.last.as_ref()
    }

    /// Logarithm of the density of the newest sample, given the others of the window and what was carried into it: what
    /// [`Odds`](crate::bank::Odds) takes. As good as the estimate is converged, and exact for a linear model. None before the first
    /// sample, and where nothing but that sample tells its outputs.
    #[must_use]
    pub fn log_density(&self) -> Option<f64> {
        let (estimate, sample) = (self.last.as_ref()?, self.samples.back()?);
        log_density(&self.model, sample, &estimate.state, &estimate.report.covariance)
    }

    /// States of the window, oldest first.
    pub fn trajectory(&self) -> impl Iterator<Item = &SVector<f64, N>> {
        self.window.states()
    }

    /// Samples of the window, oldest first.
    pub fn samples(&self) -> impl ExactSizeIterator<Item = &Sample<Mo::Input, M>> {
        self.samples.iter()
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &Mo {
        &self.model
    }

    fn improve(&mut self) -> NewtonEstimate<N> {
        let mut information = None;
        let mut step = SVector::zeros();
        for _ in 0..self.options.steps {
            self.window.linearise(&self.model, self.samples.iter());
            let scaled = self.window.information(&self.scales);
            step = self.window.step(&self.model, &scaled, self.options.damping);
            let free_noise = self
                .samples
                .back()
                .is_some_and(|s| self.model.process_noise(self.window.state(0), &s.input).is_some());
            if free_noise {
                self.window.apply(&self.model, step);
            } else {
                let first = self.model.retract(self.window.state(0), &step);
                self.window.roll_out(&self.model, self.samples.iter(), first);
            }
            information = Some(scaled);
        }
        let information = information.unwrap_or_else(|| self.window.information(&self.scales));
        let first_covariance = information.covariance();
        let covariance = self.window.last_covariance(first_covariance);
        let residual = self.window.residual();
        let status = status(&information, &self.window, &step, &first_covariance.diagonal(), residual);
        let estimate = NewtonEstimate {
            state: *self.window.state(self.window.len() - 1),
            first_state: *self.window.state(0),
            report: information.report(status, self.samples.len(), residual, covariance),
        };
        self.last = Some(estimate);
        estimate
    }
}

fn status<const N: usize, const M: usize>(
    information: &super::report::ScaledInformation<N>,
    window: &Window<N, M>,
    step: &SVector<f64, N>,
    variances: &SVector<f64, N>,
    residual: f64,
) -> Status {
    let moved = step.iter().zip(variances).fold(0.0_f64, |m, (s, v)| m.max(s.abs() / v.sqrt()));
    if !window.is_finite() || step.iter().any(|s| !s.is_finite()) {
        Status::Diverged
    } else if !information.observed() {
        Status::NotObservable
    } else if moved > CONVERGED_STEP {
        Status::Moving
    } else if residual > CONSISTENT_RESIDUAL {
        Status::Inconsistent
    } else {
        Status::Converged
    }
}

/// Refuses a start that is not made of numbers.
pub(super) fn check_start<const N: usize>(start: &Start<N>) -> Result<(), ObserverError> {
    let needed = "finite";
    if let Some(&value) = start.state.iter().find(|v| !v.is_finite()) {
        return Err(ObserverError::Value { what: "start state", value, needed });
    }
    match start.information.iter().find(|v| !v.is_finite()) {
        Some(&value) => Err(ObserverError::Value { what: "start information", value, needed }),
        None => Ok(()),
    }
}
