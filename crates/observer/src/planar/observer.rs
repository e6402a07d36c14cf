//! From a stream of planar samples to motion, orientation and shape, with or without a guess.

use super::constants::{Constant, PlanarNominal};
use super::doubt::{Doubt, doubt, doubt_along, doubtful, prior_deviations};
use super::error::PlanarEstimateError;
use super::estimate::{PlanarEstimate, turns};
use super::force_driven::{ForceDriven, MOTION};
use super::input::{InputBuilder, PairInput};
use super::options::{PlanarObserverOptions, PlanarStartFrom};
use super::scale::NaturalScale;
use super::start::{neutral_start, residual_start};
use crate::{
    Arrival, BatchOptions, Model, NewtonObserver, NewtonOptions, Report, Sample, Start, solve_batch_from,
};
use nalgebra::SVector;
use object_dynamics::planar::PlanarSample;

/// Window in natural times `sqrt(L / g)`. Below 1.5 the information of the least known direction is a hundred times
/// smaller; at 6 a start without a guess succeeds.
const WINDOW_TIMES: f64 = 6.0;
/// Fewest samples in a window.
const FEWEST_SAMPLES: usize = 8;
/// Most samples in a window, which bounds memory and time per sample.
const MOST_SAMPLES: usize = 4000;

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
        options.check()?;
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
        let (newton, scale) = (self.newton.as_ref()?, self.scale?);
        // A window that forgets can lose what it knew; a given motion is taken at its word until readings contradict it.
        let forgets = self.options.arrival == Arrival::Forget;
        let reason = match self.options.start {
            PlanarStartFrom::Nothing | PlanarStartFrom::Guess(_) if forgets => doubt(newton, &report, &scale),
            _ => doubt_along(newton, &report),
        };
        if reason.is_some() {
            report = doubtful(report, &estimate.state, &input.stages[2], &scale);
        }
        self.estimate(estimate.state, report, reason)
    }

    fn estimate(
        &self,
        state: SVector<f64, N>,
        report: Report<N>,
        doubt: Option<Doubt>,
    ) -> Option<PlanarEstimate<N>> {
        PlanarEstimate::new(self.newton.as_ref()?, self.base, state, report, doubt)
    }
}
