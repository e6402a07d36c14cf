//! From a stream of planar samples to motion, orientation and shape, with or without a guess.

use super::constants::{Constant, PlanarNominal};
use super::doubt::{Doubt, doubt, doubtful, prior_deviations};
use super::error::PlanarEstimateError;
use super::force_driven::{ForceDriven, MOTION};
use super::input::{InputBuilder, PairInput};
use super::scale::NaturalScale;
use super::start::{neutral_start, residual_start};
use crate::{
    Arrival, BatchOptions, Model, NewtonObserver, NewtonOptions, Report, Sample, Start, solve_batch_from,
};
use glam::DVec2;
use nalgebra::SVector;
use object_dynamics::planar::PlanarSample;

/// Window in natural times `sqrt(L / g)`. Below 1.5 the information of the least known direction is a hundred times
/// smaller; at 6 a start without a guess succeeds.
const WINDOW_TIMES: f64 = 6.0;
/// Fewest samples in a window.
const FEWEST_SAMPLES: usize = 8;
/// Most samples in a window, which bounds memory and time per sample.
const MOST_SAMPLES: usize = 4000;

/// Where a [`PlanarObserver`] starts: `(cm, v, omega0)` at the first sample, in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PlanarStartFrom {
    /// No guess: the velocity residuals from nine neutral starts, then a batch fit.
    #[default]
    Nothing,
    /// A guess of any quality: the velocity residuals from there, then a batch fit.
    Guess([f64; 5]),
    /// A motion that is nearly right: Newton steps begin there.
    Motion([f64; 5]),
}

/// How a [`PlanarObserver`] works; the default needs no guess and chooses its window from the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarObserverOptions {
    /// Length of the window in s; none for six natural times.
    pub window: Option<f64>,
    /// Time in s before the first estimate; none for the length of the window.
    pub settle: Option<f64>,
    /// Newton steps a sample.
    pub steps: usize,
    /// What becomes of samples that leave the window.
    pub arrival: Arrival,
    /// Where it starts.
    pub start: PlanarStartFrom,
    /// Standard deviation of each estimated constant before the first sample, in its own unit; none for its
    /// natural size (a factor of 2.7 of mass and inertia, a gain of one, a bias of the weight, an offset of the size).
    pub constant_deviation: Option<f64>,
    /// Moments of inertia of the palms about the hinge, kg m^2, for logs with torques in place of forces.
    pub palm_inertias: [f64; 2],
}

impl Default for PlanarObserverOptions {
    fn default() -> Self {
        Self {
            window: None,
            settle: None,
            steps: 1,
            arrival: Arrival::Carry(1.0),
            start: PlanarStartFrom::Nothing,
            constant_deviation: None,
            palm_inertias: [0.0; 2],
        }
    }
}

/// What is known at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarEstimate<const N: usize> {
    /// Time, s.
    pub t: f64,
    /// State `(cm, v, omega0, constants)`.
    pub state: SVector<f64, N>,
    /// Orientation against the first sample, rad: the body's axes are those of the world at the first sample.
    pub phi0: f64,
    /// Radius functions `r_i = n_i . cm` at the contacts, m.
    pub radii: [f64; 2],
    /// Their standard deviations, m.
    pub radius_deviations: [f64; 2],
    /// Contact points in body axes from the centre of mass, m: the shape, point by point.
    pub contact_points: [DVec2; 2],
    /// Evidence.
    pub report: Report<N>,
    /// Why the linear covariance was not believed, where it was not; the report then claims no more than natural sizes.
    pub doubt: Option<Doubt>,
}

/// Estimates motion and shape from a stream of samples with `N - 5` constants as states.
pub struct PlanarObserver<const N: usize> {
    nominal: PlanarNominal,
    constants: Vec<Constant>,
    options: PlanarObserverOptions,
    builder: InputBuilder,
    waiting: Vec<PairInput>,
    scale: Option<NaturalScale>,
    newton: Option<NewtonObserver<ForceDriven<N>, N, 2>>,
    /// Orientation at the first sample of the window, rad.
    base: f64,
    /// Time to wait for after the first sample before the next attempt to start, s; none before the first attempt.
    next_attempt: Option<f64>,
}

impl<const N: usize> PlanarObserver<N> {
    /// An observer that has seen no sample.
    ///
    /// # Errors
    /// [`PlanarEstimateError`] for unusable numbers, or when `N` does not match the constants.
    pub fn new(
        nominal: PlanarNominal,
        constants: &[Constant],
        options: PlanarObserverOptions,
    ) -> Result<Self, PlanarEstimateError> {
        let unit = NaturalScale { length: 1.0, gravity: 1.0 };
        ForceDriven::<N>::new(nominal, unit, constants)?;
        for (what, value) in [("window", options.window), ("settling time", options.settle)] {
            if let Some(value) = value.filter(|v| !(*v > 0.0 && v.is_finite())) {
                return Err(PlanarEstimateError::Value { what, value, needed: "positive and finite" });
            }
        }
        for value in options.palm_inertias {
            if !(value >= 0.0 && value.is_finite()) {
                let needed = "finite and at least 0";
                return Err(PlanarEstimateError::Value { what: "palm inertia", value, needed });
            }
        }
        let builder = InputBuilder::new()
            .with_force_deviation(nominal.force_deviation)
            .with_palm_inertias(options.palm_inertias);
        Ok(Self {
            nominal,
            constants: constants.to_vec(),
            options,
            builder,
            waiting: Vec::new(),
            scale: None,
            newton: None,
            base: 0.0,
            next_attempt: None,
        })
    }

    /// The scene's natural scale, known from the first sample on.
    #[must_use]
    pub fn scale(&self) -> Option<NaturalScale> {
        self.scale
    }

    /// Length of the window in s, known from the first sample on.
    #[must_use]
    pub fn window(&self) -> Option<f64> {
        self.options.window.or_else(|| self.scale.map(|s| WINDOW_TIMES * s.time()))
    }

    /// The model, from the first estimate on.
    #[must_use]
    pub fn model(&self) -> Option<&ForceDriven<N>> {
        self.newton.as_ref().map(NewtonObserver::model)
    }

    /// Takes a sample. Nothing is returned while data for the first estimate are collected.
    ///
    /// # Errors
    /// [`PlanarEstimateError`], in particular at the first sample without both contacts.
    pub fn push(&mut self, sample: &PlanarSample) -> Result<Option<PlanarEstimate<N>>, PlanarEstimateError> {
        if self.scale.is_none() {
            self.scale = Some(NaturalScale::from_sample(sample, self.nominal.gravity)?);
        }
        let waiting = &mut self.waiting;
        self.builder.push(sample, |input| InputBuilder::place(waiting, input))?;
        if self.newton.is_some() {
            let Some(newest) = self.waiting.pop() else { return Ok(None) };
            self.amend();
            return Ok(self.advance(newest));
        }
        let (Some(window), Some(first)) = (self.window(), self.waiting.first()) else { return Ok(None) };
        let collected = sample.t - first.t;
        let rounding = 1e-9 * window;
        let due = self.next_attempt.or(self.options.settle).unwrap_or(window);
        if collected + rounding < due || self.waiting.len() < FEWEST_SAMPLES {
            return Ok(None);
        }
        let estimate = self.begin(window, collected)?;
        if self.newton.is_none() {
            self.next_attempt = Some(collected + 0.5 * window);
            if self.waiting.len() > MOST_SAMPLES {
                self.waiting.drain(..self.waiting.len() / 2);
                self.next_attempt = Some(0.5 * collected + 0.5 * window);
            }
        }
        Ok(estimate)
    }

    /// First estimate from the samples that have been collected. A cold start in doubt is reported but not built upon: the
    /// samples are kept, and with more of them it is tried again.
    fn begin(
        &mut self,
        window: f64,
        collected: f64,
    ) -> Result<Option<PlanarEstimate<N>>, PlanarEstimateError> {
        let Some(scale) = self.scale else { return Ok(None) };
        let inputs = std::mem::take(&mut self.waiting);
        let model = ForceDriven::<N>::new(self.nominal, scale, &self.constants)?;
        let samples: Vec<_> = inputs.iter().map(|&input| model.sample(input)).collect();
        let (start, cold) = self.start(&model, &inputs, &samples)?;
        let per_sample = collected / (inputs.len() - 1) as f64;
        let count = ((window / per_sample).round() as usize + 1).clamp(FEWEST_SAMPLES, MOST_SAMPLES);
        let options = NewtonOptions {
            window: count.max(inputs.len()),
            steps: self.options.steps,
            damping: 0.0,
            arrival: self.options.arrival,
        };
        let mut newton = NewtonObserver::new(model, options, start)?;
        let Some((last, earlier)) = samples.split_last() else { return Ok(None) };
        for sample in earlier {
            newton.append(*sample);
        }
        let mut report = newton.push(*last).report;
        if cold {
            // The start was fitted with an exact flow; a second step settles the process noise.
            report = newton.step().map_or(report, |e| e.report);
        }
        let doubt = if cold { doubt(&newton, &report, &scale) } else { None };
        let state = newton.estimate().map_or(start.state, |e| e.state);
        self.newton = Some(newton);
        if let Some(reason) = doubt {
            report = doubtful(report, &state, &last.input.stages[2], &scale);
            let estimate = self.estimate(state, report, Some(reason));
            (self.newton, self.waiting) = (None, inputs);
            return Ok(estimate);
        }
        Ok(self.estimate(state, report, None))
    }

    /// Start of the Newton observer, and whether it is a cold one.
    fn start(
        &self,
        model: &ForceDriven<N>,
        inputs: &[PairInput],
        samples: &[Sample<PairInput, 2>],
    ) -> Result<(Start<N>, bool), PlanarEstimateError> {
        let mut start = Start::<N>::guess(SVector::zeros());
        let scales = model.scales();
        for i in MOTION..N {
            let deviation = self.options.constant_deviation.unwrap_or(scales[i]);
            start.information[(i, i)] = 1.0 / (deviation * deviation);
        }
        let guess = match self.options.start {
            PlanarStartFrom::Nothing => None,
            PlanarStartFrom::Guess(guess) => Some(guess.into()),
            PlanarStartFrom::Motion(motion) => {
                start.state.fixed_rows_mut::<MOTION>(0).copy_from_slice(&motion);
                return Ok((start, false));
            }
        };
        let scale = model.scale();
        // What the sensors' readings alone say: an object of about the natural size that moves at natural speeds.
        let neutral = neutral_start(&inputs[0].stages[2], scale.length, 0.0);
        let deviations = prior_deviations(&scale);
        for (i, deviation) in deviations.iter().enumerate() {
            start.information[(i, i)] = 1.0 / (deviation * deviation);
        }
        start.state.fixed_rows_mut::<MOTION>(0).copy_from(&neutral);
        let first = residual_start(model, inputs, guess)?.state;
        let exact = model.clone().without_process_noise();
        let fit = solve_batch_from(&exact, samples, &start, first, &BatchOptions::default())?;
        // The prior is centred where the iteration starts; far out in its tails that costs a share of 1e-6 of the information.
        start.state = fit.states[0];
        Ok((start, true))
    }

    /// Gives the inputs that hindsight has improved to the window; none is waiting afterwards.
    fn amend(&mut self) {
        let Some(newton) = &mut self.newton else { return };
        for (back, input) in self.waiting.drain(..).rev().enumerate() {
            let sample = newton.model().sample(input);
            newton.amend(back, sample);
        }
    }

    fn advance(&mut self, input: PairInput) -> Option<PlanarEstimate<N>> {
        let newton = self.newton.as_mut()?;
        let first_turn = turns(newton).next().unwrap_or(0.0);
        let sample = newton.model().sample(input);
        if newton.is_full() {
            self.base += first_turn;
        }
        let estimate = newton.push(sample);
        let mut report = estimate.report;
        let mut reason = None;
        if self.options.arrival == Arrival::Forget
            && !matches!(self.options.start, PlanarStartFrom::Motion(_))
            && let (Some(newton), Some(scale)) = (&self.newton, self.scale)
        {
            reason = doubt(newton, &report, &scale);
            if reason.is_some() {
                report = doubtful(report, &estimate.state, &input.stages[2], &scale);
            }
        }
        self.estimate(estimate.state, report, reason)
    }

    fn estimate(
        &self,
        state: SVector<f64, N>,
        report: Report<N>,
        doubt: Option<Doubt>,
    ) -> Option<PlanarEstimate<N>> {
        let newton = self.newton.as_ref()?;
        let input = newton.samples().last()?.input;
        let phi0 = self.base + turns(newton).sum::<f64>();
        let stage = &input.stages[2];
        let cm = DVec2::new(state[0], state[1]);
        let radii = stage.normals.map(|n| n.dot(cm));
        let p = report.covariance.fixed_view::<2, 2>(0, 0);
        let radius_deviations = stage.normals.map(|n| {
            let n = SVector::<f64, 2>::new(n.x, n.y);
            n.dot(&(p * n)).max(0.0).sqrt()
        });
        let d = newton.model().contact_offsets(&state, stage);
        // Outward normal -n_i; the tangents in the world are -u_1 and u_2.
        let along = [stage.along[0] * -d[0], stage.along[1] * d[1]];
        let back = DVec2::from_angle(-phi0);
        let contact_points = [0, 1].map(|i| back.rotate(along[i] - stage.normals[i] * radii[i]));
        Some(PlanarEstimate {
            t: input.t,
            state,
            phi0,
            radii,
            radius_deviations,
            contact_points,
            report,
            doubt,
        })
    }
}

/// Turn over each interval of the window, by the trapezoid rule with end correction: error of order `h^5` an interval.
fn turns<const N: usize>(newton: &NewtonObserver<ForceDriven<N>, N, 2>) -> impl Iterator<Item = f64> {
    let model = newton.model();
    let mut before: Option<(f64, f64)> = None;
    newton.trajectory().zip(newton.samples()).filter_map(move |(x, sample)| {
        let here = (x[4], model.angular_acceleration(x, &sample.input.stages[2]));
        let h = sample.input.dt;
        let turn = before.map(|b| h * (0.5 * (b.0 + here.0) + h / 12.0 * (b.1 - here.1)));
        before = Some(here);
        turn
    })
}
