//! Shape and motion from contacts and palm angles alone: no forces, no mass.

mod evidence;
mod integrate;
mod model;
mod palm_series;
mod scale;

use super::error::PlanarEstimateError;
use crate::{ObserverError, Status};
use contact_kinematics::planar::{FourierBody, ShapeError};
use integrate::Normal;
use model::PalmInstant;
use nalgebra::{DMatrix, DVector};
use object_dynamics::planar::{PlanarLog, PlanarSample};
use palm_series::palm_series;
use scale::NaturalScale;

/// Parameters before the Fourier coefficients: angular velocity, logarithm of the squared radius of gyration.
const MOTION: usize = 2;
/// Prior deviation of harmonic `k >= 1` as a share of the natural length, over `k^2`: a convex body has `|c_k| < a_0 / (k^2-1)`.
const HARMONIC_SHARE: f64 = 0.5;
/// Prior deviation of the mean radius as a share of the natural length.
const RADIUS_SHARE: f64 = 0.5;
/// Prior deviation of the logarithm of the squared radius of gyration: a factor of 2.7 either way.
const GYRATION_DEVIATION: f64 = 1.0;
/// Prior deviation of the angular velocity in natural rates.
const RATE_DEVIATION: f64 = 3.0;
/// Angular velocities tried, in natural rates.
const TRIED_RATES: [f64; 9] = [0.0, 0.2, -0.2, 0.45, -0.45, 0.9, -0.9, 1.8, -1.8];
/// First window in natural times, and growth from one to the next.
const FIRST_WINDOW: f64 = 2.0;
const GROWTH: f64 = 1.5;
/// Noise assumed in the first window as a share of the natural length; it falls to the stated one as the window grows.
const FIRST_NOISE: f64 = 0.01;
/// Levenberg-Marquardt iterations per window.
const ITERATIONS: usize = 30;
/// Chi-squared above the best at which a start is given up: wide while the window is short, 3 standard deviations at the end.
const EARLY_MARGIN: f64 = 25.0;
const FINAL_MARGIN: f64 = 9.0;
/// The highest harmonic that is tried. The prior lets the radius have a hundredth of its mean there, and noise of a thousandth has it below.
const MOST_HARMONICS: usize = 16;
/// A step below this share of the prior deviations ends a window.
const STEP_TOLERANCE: f64 = 1e-9;

/// What the shape estimator takes as known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeFitOptions {
    /// Highest harmonic of the radius function to begin with; more are added while noise does not explain what is left.
    pub order: usize,
    /// Standard deviation of a contact reading, m.
    pub contact_deviation: f64,
    /// Gravity, m/s^2.
    pub gravity: f64,
}

/// Shape and motion, from contacts and palm angles.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeFit {
    /// Cosine coefficients of the radius function, m; body axes are those of the world at the first sample.
    pub cosines: Vec<f64>,
    /// Sine coefficients, m.
    pub sines: Vec<f64>,
    /// Squared radius of gyration, m^2, and its standard deviation.
    pub gyration_squared: (f64, f64),
    /// Angular velocity at the first sample, rad/s, and its standard deviation.
    pub omega0: (f64, f64),
    /// Orientation against the first sample (rad) and angular velocity (rad/s) at each sample.
    pub motion: Vec<[f64; 2]>,
    /// Radius functions at the contacts of each sample, m.
    pub radii: Vec<[f64; 2]>,
    /// Covariance of `(omega0, log gyration^2, a_0, a_1, b_1, ...)`, prior included.
    pub covariance: DMatrix<f64>,
    /// Root mean square residual in units of the noise.
    pub residual: f64,
    /// What is left against what noise leaves, as a standard normal: beyond [`ShapeFit::UNEXPLAINED`] the order was too low even at the
    /// end, or something else than noise is wrong.
    pub excess: f64,
    /// How the estimate stands.
    pub status: Status,
    /// Smallest eigenvalue of the data's information in units of the prior's: below one the prior says more than the data.
    pub smallest_information: f64,
    /// That direction in words.
    pub direction: String,
    /// Linearisations made.
    pub iterations: usize,
}

impl ShapeFit {
    /// What noise alone exceeds once in a thousand logs.
    pub const UNEXPLAINED: f64 = 3.09;

    /// The shape as a body, which proves it convex.
    ///
    /// # Errors
    /// [`ShapeError::NotConvex`] when the estimate is not.
    pub fn body(&self) -> Result<FourierBody, ShapeError> {
        FourierBody::new(&self.cosines, &self.sines)
    }
}

/// Chi-squared and parameters.
type Candidate = (f64, DVector<f64>);

/// Data and prior of a fit.
struct Problem<'a> {
    samples: &'a [PlanarSample],
    palms: Vec<PalmInstant>,
    options: ShapeFitOptions,
    centre: DVector<f64>,
    deviations: DVector<f64>,
}

/// Estimates shape and motion from contacts and palm angles alone: the finite-dimensional alternative to torques.
///
/// The unknowns are the start of the motion, the radius of gyration and the Fourier coefficients of the radius function; the
/// prescribed-palm dynamics predict both contacts, with variational sensitivities. The problem is not convex, so the window
/// grows from two natural times to the whole log and the assumed noise falls along (annealing), from a disc of the natural
/// size that turns at each of nine rates. Mass does not enter: only the radius of gyration can be seen without forces.
///
/// Where what is left over the whole log is more than noise leaves once in a thousand logs (chi-squared test), one more harmonic is
/// added to what was found, up to sixteen. What is left then is reported as inconsistent.
///
/// # Errors
/// [`PlanarEstimateError`]: lost contact, too few samples, unusable numbers.
pub fn fit_shape(log: &PlanarLog, options: &ShapeFitOptions) -> Result<ShapeFit, PlanarEstimateError> {
    let problem = Problem::new(log, options)?;
    let scale = NaturalScale::from_sample(&log.samples()[0], options.gravity)?;
    let windows = problem.windows(&scale);
    let mut iterations = 0;
    let early = windows.len().min(3);
    let mut candidates: Vec<Candidate> = Vec::new();
    for rate in TRIED_RATES {
        let mut x = problem.centre.clone();
        x[0] = rate * scale.rate();
        let mut cost = f64::INFINITY;
        for &(count, noise) in &windows[..early] {
            (x, cost) = problem.minimise(x, count, noise, &mut iterations);
        }
        candidates.push((cost, x));
    }
    let kept = rivals(candidates, EARLY_MARGIN, 3);
    let later = &windows[early..];
    let finals = kept.into_iter().map(|(mut cost, mut x)| {
        for &(count, noise) in later {
            (x, cost) = problem.minimise(x, count, noise, &mut iterations);
        }
        (cost, x)
    });
    let mut finals = rivals(finals.collect(), FINAL_MARGIN, 1);
    let mut fit = problem.finish(&finals, iterations);
    let mut order = options.order;
    while fit.excess > ShapeFit::UNEXPLAINED
        && order < MOST_HARMONICS
        && log.samples().len() > least(order + 1)
    {
        order += 1;
        let wider = Problem::new(log, &ShapeFitOptions { order, ..*options })?;
        let more = finals.iter().map(|(_, x)| {
            let start = DVector::from_fn(MOTION + 1 + 2 * order, |j, _| x.get(j).copied().unwrap_or(0.0));
            let (x, cost) =
                wider.minimise(start, log.samples().len(), options.contact_deviation, &mut iterations);
            (cost, x)
        });
        finals = rivals(more.collect(), FINAL_MARGIN, 1);
        fit = wider.finish(&finals, iterations);
    }
    Ok(fit)
}

/// The fewest samples for so many harmonics.
fn least(order: usize) -> usize {
    (MOTION + 1 + 2 * order).max(8)
}

/// Sorts by cost and keeps those within `margin` of the best, at least `fewest`.
fn rivals(mut list: Vec<Candidate>, margin: f64, fewest: usize) -> Vec<Candidate> {
    list.sort_by(|a, b| a.0.total_cmp(&b.0));
    let limit = list.first().map_or(0.0, |best| best.0 + margin);
    let close = list.partition_point(|c| c.0 <= limit);
    list.truncate(close.max(fewest));
    list
}

impl<'a> Problem<'a> {
    fn new(log: &'a PlanarLog, options: &ShapeFitOptions) -> Result<Self, PlanarEstimateError> {
        let samples = log.samples();
        let ShapeFitOptions { order, contact_deviation, gravity } = *options;
        if !(contact_deviation > 0.0 && contact_deviation.is_finite()) {
            let needed = "positive and finite";
            return Err(PlanarEstimateError::Value {
                what: "contact deviation",
                value: contact_deviation,
                needed,
            });
        }
        let needed = least(order);
        if samples.len() < needed {
            return Err(ObserverError::TooFewSamples { found: samples.len(), needed }.into());
        }
        if let Some((sample, palm)) = log.first_contact_loss() {
            return Err(PlanarEstimateError::LostContact { palm: palm + 1, t: samples[sample].t });
        }
        let scale = NaturalScale::from_sample(&samples[0], gravity)?;
        let count = MOTION + 1 + 2 * order;
        let mut centre = DVector::zeros(count);
        // A uniform disc has the squared radius of gyration R^2 / 2.
        centre[1] = (0.5 * scale.length * scale.length).ln();
        centre[2] = scale.length;
        let deviations = DVector::from_fn(count, |j, _| match j {
            0 => RATE_DEVIATION * scale.rate(),
            1 => GYRATION_DEVIATION,
            2 => RADIUS_SHARE * scale.length,
            _ => HARMONIC_SHARE * scale.length / ((j - 1) / 2).pow(2) as f64,
        });
        Ok(Self { samples, palms: palm_series(samples), options: *options, centre, deviations })
    }

    /// Sample counts and assumed noise of the growing windows.
    fn windows(&self, scale: &NaturalScale) -> Vec<(usize, f64)> {
        let all = self.samples.len();
        let total = self.samples[all - 1].t - self.samples[0].t;
        let stated = self.options.contact_deviation;
        let mut time = FIRST_WINDOW * scale.time();
        let mut noise = (FIRST_NOISE * scale.length).max(stated);
        let mut out = Vec::new();
        while time < total {
            let count = self.samples.partition_point(|s| s.t - self.samples[0].t <= time);
            out.push((count.max(8).min(all), noise));
            time *= GROWTH;
            noise = (0.3 * noise).max(stated);
        }
        while noise > stated {
            out.push((all, noise));
            noise = (0.1 * noise).max(stated);
        }
        out.push((all, stated));
        out
    }

    fn prior_offset(&self, x: &DVector<f64>) -> DVector<f64> {
        (&self.centre - x).component_div(&self.deviations)
    }

    /// Levenberg-Marquardt over one window; returns the point and its chi-squared, prior included.
    fn minimise(
        &self,
        start: DVector<f64>,
        count: usize,
        noise: f64,
        iterations: &mut usize,
    ) -> (DVector<f64>, f64) {
        let cost = |n: &Normal, x: &DVector<f64>| n.squares + self.prior_offset(x).norm_squared();
        let Some(mut normal) = self.normal(&start, count, noise) else { return (start, f64::INFINITY) };
        let (mut x, mut damping) = (start, 1e-3);
        let mut current = cost(&normal, &x);
        for _ in 0..ITERATIONS {
            *iterations += 1;
            let gradient = &normal.vector + self.prior_offset(&x);
            let damped = &normal.matrix + DMatrix::from_diagonal_element(x.len(), x.len(), 1.0 + damping);
            let Some(step) = damped.cholesky().map(|c| c.solve(&gradient)) else { break };
            let trial = &x + step.component_mul(&self.deviations);
            let trial_normal = self.normal(&trial, count, noise);
            match trial_normal.map(|n| (cost(&n, &trial), n)).filter(|(c, _)| *c <= current) {
                Some((lower, n)) => {
                    let small = step.amax() < STEP_TOLERANCE || current - lower < 1e-9 * current;
                    (x, normal, current) = (trial, n, lower);
                    damping *= 0.1;
                    if small {
                        break;
                    }
                }
                None => damping = (damping * 10.0).max(1e-3),
            }
            if damping > 1e12 {
                break;
            }
        }
        (x, current)
    }
}
