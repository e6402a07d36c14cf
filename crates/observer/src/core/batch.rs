//! All samples at once, with Levenberg-Marquardt steps until nothing moves.
//!
//! The damping has a loop of its own beside that of [`LevenbergMarquardt`](crate::least_squares::LevenbergMarquardt): here a trial is a whole
//! trajectory, rolled out and linearised in place, and with process noise there are no trials.
//!
//! ```
//! use nalgebra::{SMatrix, SVector};
//! use observer::batch::{BatchOptions, solve_batch};
//! use observer::{Model, Sample, Start, Status};
//!
//! struct Cart; // position and speed, at 10 Hz; the position is measured
//!
//! impl Model<2, 1> for Cart {
//!     type Input = ();
//!     fn flow(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
//!         let slope = SMatrix::<f64, 2, 2>::new(1.0, 0.1, 0.0, 1.0);
//!         (slope * x, slope)
//!     }
//!     fn output(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 2>) {
//!         (SVector::<f64, 1>::new(x[0]), SMatrix::<f64, 1, 2>::new(1.0, 0.0))
//!     }
//!     fn scales(&self) -> SVector<f64, 2> { SVector::<f64, 2>::new(1.0, 1.0) }
//!     fn names(&self) -> [&'static str; 2] { ["position", "speed"] }
//! }
//!
//! # fn main() -> Result<(), observer::ObserverError> {
//! let at = |position: f64| Sample {
//!     input: (),
//!     measured: SVector::<f64, 1>::new(position),
//!     information: SVector::<f64, 1>::new(1e6), // one over (1 mm)^2
//! };
//! let samples: Vec<_> = (0..50).map(|k| at(2.0 + 0.03 * f64::from(k))).collect();
//! let start = Start::guess(SVector::<f64, 2>::zeros());
//! let found = solve_batch(&Cart, &samples, &start, &BatchOptions::default())?;
//! assert_eq!(found.report.status, Status::Converged);
//! assert!((found.states[0][1] - 0.3).abs() < 1e-9); // the speed at the first sample, known from all
//! # Ok(())
//! # }
//! ```

use super::model::{Model, Sample};
use super::newton::check_start;
pub use super::node::Link;
use super::report::{ObserverError, Report, ScaledInformation, Status};
use super::window::{Start, Window};
use nalgebra::{SMatrix, SVector};

/// Residual beyond which a converged solution is not explained by the noise; see the Newton observer.
const CONSISTENT_RESIDUAL: f64 = 3.0;
/// Damping is raised and lowered by this factor.
const DAMPING_FACTOR: f64 = 10.0;
/// Damping above this, in units of the largest eigenvalue, means that no downhill step can be found.
const DAMPING_LIMIT: f64 = 1e12;
/// Factor by which the damping of a step that is too long is raised, and its least value in units of the largest eigenvalue.
const SHORTENING: f64 = 3.0;
const LEAST_SHORTENING: f64 = 1e-12;
/// Share of a step's length that the next may have at most after one that went back.
const TURNED: f64 = 0.5;

/// How [`solve_batch`] works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BatchOptions {
    /// Most linearisations.
    pub iterations: usize,
    /// Stops when a step is below this share of the natural scales.
    pub step_tolerance: f64,
    /// Damping of the first step in natural units of the information; zero starts with Gauss-Newton.
    pub damping: f64,
    /// Longest step of the first state, in natural scales, with process noise: longer ones are damped until they are not. Far
    /// from the solution a full step leads out of where the linear model holds, most of all in directions that the data
    /// hardly determine.
    pub longest_step: f64,
}

impl Default for BatchOptions {
    fn default() -> Self {
        Self { iterations: 50, step_tolerance: 1e-12, damping: 0.0, longest_step: f64::INFINITY }
    }
}

/// A batch solution.
#[derive(Clone, Debug, PartialEq)]
pub struct BatchSolution<const N: usize> {
    /// States at all samples.
    pub states: Vec<SVector<f64, N>>,
    /// Evidence; its covariance belongs to the first state.
    pub report: Report<N>,
    /// Covariance of the state at each sample; that of the first also stands in the report.
    pub covariances: Vec<SMatrix<f64, N, N>>,
    /// What makes them one joint distribution: how the deviation at each sample from the second on follows the one before.
    pub links: Vec<Link<N>>,
    /// Chi-squared of the fit: squared residuals of outputs and process noise in units of their deviations. With all as
    /// stated it has as many degrees of freedom as there are measured channels beyond the `N` states.
    pub chi_squared: f64,
    /// Squared distance of the first state from the prior, in the prior's deviations.
    pub prior_cost: f64,
    /// Logarithm of the determinant of the information about states and process noise, the latter relative to what is
    /// known of it beforehand. Chi-squared, the prior's cost, this, and the logarithms of the outputs' variances are minus twice the
    /// logarithm of the probability mass about the solution, up to a constant (Laplace).
    pub log_determinant: f64,
    /// Output channels that were measured.
    pub channels: usize,
    /// Linearisations made.
    pub iterations: usize,
}

impl<const N: usize> BatchSolution<N> {
    /// Logarithm of the density of all outputs of `samples`, those that were solved, given the prior `start` of that solution:
    /// `-1/2 (J + ln det Hessian + sum of the ln det of all covariances + m ln 2 pi)`, `J` twice the cost and `m` the number of
    /// measured channels. Exact where the model is linear (there it is the sum of the innovations' log-likelihoods), else
    /// Laplace's approximation. None where the prior's information is not positive definite: a guess has no density.
    ///
    /// What a sample adds to it is the log-likelihood that an observer on a window gives to [`Odds`](crate::bank::Odds), with the
    /// same prior before and after. The difference of the costs alone leaves out how much narrower the estimate became.
    #[must_use]
    pub fn log_evidence<I, const M: usize>(&self, samples: &[Sample<I, M>], start: &Start<N>) -> Option<f64> {
        let root = start.information.cholesky()?;
        let prior: f64 = root.l_dirty().diagonal().iter().map(|d| -2.0 * d.ln()).sum();
        let information = samples.iter().flat_map(|s| s.information.iter());
        let sensors: f64 = information.filter(|i| **i > 0.0).map(|i| (std::f64::consts::TAU / i).ln()).sum();
        Some(-0.5 * (self.chi_squared + self.prior_cost + self.log_determinant + sensors + prior))
    }
}

/// Most probable trajectory through all `samples`, from `start`.
///
/// Without process noise a step is taken only when it lowers the cost, with the damping raised until it does
/// (Levenberg-Marquardt in natural units); with process noise all states are free and Gauss-Newton
/// steps are taken, full ones up to the longest that is allowed; one that goes back where the last came from halves it for the
/// next. Stops when the step falls below the tolerance, when the cost cannot be lowered any more, or after the iterations.
///
/// # Errors
/// [`ObserverError`] for fewer than two samples or an unusable start.
pub fn solve_batch<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    samples: &[Sample<Mo::Input, M>],
    start: &Start<N>,
    options: &BatchOptions,
) -> Result<BatchSolution<N>, ObserverError> {
    solve_batch_from(model, samples, start, start.state, options)
}

/// As [`solve_batch`], with an iteration that begins at the given `states`, one for each sample: for systems that the flow
/// alone leads astray from any start. Without process noise only the first of them counts.
///
/// # Errors
/// As [`solve_batch`], and [`ObserverError::TooFewSamples`] for fewer states than samples.
pub fn solve_batch_along<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    samples: &[Sample<Mo::Input, M>],
    start: &Start<N>,
    states: &[SVector<f64, N>],
    options: &BatchOptions,
) -> Result<BatchSolution<N>, ObserverError> {
    if states.len() < samples.len() {
        return Err(ObserverError::TooFewSamples { found: states.len(), needed: samples.len() });
    }
    check(samples, start)?;
    let mut window = Window::new(start, samples.len());
    window.set_states(states);
    iterate(model, samples, window, options)
}

/// As [`solve_batch`], with an iteration that begins at `first` rather than at the mean of the prior.
///
/// # Errors
/// As [`solve_batch`].
pub fn solve_batch_from<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    samples: &[Sample<Mo::Input, M>],
    start: &Start<N>,
    first: SVector<f64, N>,
    options: &BatchOptions,
) -> Result<BatchSolution<N>, ObserverError> {
    check(samples, start)?;
    let mut window = Window::new(start, samples.len());
    for sample in samples {
        window.append(model, &sample.input);
    }
    window.roll_out(model, samples.iter(), first);
    iterate(model, samples, window, options)
}

fn check<I, const N: usize, const M: usize>(
    samples: &[Sample<I, M>],
    start: &Start<N>,
) -> Result<(), ObserverError> {
    if samples.len() < 2 {
        return Err(ObserverError::TooFewSamples { found: samples.len(), needed: 2 });
    }
    check_start(start)
}

fn iterate<Mo: Model<N, M>, const N: usize, const M: usize>(
    model: &Mo,
    samples: &[Sample<Mo::Input, M>],
    mut window: Window<N, M>,
    options: &BatchOptions,
) -> Result<BatchSolution<N>, ObserverError> {
    let scales = model.scales();
    let free_noise = model.process_noise(window.state(0), &samples[1].input).is_some();
    let mut damping = options.damping;
    let mut iterations = 1;
    window.linearise(model, samples.iter());
    let mut settled = false;
    let (mut longest, mut last) = (options.longest_step, SVector::<f64, N>::zeros());
    while iterations < options.iterations && !settled {
        iterations += 1;
        let information = window.information(&scales);
        let (step, full) = if free_noise {
            let step = short_step(&window, model, &information, &scales, longest);
            // There and back again: nothing else says that a step went too far.
            let turned = step.0.component_div(&scales).dot(&last.component_div(&scales)) < 0.0;
            longest = if turned {
                longest.min(TURNED * last.component_div(&scales).amax())
            } else {
                (longest / TURNED).min(options.longest_step)
            };
            last = step.0;
            step
        } else {
            (window.step(model, &information, damping), true)
        };
        settled = full && step.component_div(&scales).amax() <= options.step_tolerance;
        if free_noise {
            window.apply(model, step);
            window.linearise(model, samples.iter());
            continue;
        }
        let (before, first) = (window.cost(model), *window.state(0));
        window.roll_out(model, samples.iter(), model.retract(&first, &step));
        window.linearise(model, samples.iter());
        // At the minimum the cost is flat to rounding: a rise of that size is no failure.
        if window.cost(model) <= before * (1.0 + 1e-12) {
            damping = if damping > 1e-3 { damping / DAMPING_FACTOR } else { 0.0 };
        } else {
            damping = (damping * DAMPING_FACTOR).max(information.largest() * 1e-6);
            settled = settled || damping > DAMPING_LIMIT * information.largest();
            window.roll_out(model, samples.iter(), first);
            window.linearise(model, samples.iter());
        }
    }
    let information = window.information(&scales);
    let residual = window.residual();
    let status = if !window.is_finite() || !residual.is_finite() {
        Status::Diverged
    } else if !information.observed() {
        Status::NotObservable
    } else if !settled {
        Status::Moving
    } else if residual > CONSISTENT_RESIDUAL {
        Status::Inconsistent
    } else {
        Status::Converged
    };
    let covariance = information.covariance();
    let report = information.report(status, samples.len(), residual, covariance);
    let states = window.states().copied().collect();
    let covariances = window.covariances(covariance);
    let chi_squared = window.data_cost() + window.noise_cost();
    let log_determinant = window.log_determinant();
    Ok(BatchSolution {
        states,
        covariances,
        links: window.links(),
        chi_squared,
        prior_cost: window.prior_cost(model),
        log_determinant,
        channels: window.channels(),
        report,
        iterations,
    })
}

/// The Gauss-Newton step, damped as far as it takes to make it no longer than `longest`, in natural scales; and whether it is
/// the full one.
fn short_step<Mo: Model<N, M>, const N: usize, const M: usize>(
    window: &Window<N, M>,
    model: &Mo,
    information: &ScaledInformation<N>,
    scales: &SVector<f64, N>,
    longest: f64,
) -> (SVector<f64, N>, bool) {
    let length = |step: &SVector<f64, N>| step.component_div(scales).amax();
    let (mut step, mut damping) = (window.step(model, information, 0.0), 0.0);
    while length(&step) > longest && damping < DAMPING_LIMIT * information.largest() {
        damping = (damping * SHORTENING).max(LEAST_SHORTENING * information.largest());
        step = window.step(model, information, damping);
    }
    (step, damping == 0.0)
}
