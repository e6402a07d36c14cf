//! A start without a guess: the velocity residuals, quadratic in the five unknowns of the motion.

use super::constants::PlanarNominal;
use super::error::PlanarEstimateError;
use super::input::{PairInput, PairStage};
use super::scale::NaturalScale;
use crate::ObserverError;
use glam::DVec2;
use nalgebra::{SMatrix, SVector};

type State = SVector<f64, 5>;

/// Angular velocities tried when there is no guess, in units of the natural rate.
const TRIED_RATES: [f64; 9] = [0.0, 0.25, -0.25, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0];
/// Levenberg-Marquardt iterations a start.
const ITERATIONS: usize = 60;
/// Stop when a step is below this share of the natural scales: far below what the start is good for.
const STEP_TOLERANCE: f64 = 1e-9;

/// Motion at the first sample, from the velocity residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualStart {
    /// `(cm, v, omega0)` at the first sample.
    pub state: State,
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
pub fn residual_start(
    nominal: &PlanarNominal,
    scale: NaturalScale,
    inputs: &[PairInput],
    guess: Option<State>,
) -> Result<ResidualStart, PlanarEstimateError> {
    if inputs.len() < 8 {
        return Err(ObserverError::TooFewSamples { found: inputs.len(), needed: 8 }.into());
    }
    let rows = propagate(nominal, inputs);
    let scales = State::new(scale.length, scale.length, scale.speed(), scale.speed(), scale.rate());
    let (mut best, mut lowest, mut starts) = (State::zeros(), f64::INFINITY, 0);
    let neutral =
        TRIED_RATES.map(|rate| neutral_start(&inputs[0].stages[2], scale.length, rate * scale.rate()));
    let candidates = guess.as_ref().map_or(neutral.as_slice(), std::slice::from_ref);
    for candidate in candidates {
        starts += 1;
        let (state, cost) = minimise(&rows, candidate, &scales);
        if cost < lowest {
            (best, lowest) = (state, cost);
        }
    }
    let residual = (lowest / (2 * rows.len()) as f64).sqrt();
    Ok(ResidualStart { state: best, residual, starts })
}

/// A disc of the natural size that turns at `omega0` where the contacts are.
pub(super) fn neutral_start(stage: &PairStage, radius: f64, omega0: f64) -> State {
    let [u1, u2] = stage.along;
    // sin phi2, positive for any pair of palms.
    let sin = u1.perp_dot(u2);
    let [s1, s2] = stage.contacts;
    let cm = (u2 + u1) * (radius / sin);
    let v = (u2 * (s1 * stage.rates[0]) - u1 * (s2 * stage.rates[1])) / sin;
    State::new(cm.x, cm.y, v.x, v.y, omega0)
}

/// Affine propagation by Simpson's rule over each interval.
fn propagate(nominal: &PlanarNominal, inputs: &[PairInput]) -> Vec<Row> {
    let (mass, inertia) = (nominal.mass.mass(), nominal.mass.inertia());
    let gravity = DVec2::new(0.0, -nominal.gravity);
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
        let (h, [a, b, c]) = (input.dt, &input.stages);
        let acceleration = [pull(a), pull(b), pull(c)];
        let middle = now.fall + now.speed * (0.5 * h) + acceleration[0] * (h * h / 8.0);
        let fall = now.fall + now.speed * h + (acceleration[0] + acceleration[1] * 2.0) * (h * h / 6.0);
        let levers = [lever(a), lever(b), lever(c)];
        let times = [now.t, now.t + 0.5 * h, now.t + h];
        let falls = [now.fall, middle, fall];
        for (i, (stage, weight)) in input.stages.iter().zip([1.0, 4.0, 1.0]).enumerate() {
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

/// Both residuals of a row and their gradients.
fn residuals(row: &Row, x: &State) -> [(f64, State); 2] {
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
        (residual, State::new(by_cm.x, by_cm.y, by_v.x, by_v.y, -d))
    })
}

fn cost(rows: &[Row], x: &State) -> f64 {
    rows.iter().flat_map(|row| residuals(row, x)).map(|(e, _)| e * e).sum()
}

/// Levenberg-Marquardt in natural units.
fn minimise(rows: &[Row], start: &State, scales: &State) -> (State, f64) {
    let (mut x, mut current, mut damping) = (*start, cost(rows, start), 1e-3);
    for _ in 0..ITERATIONS {
        let mut matrix = SMatrix::<f64, 5, 5>::zeros();
        let mut gradient = State::zeros();
        for (e, slope) in rows.iter().flat_map(|row| residuals(row, &x)) {
            let slope = slope.component_mul(scales);
            matrix += slope * slope.transpose();
            gradient += slope * e;
        }
        let size = matrix.trace().max(f64::MIN_POSITIVE);
        let step = loop {
            let damped = matrix + SMatrix::identity() * (damping * size);
            let step = damped.cholesky().map(|c| -c.solve(&gradient));
            let trial = step.map_or(x, |s| x + s.component_mul(scales));
            let trial_cost = cost(rows, &trial);
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
