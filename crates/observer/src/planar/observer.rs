//! From a stream of planar samples to motion, orientation and shape, with or without a guess.

use super::constants::{Constant, PlanarNominal};
use super::error::PlanarEstimateError;
use super::force_driven::ForceDriven;
use super::input::{InputBuilder, PairInput};
use super::scale::NaturalScale;
use super::start::residual_start;
use crate::{Arrival, BatchOptions, NewtonObserver, NewtonOptions, Report, Start, solve_batch};
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
    /// Standard deviation of each estimated constant before the first sample, in its own unit; none for no knowledge.
    pub constant_deviation: Option<f64>,
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
        Ok(Self {
            nominal,
            constants: constants.to_vec(),
            options,
            builder: InputBuilder::new(),
            waiting: Vec::new(),
            scale: None,
            newton: None,
            base: 0.0,
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
        self.builder.push(sample, |input| waiting.push(input))?;
        if self.newton.is_some() {
            let mut last = None;
            while !self.waiting.is_empty() {
                let input = self.waiting.remove(0);
                last = self.advance(input);
            }
            return Ok(last);
        }
        let (Some(window), Some(first)) = (self.window(), self.waiting.first()) else { return Ok(None) };
        let collected = sample.t - first.t;
        let rounding = 1e-9 * window;
        if collected + rounding < self.options.settle.unwrap_or(window) || self.waiting.len() < FEWEST_SAMPLES
        {
            return Ok(None);
        }
        self.begin(window, collected)
    }

    /// First estimate from the samples that have been collected.
    fn begin(
        &mut self,
        window: f64,
        collected: f64,
    ) -> Result<Option<PlanarEstimate<N>>, PlanarEstimateError> {
        let Some(scale) = self.scale else { return Ok(None) };
        let inputs = std::mem::take(&mut self.waiting);
        let model = ForceDriven::<N>::new(self.nominal, scale, &self.constants)?;
        let mut start = Start::<N>::guess(SVector::zeros());
        if let Some(deviation) = self.options.constant_deviation {
            for i in 5..N {
                start.information[(i, i)] = 1.0 / (deviation * deviation);
            }
        }
        let by_residuals = |guess| residual_start(&self.nominal, scale, &inputs, guess).map(|s| s.state);
        let (motion, polish) = match self.options.start {
            PlanarStartFrom::Nothing => (by_residuals(None)?, true),
            PlanarStartFrom::Guess(guess) => (by_residuals(Some(guess.into()))?, true),
            PlanarStartFrom::Motion(motion) => (motion.into(), false),
        };
        start.state.fixed_rows_mut::<5>(0).copy_from(&motion);
        let samples: Vec<_> = inputs.iter().map(|&input| model.sample(input)).collect();
        if polish {
            let exact = model.clone().without_process_noise();
            start.state = solve_batch(&exact, &samples, &start, &BatchOptions::default())?.states[0];
        }
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
        let estimate = newton.push(*last);
        self.newton = Some(newton);
        Ok(self.estimate(estimate.state, estimate.report))
    }

    fn advance(&mut self, input: PairInput) -> Option<PlanarEstimate<N>> {
        let newton = self.newton.as_mut()?;
        let first_turn = turns(newton).next().unwrap_or(0.0);
        let sample = newton.model().sample(input);
        if newton.is_full() {
            self.base += first_turn;
        }
        let estimate = newton.push(sample);
        self.estimate(estimate.state, estimate.report)
    }

    fn estimate(&self, state: SVector<f64, N>, report: Report<N>) -> Option<PlanarEstimate<N>> {
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
        Some(PlanarEstimate { t: input.t, state, phi0, radii, radius_deviations, contact_points, report })
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
