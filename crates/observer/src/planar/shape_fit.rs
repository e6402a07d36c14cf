//! Shape and motion from contacts and palm angles alone: no forces, no mass.

use super::error::PlanarEstimateError;
use super::palm_series::palm_series;
use super::scale::NaturalScale;
use super::shape_model::{Contacts, PalmInstant, reaction};
use crate::{ObserverError, Status};
use contact_kinematics::planar::{FourierBody, ShapeError};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use object_dynamics::planar::{PlanarLog, PlanarSample};

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
/// Residual beyond which the noise does not explain the data.
const CONSISTENT_RESIDUAL: f64 = 3.0;
/// Chi-squared above the best at which a start is given up: wide while the window is short, 3 standard deviations at the end.
const EARLY_MARGIN: f64 = 25.0;
const FINAL_MARGIN: f64 = 9.0;
/// A step below this share of the prior deviations ends a window.
const STEP_TOLERANCE: f64 = 1e-9;

/// What the shape estimator takes as known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeFitOptions {
    /// Highest harmonic of the radius function.
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

/// Normal equations about a point, in units of the prior's deviations; the prior is not in them.
struct Normal {
    matrix: DMatrix<f64>,
    vector: DVector<f64>,
    squares: f64,
    motion: Vec<[f64; 2]>,
    radii: Vec<[f64; 2]>,
}

/// Estimates shape and motion from contacts and palm angles alone: the finite-dimensional alternative to torques.
///
/// The unknowns are the start of the motion, the radius of gyration and the Fourier coefficients of the radius function; the
/// prescribed-palm dynamics predict both contacts, with variational sensitivities. The problem is not convex, so the window
/// grows from two natural times to the whole log and the assumed noise falls along (annealing), from a disc of the natural
/// size that turns at each of nine rates. Mass does not enter: only the radius of gyration can be seen without forces.
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
    let finals = rivals(finals.collect(), FINAL_MARGIN, 1);
    Ok(problem.finish(&finals, iterations))
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
        let needed = (MOTION + 1 + 2 * order).max(8);
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

    /// Integrates over `count` samples; none where the motion leaves the numbers.
    fn normal(&self, x: &DVector<f64>, count: usize, noise: f64) -> Option<Normal> {
        let parameters = x.len();
        let mut out = Normal {
            matrix: DMatrix::zeros(parameters, parameters),
            vector: DVector::zeros(parameters),
            squares: 0.0,
            motion: Vec::with_capacity(count),
            radii: Vec::with_capacity(count),
        };
        let mut contacts = Contacts::new(self.options.order);
        let mut state = State { values: [0.0, x[0]], by: DMatrix::zeros(parameters, 2) };
        state.by[(0, 1)] = self.deviations[0];
        let mut rows = DMatrix::zeros(parameters, 2);
        for k in 0..count {
            if k > 0 {
                let h = self.samples[k].t - self.samples[k - 1].t;
                let stages = [self.palms[2 * k - 2], self.palms[2 * k - 1], self.palms[2 * k]];
                state = self.step(&state, x, h, &stages, &mut contacts);
            }
            contacts.set(&x.as_slice()[MOTION..], &self.palms[2 * k], state.values[0], state.values[1]);
            let here = reaction(&self.palms[2 * k], self.options.gravity, x[1].exp(), &contacts.values);
            for i in 0..2 {
                let measured = self.samples[k].contacts[i]?;
                let residual = (measured - here.contacts[i]) / noise;
                out.squares += residual * residual;
                let gradient = &here.contacts_by[i];
                let by_phi = gradient.dot(&contacts.by_phi);
                for j in 0..parameters {
                    let own = if j < MOTION { 0.0 } else { contacts.by_coefficient(gradient, j - MOTION) };
                    rows[(j, i)] = (own * self.deviations[j] + by_phi * state.by[(j, 0)]) / noise;
                }
                out.vector.axpy(residual, &rows.column(i), 1.0);
            }
            out.matrix.gemm(1.0, &rows, &rows.transpose(), 1.0);
            out.motion.push(state.values);
            out.radii.push([contacts.values[0], contacts.values[3]]);
        }
        out.squares.is_finite().then_some(out)
    }

    /// Rates of the state and of its sensitivities (in units of the prior's deviations).
    fn rate(&self, state: &State, x: &DVector<f64>, palms: &PalmInstant, contacts: &mut Contacts) -> State {
        contacts.set(&x.as_slice()[MOTION..], palms, state.values[0], state.values[1]);
        let gyration = x[1].exp();
        let here = reaction(palms, self.options.gravity, gyration, &contacts.values);
        let by_phi = here.by_contact.dot(&contacts.by_phi);
        let by_omega = here.by_contact[6];
        let by = DMatrix::from_fn(x.len(), 2, |j, part| {
            if part == 0 {
                return state.by[(j, 1)];
            }
            let own = match j {
                0 => 0.0,
                1 => here.by_gyration * gyration,
                _ => contacts.by_coefficient(&here.by_contact, j - MOTION),
            };
            own * self.deviations[j] + by_phi * state.by[(j, 0)] + by_omega * state.by[(j, 1)]
        });
        State { values: [state.values[1], here.alpha], by }
    }

    fn step(
        &self,
        state: &State,
        x: &DVector<f64>,
        h: f64,
        stages: &[PalmInstant; 3],
        contacts: &mut Contacts,
    ) -> State {
        let k1 = self.rate(state, x, &stages[0], contacts);
        let k2 = self.rate(&state.moved(&k1, 0.5 * h), x, &stages[1], contacts);
        let k3 = self.rate(&state.moved(&k2, 0.5 * h), x, &stages[1], contacts);
        let k4 = self.rate(&state.moved(&k3, h), x, &stages[2], contacts);
        state.moved(&k1, h / 6.0).moved(&k2, h / 3.0).moved(&k3, h / 3.0).moved(&k4, h / 6.0)
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

    /// Evidence about the best of `finals`. Others that explain the data as well widen the covariance: the linear one knows
    /// only its own valley.
    fn finish(&self, finals: &[Candidate], iterations: usize) -> ShapeFit {
        let x = finals.first().map_or(&self.centre, |best| &best.1);
        let all = self.samples.len();
        let count = x.len();
        let normal = self.normal(x, all, self.options.contact_deviation);
        let (matrix, squares, motion, radii) = match normal {
            Some(n) => (n.matrix, n.squares, n.motion, n.radii),
            None => (DMatrix::zeros(count, count), f64::NAN, Vec::new(), Vec::new()),
        };
        let eigen = SymmetricEigen::new(matrix);
        let lowest = eigen.eigenvalues.imin();
        let inner = eigen.eigenvalues.map(|v| 1.0 / (1.0 + v.max(0.0)));
        let scaled = &eigen.eigenvectors * DMatrix::from_diagonal(&inner) * eigen.eigenvectors.transpose();
        let mut covariance =
            DMatrix::from_fn(count, count, |i, j| scaled[(i, j)] * self.deviations[i] * self.deviations[j]);
        for (_, rival) in finals.iter().skip(1) {
            let away = rival - x;
            covariance += &away * away.transpose();
        }
        // Some direction is free, and the search over many starts has then fitted noise along it (as a disc's turn rate to the
        // strongest ripple): nothing beyond the prior is claimed.
        if eigen.eigenvalues[lowest] < 1.0 {
            let away = &self.centre - x;
            covariance = DMatrix::from_diagonal(&self.deviations.component_mul(&self.deviations));
            covariance += &away * away.transpose();
        }
        let residual = (squares / (2 * all) as f64).sqrt();
        let smallest_information = eigen.eigenvalues[lowest].max(0.0);
        let status = if !residual.is_finite() {
            Status::Diverged
        } else if smallest_information < 1.0 {
            Status::NotObservable
        } else if residual > CONSISTENT_RESIDUAL {
            Status::Inconsistent
        } else {
            Status::Converged
        };
        let deviation = |j: usize| covariance[(j, j)].sqrt();
        let gyration = x[1].exp();
        let harmonics = |part: usize| (1..=self.options.order).map(move |k| 2 * k + part);
        let mut cosines = vec![x[2]];
        cosines.extend(harmonics(1).map(|j| x[j]));
        let mut sines = vec![0.0];
        sines.extend(harmonics(2).map(|j| x[j]));
        ShapeFit {
            cosines,
            sines,
            gyration_squared: (gyration, gyration * deviation(1)),
            omega0: (x[0], deviation(0)),
            motion,
            radii,
            residual,
            status,
            smallest_information,
            direction: describe(&eigen.eigenvectors.column(lowest).into_owned()),
            iterations,
            covariance,
        }
    }
}

/// State `(phi0, omega0)` and its sensitivities, one row a parameter.
struct State {
    values: [f64; 2],
    by: DMatrix<f64>,
}

impl State {
    fn moved(&self, rate: &State, h: f64) -> State {
        let mut by = self.by.clone();
        by.zip_apply(&rate.by, |a, b| *a += h * b);
        State { values: [0, 1].map(|i| self.values[i] + h * rate.values[i]), by }
    }
}

fn name(j: usize) -> String {
    match j {
        0 => "angular velocity".to_owned(),
        1 => "log squared radius of gyration".to_owned(),
        2 => "mean radius".to_owned(),
        _ => format!("{} of harmonic {}", if j % 2 == 1 { "cosine" } else { "sine" }, (j - 1) / 2),
    }
}

fn describe(direction: &DVector<f64>) -> String {
    let mut order: Vec<usize> = (0..direction.len()).collect();
    order.sort_by(|&i, &j| direction[j].abs().total_cmp(&direction[i].abs()));
    let sign = direction[order[0]].signum();
    let large = order.iter().enumerate().filter(|&(place, &j)| place == 0 || direction[j].abs() > 0.25);
    let parts: Vec<String> =
        large.map(|(_, &j)| format!("{} ({:.2})", name(j), sign * direction[j])).collect();
    parts.join(", ")
}
