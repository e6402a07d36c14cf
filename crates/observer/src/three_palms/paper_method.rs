//! The paper's own way: integrate its system (35) to (37) from given initial conditions, by prediction and correction,
//! with the constraints (15) and (24).
//!
//! It is exponentially unstable (errors of the start grow about 1e5-fold over the paper's Fig. 5), takes no force as
//! redundant and never uses Newton's law (30) but in the constraint. It stays as an oracle for data without noise, and
//! on the charts; to estimate, use [`crate::estimate_motion`].

use super::momentum::{MotionState, exponential};
use super::quadrature::{derivative, running_integral};
use super::track::{Node, Track};
use contact_kinematics::{PalmError, PalmTriple, acceleration_defect, contact_curve_rates};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, Matrix3x6, SMatrix, Vector3, Vector6};
use object_dynamics::MassProperties;
use thiserror::Error;

/// Radius functions, rotation and angular velocity: what (35) to (37) integrate.
const STATES: usize = 9;
/// A radius beyond this many times the size of the scene is divergence.
const DIVERGED: f64 = 100.0;
/// Step of the differences by which the constraint and the sensitivity are linearised, in natural sizes: the square
/// root of rounding, where truncation and rounding balance.
const DIFFERENCE: f64 = 1.5e-8;

/// Samples and rounds of Picard's iteration at the start.
const STARTING_NODES: usize = 6;
const STARTING_ROUNDS: usize = 15;

/// Scheme of prediction and correction, of the step of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PredictorCorrector {
    /// Euler predictor, trapezoidal corrector: order 2.
    Heun,
    /// Adams-Bashforth predictor and Adams-Moulton corrector of four steps, each evaluated once: order 4. Needs a
    /// constant sample rate; the first three steps come from Picard's iteration.
    Adams4,
}

/// How to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperMethod {
    /// Scheme.
    pub scheme: PredictorCorrector,
    /// Whether each step is pulled onto the acceleration constraint (24) by the smallest change of radii and angular
    /// velocity. It holds the constraint, and with it needs second differences of the contacts: for clean data only.
    pub enforce_constraint: bool,
}

/// Initial conditions, which the paper assumes to be known (angular velocity) or searches for (radii).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperStart {
    /// Radius functions at the three contacts, m.
    pub radii: [f64; 3],
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Angular velocity, rad/s, world axes.
    pub w_WO: DVec3,
}

/// Why the paper's system cannot be integrated.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum PaperError {
    /// The palms do not determine the centre of mass.
    #[error("at t = {t} s: {source}")]
    Palms {
        /// Time as in the log, s.
        t: f64,
        /// Why.
        source: PalmError,
    },
    /// The initial conditions are not numbers.
    #[error("initial {what} is not finite")]
    NotFinite {
        /// Which.
        what: &'static str,
    },
    /// The four-step scheme needs equal steps.
    #[error(
        "samples {index} and {next} are {step} s apart, the first two {first} s; this scheme needs a constant sample rate"
    )]
    UnevenSamples {
        /// Index of the sample before the uneven step.
        index: usize,
        /// Index after it.
        next: usize,
        /// The step, s.
        step: f64,
        /// The first step, s.
        first: f64,
    },
}

/// What came of the integration.
#[derive(Clone, Debug)]
pub struct PaperReconstruction {
    /// Motion at every sample reached.
    pub motion: Vec<MotionState>,
    /// Radius functions at every sample reached, m.
    pub radii: Vec<[f64; 3]>,
    /// Time as in the log at which the solution left all bounds, if it did.
    pub diverged_at: Option<f64>,
    /// Largest difference of prediction and correction, in natural sizes: the paper's own measure of error.
    pub prediction_gap: f64,
    /// Root mean square of the acceleration constraint (24), m/s^2, before any enforcement: the residual.
    pub constraint_defect: f64,
    /// Derivative of the last state (radii in scene sizes, rotation vector, angular velocity in natural rates) by the
    /// first.
    pub sensitivity: SMatrix<f64, STATES, STATES>,
}

impl PaperReconstruction {
    /// Largest singular value of the sensitivity: how many times an error of the start has grown.
    #[must_use]
    pub fn amplification(&self) -> f64 {
        self.sensitivity.singular_values().max()
    }

    /// Ratio of the largest to the smallest singular value of the sensitivity.
    #[must_use]
    pub fn condition(&self) -> f64 {
        let values = self.sensitivity.singular_values();
        values.max() / values.min()
    }

    /// Covariance of the last state, in the units of the sensitivity, for a given one of the first.
    #[must_use]
    pub fn covariance(&self, start: &SMatrix<f64, STATES, STATES>) -> SMatrix<f64, STATES, STATES> {
        self.sensitivity * start * self.sensitivity.transpose()
    }
}

/// Integrates (35) to (37) along a track from `start`.
///
/// # Errors
/// [`PaperError`]. Divergence is no error but an outcome: see [`PaperReconstruction::diverged_at`].
pub fn integrate_paper_system(
    track: &Track,
    mass: &MassProperties,
    start: &PaperStart,
    method: PaperMethod,
) -> Result<PaperReconstruction, PaperError> {
    if !start.radii.iter().all(|r| r.is_finite()) {
        return Err(PaperError::NotFinite { what: "radius function value" });
    }
    if !(start.R_WO.is_finite() && start.w_WO.is_finite()) {
        return Err(PaperError::NotFinite { what: "orientation or angular velocity" });
    }
    if method.scheme == PredictorCorrector::Adams4 {
        check_spacing(track)?;
    }
    let system = System::new(track, mass)?;
    let first = State { r: DVec3::from_array(start.radii), q: start.R_WO.normalize(), w: start.w_WO };
    let run = system.run(first, method);
    let sensitivity = system.sensitivity(first, method);
    let times: Vec<f64> = track.times().collect();
    let motion = run.states.iter().enumerate().map(|(k, s)| system.motion(times[k], k, s)).collect();
    Ok(PaperReconstruction {
        motion,
        radii: run.states.iter().map(|s| s.r.to_array()).collect(),
        diverged_at: (run.states.len() < track.len()).then(|| times[run.states.len()]),
        prediction_gap: run.gap,
        constraint_defect: (run.defect / run.states.len().max(1) as f64).sqrt(),
        sensitivity,
    })
}

fn check_spacing(track: &Track) -> Result<(), PaperError> {
    let first = track.t[1] - track.t[0];
    let uneven = (1..track.t.len()).find(|&k| (track.t[k] - track.t[k - 1] - first).abs() > 1e-6 * first);
    match uneven {
        Some(k) => {
            let step = track.t[k] - track.t[k - 1];
            Err(PaperError::UnevenSamples { index: k - 1, next: k, step, first })
        }
        None => Ok(()),
    }
}

#[derive(Clone, Copy)]
struct State {
    r: DVec3,
    q: DQuat,
    w: DVec3,
}

/// Rate of a state: of the radii, the quaternion, and the angular velocity.
#[derive(Clone, Copy)]
struct Rate {
    r: DVec3,
    q: DQuat,
    alpha: DVec3,
}

struct Run {
    states: Vec<State>,
    gap: f64,
    defect: f64,
}

struct System<'a> {
    track: &'a Track,
    mass: &'a MassProperties,
    palms: Vec<PalmTriple>,
    /// First and second derivatives of the contact points.
    p_dot_WC: [Vec<DVec3>; 3],
    p_ddot_WC: [Vec<DVec3>; 3],
    length: f64,
    rate: f64,
}

impl<'a> System<'a> {
    fn new(track: &'a Track, mass: &'a MassProperties) -> Result<Self, PaperError> {
        let triple = |(node, t): (&Node, f64)| {
            PalmTriple::new(node.palms.map(|p| p.frame.n)).map_err(|source| PaperError::Palms { t, source })
        };
        let palms = track.nodes.iter().zip(track.times()).map(triple).collect::<Result<Vec<_>, _>>()?;
        let points = |i: usize| track.nodes.iter().map(|n| n.p_WC[i]).collect::<Vec<_>>();
        let p_dot_WC: [Vec<DVec3>; 3] =
            std::array::from_fn(|i| derivative(&track.t, &points(i), DVec3::ZERO));
        let p_ddot_WC = std::array::from_fn(|i| derivative(&track.t, &p_dot_WC[i], DVec3::ZERO));
        let length = track.nodes[0].p_WC.iter().map(|c| c.length()).sum::<f64>() / 3.0;
        let length = if length > 0.0 { length } else { 1.0 };
        let g = track.gravity.length();
        let rate = if g > 0.0 { (g / length).sqrt() } else { 1.0 / track.duration() };
        Ok(Self { track, mass, palms, p_dot_WC, p_ddot_WC, length, rate })
    }

    /// (35) and (37) at sample `k`; the chart-free form of (35) is `r_dot = beta . n_dot`.
    fn rate(&self, k: usize, s: &State) -> Rate {
        let node = &self.track.nodes[k];
        let p = self.palms[k].solve(s.r);
        let mut torque = DVec3::ZERO;
        let mut r = DVec3::ZERO;
        for i in 0..3 {
            let (palm, b) = (&node.palms[i], node.p_WC[i] - p);
            r[i] = b.dot((s.w - palm.omega()).cross(palm.frame.n));
            torque += b.cross(node.forces[i] * palm.frame.n);
        }
        let L = s.q * (self.mass.inertia() * (s.q.inverse() * s.w));
        let alpha = s.q * (self.mass.inverse_inertia() * (s.q.inverse() * (torque - s.w.cross(L))));
        Rate { r, q: DQuat::from_xyzw(s.w.x, s.w.y, s.w.z, 0.0) * s.q * 0.5, alpha }
    }

    fn run(&self, first: State, method: PaperMethod) -> Run {
        let mut run = Run { states: Vec::with_capacity(self.track.t.len()), gap: 0.0, defect: 0.0 };
        let mut rates: Vec<Rate> = Vec::with_capacity(self.track.t.len());
        let adams = method.scheme == PredictorCorrector::Adams4;
        let started = if adams { self.starting_states(first) } else { vec![first] };
        for k in 0..self.track.t.len() {
            let mut state = match started.get(k) {
                Some(state) => *state,
                None => {
                    let (predicted, corrected) = self.step(k, &run.states[k - 1], &rates, adams);
                    run.gap = run.gap.max(self.distance(&predicted, &corrected));
                    corrected
                }
            };
            let defect = self.defect(k, &state);
            run.defect += defect.norm_squared();
            if method.enforce_constraint && k > 0 {
                state = self.corrected(k, &state, &defect);
            }
            if !(state.r.length() < DIVERGED * self.length && state.w.is_finite()) {
                break;
            }
            rates.push(self.rate(k, &state));
            run.states.push(state);
        }
        run
    }

    /// Prediction and correction of the state at sample `k` from the rates before it.
    fn step(&self, k: usize, before: &State, rates: &[Rate], adams: bool) -> (State, State) {
        let h = self.track.t[k] - self.track.t[k - 1];
        if adams {
            let past = [rates[k - 1], rates[k - 2], rates[k - 3], rates[k - 4]];
            let predicted = advance(before, &past, &[55.0, -59.0, 37.0, -9.0].map(|w| w / 24.0), h);
            let used = [self.rate(k, &predicted), past[0], past[1], past[2]];
            (predicted, advance(before, &used, &[9.0, 19.0, -5.0, 1.0].map(|w| w / 24.0), h))
        } else {
            let predicted = advance(before, &[rates[k - 1]], &[1.0], h);
            let used = [rates[k - 1], self.rate(k, &predicted)];
            (predicted, advance(before, &used, &[0.5, 0.5], h))
        }
    }

    /// The first four states, by Picard's iteration with the polynomial through the rates at six samples: the steps
    /// are short against the motion, so each round gains several digits.
    fn starting_states(&self, first: State) -> Vec<State> {
        let t = &self.track.t[..STARTING_NODES];
        let mut states = vec![first; STARTING_NODES];
        for _ in 0..STARTING_ROUNDS {
            let rates: Vec<Rate> = states.iter().enumerate().map(|(k, s)| self.rate(k, s)).collect();
            let r = running_integral(t, &rates.iter().map(|x| x.r).collect::<Vec<_>>(), DVec3::ZERO);
            let w = running_integral(t, &rates.iter().map(|x| x.alpha).collect::<Vec<_>>(), DVec3::ZERO);
            let zero = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
            let q = running_integral(t, &rates.iter().map(|x| x.q).collect::<Vec<_>>(), zero);
            for (k, state) in states.iter_mut().enumerate() {
                *state = State { r: first.r + r[k], q: (first.q + q[k]).normalize(), w: first.w + w[k] };
            }
        }
        states.truncate(4);
        states
    }

    /// Defects of (24) at the three contacts, with the rates of the contact curves from (15).
    fn defect(&self, k: usize, s: &State) -> Vector3<f64> {
        let node = &self.track.nodes[k];
        let R_WO = DMat3::from_quat(s.q);
        let p_dot: [DVec3; 3] = std::array::from_fn(|i| self.p_dot_WC[i][k]);
        let rates = contact_curve_rates(&self.palms[k], R_WO, &node.p_WC, &p_dot, s.w);
        let p = self.palms[k].solve(s.r);
        let force: DVec3 = (0..3).map(|i| node.forces[i] * node.palms[i].frame.n).sum();
        let a = self.track.gravity + force / self.mass.mass();
        let alpha = self.rate(k, s).alpha;
        Vector3::from_fn(|i, _| {
            let b = node.p_WC[i] - p;
            acceleration_defect(&node.palms[i], s.w, b, R_WO * rates[i], self.p_ddot_WC[i][k], a, alpha)
        })
    }

    /// The nearest state (in natural sizes) on the linearised constraint (24).
    fn corrected(&self, k: usize, s: &State, defect: &Vector3<f64>) -> State {
        let moved = |step: &Vector6<f64>| State {
            r: s.r + self.length * DVec3::new(step[0], step[1], step[2]),
            w: s.w + self.rate * DVec3::new(step[3], step[4], step[5]),
            ..*s
        };
        let mut jacobian = Matrix3x6::zeros();
        for column in 0..6 {
            let mut step = Vector6::zeros();
            step[column] = DIFFERENCE;
            jacobian.set_column(column, &((self.defect(k, &moved(&step)) - defect) / DIFFERENCE));
        }
        let square: Matrix3<f64> = jacobian * jacobian.transpose();
        // Where the constraint says nothing about some direction, the step leaves it alone.
        match square.pseudo_inverse(1e-10 * square.norm()) {
            Ok(inverse) => moved(&(-(jacobian.transpose() * (inverse * defect)))),
            Err(_) => *s,
        }
    }

    /// Difference of two states in natural sizes.
    fn difference(&self, a: &State, b: &State) -> [f64; STATES] {
        let r = (a.r - b.r) / self.length;
        let turn = a.q * b.q.inverse();
        let angle = DVec3::new(turn.x, turn.y, turn.z) * 2.0 * turn.w.signum();
        let w = (a.w - b.w) / self.rate;
        [r.x, r.y, r.z, angle.x, angle.y, angle.z, w.x, w.y, w.z]
    }

    fn distance(&self, a: &State, b: &State) -> f64 {
        self.difference(a, b).iter().fold(0.0, |m, d| m.max(d.abs()))
    }

    /// Sensitivity of the last state that all runs reach, by differences.
    fn sensitivity(&self, first: State, method: PaperMethod) -> SMatrix<f64, STATES, STATES> {
        let base = self.run(first, method).states;
        let mut matrix = SMatrix::zeros();
        for column in 0..STATES {
            let mut axis = DVec3::ZERO;
            axis[column % 3] = DIFFERENCE;
            let start = match column / 3 {
                0 => State { r: first.r + self.length * axis, ..first },
                1 => State { q: exponential(axis) * first.q, ..first },
                _ => State { w: first.w + self.rate * axis, ..first },
            };
            let moved = self.run(start, method).states;
            let last = moved.len().min(base.len()) - 1;
            for (row, d) in self.difference(&moved[last], &base[last]).into_iter().enumerate() {
                matrix[(row, column)] = d / DIFFERENCE;
            }
        }
        matrix
    }

    fn motion(&self, t: f64, k: usize, s: &State) -> MotionState {
        let node = &self.track.nodes[k];
        let p_WCm = self.palms[k].solve(s.r);
        // N v = G w - p, as everywhere: the palms carry the contacts.
        let speed = |i: usize| s.w.dot(node.palms[i].frame.n.cross(node.p_WC[i] - p_WCm)) - node.lift[i];
        let v_WCm = self.palms[k].solve(DVec3::new(speed(0), speed(1), speed(2)));
        MotionState { t, p_WCm, R_WO: s.q, v_WCm, w_WO: s.w }
    }
}

/// `state + h sum weights[j] rates[j]`.
fn advance<const J: usize>(state: &State, rates: &[Rate; J], weights: &[f64; J], h: f64) -> State {
    let mut moved = *state;
    for (rate, weight) in rates.iter().zip(weights) {
        let weight = h * weight;
        moved.r += rate.r * weight;
        moved.q += rate.q * weight;
        moved.w += rate.alpha * weight;
    }
    State { q: moved.q.normalize(), ..moved }
}
