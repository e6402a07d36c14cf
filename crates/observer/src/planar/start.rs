//! A start without a guess: the velocity residuals, quadratic in the five unknowns of the motion.

use super::error::PlanarEstimateError;
use super::force_driven::ForceDriven;
use super::input::{PairInput, PairStage};
use crate::{Model, ObserverError};
use glam::DVec2;
use nalgebra::{SMatrix, SVector};

/// `(cm, v, omega0)`.
type Motion = SVector<f64, 5>;

/// Angular velocities tried when there is no guess, in units of the natural rate.
const TRIED_RATES: [f64; 9] = [0.0, 0.25, -0.25, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0];
/// Levenberg-Marquardt iterations a start.
const ITERATIONS: usize = 60;
/// Stop when a step is below this share of the natural scales: far below what the start is good for.
const STEP_TOLERANCE: f64 = 1e-9;

/// Relative step of the differences by which constants enter the gradient.
const CONSTANT_STEP: f64 = 1e-6;

/// A constant that is wrong by its natural size costs as much as residuals of this share of the natural speed.
const CONSTANT_SHARE: f64 = 1e-3;

/// State at the first sample, from the velocity residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualStart<const N: usize> {
    /// `(cm, v, omega0)` at the first sample, and the constants.
    pub state: SVector<f64, N>,
    /// Root mean square of the velocity residuals, m/s.
    pub residual: f64,
    /// Starts that were tried: one with a guess, nine without.
    pub starts: usize,
}

/// One sample with the motion that follows from the unknown start `(cm0, v0, omega00)` affinely:
/// `cm = cm0 + v0 t + fall`, `v = v0 + speed`, `omega0 = omega00 + turn . cm0 + swing . v0 + spin`.
#[derive(Clone, Copy)]
struct Row {
    stage: PairStage,
    t: f64,
    fall: DVec2,
    speed: DVec2,
    turn: DVec2,
    swing: DVec2,
    spin: f64,
}

/// Start of the motion from measured contacts and forces, without a guess or from a very bad one.
///
/// With the offsets `d_i` taken from the contact readings (`d_1 = u_1 . cm - s_1`, `d_2 = s_2 - u_2 . cm`) the motion is an
/// affine function of its five start values, computed once; what is left are the velocity residuals of rigid contact
/// `E_1 = n_1 . v - (u_1 . cm - s_1) omega0 - s_1 W_1` and `E_2 = n_2 . v - (s_2 - u_2 . cm) omega0 + s_2 W_2`, quadratic in the
/// unknowns, and are minimised by Levenberg-Marquardt. Readings are on both sides of these equations, so with noise the
/// result is biased (errors in variables): it starts a final estimate and never is one.
///
/// # Errors
/// [`ObserverError::TooFewSamples`] below eight samples.
pub fn residual_start<const N: usize>(
    model: &ForceDriven<N>,
    inputs: &[PairInput],
    guess: Option<Motion>,
) -> Result<ResidualStart<N>, PlanarEstimateError> {
    if inputs.len() < 8 {
        return Err(ObserverError::TooFewSamples { found: inputs.len(), needed: 8 }.into());
    }
    let scale = model.scale();
    let (mut best, mut lowest, mut starts) = (SVector::<f64, N>::zeros(), f64::INFINITY, 0);
    let neutral =
        TRIED_RATES.map(|rate| neutral_start(&inputs[0].stages[2], scale.length, rate * scale.rate()));
    let candidates = guess.as_ref().map_or(neutral.as_slice(), std::slice::from_ref);
    for candidate in candidates {
        starts += 1;
        let mut start = SVector::<f64, N>::zeros();
        start.fixed_rows_mut::<5>(0).copy_from(candidate);
        let (state, cost) = minimise(model, inputs, &start);
        if cost < lowest {
            (best, lowest) = (state, cost);
        }
    }
    let residual = (lowest / (2 * inputs.len()) as f64).sqrt();
    Ok(ResidualStart { state: best, residual, starts })
}

/// A disc of the natural size that turns at `omega0` where the contacts are.
pub(super) fn neutral_start(stage: &PairStage, radius: f64, omega0: f64) -> Motion {
    let [u1, u2] = stage.along;
    // sin phi2, positive for any pair of palms.
    let sin = u1.perp_dot(u2);
    let [s1, s2] = stage.contacts;
    let cm = (u2 + u1) * (radius / sin);
    let v = (u2 * (s1 * stage.rates[0]) - u1 * (s2 * stage.rates[1])) / sin;
    Motion::new(cm.x, cm.y, v.x, v.y, omega0)
}

/// Affine propagation by Simpson's rule over each interval.
fn propagate<const N: usize>(model: &ForceDriven<N>, inputs: &[PairInput], x: &SVector<f64, N>) -> Vec<Row> {
    let (mass, inertia) = model.mass_and_inertia(x);
    let gravity = DVec2::new(0.0, -model.nominal().gravity);
    let pull = |s: &PairStage| (s.normals[0] * s.forces[0] + s.normals[1] * s.forces[1]) / mass + gravity;
    let lever = |s: &PairStage| (s.along[1] * s.forces[1] - s.along[0] * s.forces[0]) / inertia;
    let torque = |s: &PairStage| (s.forces[0] * s.contacts[0] - s.forces[1] * s.contacts[1]) / inertia;
    let mut rows: Vec<Row> = Vec::with_capacity(inputs.len());
    let zero = DVec2::ZERO;
    let mut now = Row {
        stage: inputs[0].stages[2],
        t: 0.0,
        fall: zero,
        speed: zero,
        turn: zero,
        swing: zero,
        spin: 0.0,
    };
    rows.push(now);
    for input in &inputs[1..] {
        let (h, stages) = (input.dt, input.stages.map(|stage| model.corrected(x, &stage)));
        let [a, b, c] = &stages;
        let acceleration = [pull(a), pull(b), pull(c)];
        let middle = now.fall + now.speed * (0.5 * h) + acceleration[0] * (h * h / 8.0);
        let fall = now.fall + now.speed * h + (acceleration[0] + acceleration[1] * 2.0) * (h * h / 6.0);
        let levers = [lever(a), lever(b), lever(c)];
        let times = [now.t, now.t + 0.5 * h, now.t + h];
        let falls = [now.fall, middle, fall];
        for (i, (stage, weight)) in stages.iter().zip([1.0, 4.0, 1.0]).enumerate() {
            let share = weight * h / 6.0;
            now.speed += acceleration[i] * share;
            now.turn += levers[i] * share;
            now.swing += levers[i] * (share * times[i]);
            now.spin += share * (levers[i].dot(falls[i]) + torque(stage));
        }
        (now.fall, now.t, now.stage) = (fall, times[2], *c);
        rows.push(now);
    }
    rows
}

/// Both residuals of a row and their gradients with respect to the motion.
fn residuals(row: &Row, x: &Motion) -> [(f64, Motion); 2] {
    let (cm0, v0) = (DVec2::new(x[0], x[1]), DVec2::new(x[2], x[3]));
    let cm = cm0 + v0 * row.t + row.fall;
    let v = v0 + row.speed;
    let omega0 = x[4] + row.turn.dot(cm0) + row.swing.dot(v0) + row.spin;
    [0, 1].map(|i| {
        let (u, n, s, w) =
            (row.stage.along[i], row.stage.normals[i], row.stage.contacts[i], row.stage.rates[i]);
        // d_1 = u_1 . cm - s_1, d_2 = s_2 - u_2 . cm, and the palm's own motion is s_1 W_1, -s_2 W_2.
        let sign = if i == 0 { 1.0 } else { -1.0 };
        let d = sign * (u.dot(cm) - s);
        let residual = n.dot(v) - d * omega0 - sign * s * w;
        let by_cm = -u * (sign * omega0) - row.turn * d;
        let by_v = n - u * (sign * omega0 * row.t) - row.swing * d;
        (residual, Motion::new(by_cm.x, by_cm.y, by_v.x, by_v.y, -d))
    })
}

/// Residuals of all rows at a state, with gradients in units of `scales`.
fn evaluate<const N: usize>(
    model: &ForceDriven<N>,
    inputs: &[PairInput],
    x: &SVector<f64, N>,
    scales: &SVector<f64, N>,
) -> Vec<(f64, SVector<f64, N>)> {
    let motion = x.fixed_rows::<5>(0).into_owned();
    let rows = propagate(model, inputs, x);
    let mut out: Vec<_> = rows
        .iter()
        .flat_map(|row| residuals(row, &motion))
        .map(|(e, slope)| {
            let gradient = SVector::<f64, N>::from_fn(|i, _| if i < 5 { slope[i] * scales[i] } else { 0.0 });
            (e, gradient)
        })
        .collect();
    for constant in 5..N {
        let mut moved = *x;
        moved[constant] += CONSTANT_STEP * scales[constant];
        let rows = propagate(model, inputs, &moved);
        for (entry, (e, _)) in out.iter_mut().zip(rows.iter().flat_map(|row| residuals(row, &motion))) {
            entry.1[constant] = (e - entry.0) / CONSTANT_STEP;
        }
    }
    out
}

fn cost<const N: usize>(model: &ForceDriven<N>, inputs: &[PairInput], x: &SVector<f64, N>) -> f64 {
    let motion = x.fixed_rows::<5>(0).into_owned();
    let rows = propagate(model, inputs, x);
    let data: f64 = rows.iter().flat_map(|row| residuals(row, &motion)).map(|(e, _)| e * e).sum();
    let scales = model.scales();
    let weight = constant_weight(model, inputs);
    data + (5..N).map(|i| weight * (x[i] / scales[i]).powi(2)).sum::<f64>()
}

/// Weight that keeps constants near their nominal values where the residuals do not determine them.
fn constant_weight<const N: usize>(model: &ForceDriven<N>, inputs: &[PairInput]) -> f64 {
    inputs.len() as f64 * (CONSTANT_SHARE * model.scale().speed()).powi(2)
}

/// Levenberg-Marquardt in natural units.
fn minimise<const N: usize>(
    model: &ForceDriven<N>,
    inputs: &[PairInput],
    start: &SVector<f64, N>,
) -> (SVector<f64, N>, f64) {
    let scales = model.scales();
    let (mut x, mut current, mut damping) = (*start, cost(model, inputs, start), 1e-3);
    for _ in 0..ITERATIONS {
        let mut matrix = SMatrix::<f64, N, N>::zeros();
        let mut gradient = SVector::<f64, N>::zeros();
        for (e, slope) in evaluate(model, inputs, &x, &scales) {
            matrix += slope * slope.transpose();
            gradient += slope * e;
        }
        let weight = constant_weight(model, inputs);
        for i in 5..N {
            matrix[(i, i)] += weight;
            gradient[i] += weight * x[i] / scales[i];
        }
        let size = matrix.trace().max(f64::MIN_POSITIVE);
        let step = loop {
            let damped = matrix + SMatrix::identity() * (damping * size);
            let step = damped.cholesky().map(|c| -c.solve(&gradient));
            let trial = step.map_or(x, |s| x + s.component_mul(&scales));
            let trial_cost = cost(model, inputs, &trial);
            if let Some(step) = step
                && trial_cost <= current
            {
                (x, current) = (trial, trial_cost);
                damping = (damping * 0.1).max(1e-15);
                break step;
            }
            damping *= 10.0;
            if damping > 1e6 {
                return (x, current);
            }
        };
        if step.amax() < STEP_TOLERANCE {
            break;
        }
    }
    (x, current)
}
