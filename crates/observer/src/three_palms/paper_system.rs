//! The paper's system (35) to (37) with its constraint (24), step by step.

use super::motion_state::MotionState;
use super::paper_method::{PaperError, PaperMethod, PredictorCorrector, STATES};
use super::track::{Node, Track};
use crate::quadrature::{derivative, running_integral};
use crate::rigid::exponential;
use contact_kinematics::{PalmTriple, acceleration_defect, contact_curve_rates};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, Matrix3x6, SMatrix, Vector3, Vector6};
use object_dynamics::MassProperties;

/// A radius beyond this many times the size of the scene is divergence.
const DIVERGED: f64 = 100.0;
/// Step of the differences by which the constraint and the sensitivity are linearised, in natural sizes: the square
/// root of rounding, where truncation and rounding balance.
const DIFFERENCE: f64 = 1.5e-8;

/// Samples and rounds of Picard's iteration at the start.
const STARTING_NODES: usize = 6;
const STARTING_ROUNDS: usize = 15;

#[derive(Clone, Copy)]
pub(super) struct State {
    pub(super) r: DVec3,
    pub(super) q: DQuat,
    pub(super) w: DVec3,
}

/// Rate of a state: of the radii, the quaternion, and the angular velocity.
#[derive(Clone, Copy)]
struct Rate {
    r: DVec3,
    q: DQuat,
    alpha: DVec3,
}

pub(super) struct Run {
    pub(super) states: Vec<State>,
    pub(super) gap: f64,
    pub(super) defect: f64,
}

pub(super) struct System<'a> {
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
    pub(super) fn new(track: &'a Track, mass: &'a MassProperties) -> Result<Self, PaperError> {
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

    pub(super) fn run(&self, first: State, method: PaperMethod) -> Run {
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
    pub(super) fn sensitivity(&self, first: State, method: PaperMethod) -> SMatrix<f64, STATES, STATES> {
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

    pub(super) fn motion(&self, t: f64, k: usize, s: &State) -> MotionState {
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
