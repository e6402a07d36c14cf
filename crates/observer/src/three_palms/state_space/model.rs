//! The momentum form as a system in state space: one step of the motion, driven by measured contacts and forces.
//!
//! States are centre of mass, velocity, angular momentum and orientation, then the unknown constants. Contacts and forces
//! are inputs, and noisy; the output is the contact condition, which is zero. Noise is handled where it enters:
//!
//! - Given the state, the contact condition is a line in the plane of a palm's sensor, and the most probable contact is
//!   the foot of the measured one on it. The output is the distance to the line in standard deviations, and derivatives
//!   are taken at the foot: at adjusted data, as Gauss-Helmert estimation asks.
//! - What the foot says of the contact enters the torque too; only what it leaves open is noise of the flow. Noise of the
//!   output and of the flow are then independent, as a filter needs.
//! - Noise of the forces is noise of the flow.

use super::constants::{Constant, Parameters};
use super::flow::Step;
use super::inertia::inertia_slope;
use super::input::{NodeInput, Touch};
use crate::core::Model;
use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::delassus::Push;
use crate::three_palms::momentum::{Scales, StartState};
use crate::three_palms::sensitivity::{exponential, logarithm};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{SMatrix, SVector};

/// States of the motion: centre of mass, velocity, angular momentum, orientation.
pub(crate) const MOTION_STATES: usize = 12;
/// Deviation of a block's contact condition below which nothing is believed, as a share of the natural velocity: sums of
/// a dozen products of rounded numbers.
const CONDITION_FLOOR: f64 = 1e-14;
/// Standard deviations that a contact is moved by at most. No noise moves one farther; a motion that is not yet right
/// would, without bounds where a palm hardly slides.
const FARTHEST_FOOT: f64 = 5.0;

/// Motion at a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) p: DVec3,
    pub(super) v: DVec3,
    pub(super) L: DVec3,
    pub(super) q: DQuat,
}

/// What follows from the motion and the constants at a node.
pub(super) struct Turn {
    /// Inverse inertia in world axes.
    pub(super) K: DMat3,
    pub(super) w: DVec3,
    R: DMat3,
}

impl Turn {
    pub(super) fn new(parameters: &Parameters, q: DQuat, L: DVec3) -> Self {
        let R = DMat3::from_quat(q);
        let K = R * parameters.inverse_inertia * R.transpose();
        Self { K, w: K * L, R }
    }

    /// Change of the angular velocity with a number of the inertia tensor, over `K`: `-dI w`.
    pub(super) fn by_inertia(&self, parameters: &Parameters, number: usize) -> DVec3 {
        -(self.R * (inertia_slope(&parameters.inertia, number) * (self.R.transpose() * self.w)))
    }
}

/// One contact condition, not yet divided by its deviation.
pub(super) struct Condition<const N: usize> {
    /// `e`, m/s.
    pub(super) value: f64,
    /// Its derivatives by the states, at the adjusted contact.
    pub(super) row: SVector<f64, N>,
    /// Its derivatives by the sensor coordinates, rad/s.
    pub(super) by_contact: [f64; 2],
    /// Its variance by contact noise, (m/s)^2.
    pub(super) variance: f64,
    /// Correction of the contact, over `by_contact`, m s: the foot of the measured contact on the line of the condition,
    /// as far as noise can have moved it.
    pub(super) foot: f64,
    /// Derivative of that by `value`.
    pub(super) foot_slope: f64,
}

/// The model: constants of body and sensors that are known, a list of those that are states, and the noise.
#[derive(Clone, Debug)]
pub(crate) struct ThreePalmModel<const N: usize> {
    base: Parameters,
    constants: Vec<Constant>,
    pub(super) gravity: DVec3,
    pub(super) noise: NoiseLevel,
    scales: Scales,
}

impl<const N: usize> ThreePalmModel<N> {
    /// None unless the states are those of the motion and the `constants`.
    pub(crate) fn new(
        base: Parameters,
        constants: &[Constant],
        gravity: DVec3,
        noise: NoiseLevel,
        scales: Scales,
    ) -> Option<Self> {
        (N == MOTION_STATES + constants.len()).then(|| Self {
            base,
            constants: constants.to_vec(),
            gravity,
            noise,
            scales,
        })
    }

    /// The arms `n x c` of a block with its contacts at the feet, for a state.
    pub(crate) fn adjusted_arms(&self, x: &SVector<f64, N>, touch: &Touch) -> [DVec3; 3] {
        let conditions = self.conditions(x, touch);
        std::array::from_fn(|i| {
            let (palm, condition) = (&touch.palms[i], &conditions[i]);
            let [first, second] = condition.by_contact;
            palm.arm[0] + condition.foot * (first * palm.frame.t2 - second * palm.frame.t1)
        })
    }

    /// Impulse that leads from one state to another beside what was measured, N s.
    pub(crate) fn missing_impulse(
        &self,
        from: &SVector<f64, N>,
        to: &SVector<f64, N>,
        input: &NodeInput,
    ) -> DVec3 {
        let reached = unpack(&self.advance(from, input)).v;
        (unpack(to).v - reached) * self.parameters(to).mass
    }

    /// Natural rate, 1/s.
    pub(crate) fn natural_rate(&self) -> f64 {
        self.scales.velocity / self.scales.length
    }

    /// Contact noise over the natural length.
    pub(crate) fn relative_noise(&self) -> f64 {
        self.noise.contact / self.scales.length
    }

    /// The state with a motion and constants.
    pub(crate) fn state(&self, start: &StartState, parameters: &Parameters) -> SVector<f64, N> {
        let blocks = [start.p_WCm, start.v_WCm, start.L_WO, logarithm(start.R_WO.normalize())];
        SVector::from_fn(|i, _| {
            if i < MOTION_STATES {
                blocks[i / 3][i % 3]
            } else {
                parameters.get(self.constants[i - MOTION_STATES])
            }
        })
    }

    /// The motion in a state.
    pub(crate) fn motion(&self, x: &SVector<f64, N>) -> StartState {
        let Motion { p, v, L, q } = unpack(x);
        StartState { p_WCm: p, v_WCm: v, L_WO: L, R_WO: q }
    }

    /// The constants in a state.
    pub(crate) fn parameters(&self, x: &SVector<f64, N>) -> Parameters {
        self.base.with(self.constants.iter().copied().zip(x.iter().skip(MOTION_STATES).copied()))
    }

    /// Variances of the rates at which the body turns against each palm, from a state's covariance.
    pub(crate) fn slide_variances(
        &self,
        x: &SVector<f64, N>,
        covariance: &SMatrix<f64, N, N>,
        touch: &Touch,
    ) -> [f64; 3] {
        let (motion, parameters) = (unpack(x), self.parameters(x));
        let turn = Turn::new(&parameters, motion.q, motion.L);
        touch.palms.each_ref().map(|palm| {
            let along = |axis: DVec3| {
                let row = self.turning_row(axis, &motion, &parameters, &turn);
                row.dot(&(covariance * row)).max(0.0)
            };
            along(palm.frame.t1) + along(palm.frame.t2)
        })
    }

    /// Derivative of `axis . w` by the states.
    fn turning_row(
        &self,
        axis: DVec3,
        motion: &Motion,
        parameters: &Parameters,
        turn: &Turn,
    ) -> SVector<f64, N> {
        // dw = (K [L]x - [w]x) theta + K (dL - dI w).
        let by_L = turn.K * axis;
        let by_motion = [DVec3::ZERO, DVec3::ZERO, by_L, by_L.cross(motion.L) - axis.cross(turn.w)];
        SVector::from_fn(|j, _| {
            if j < MOTION_STATES {
                return by_motion[j / 3][j % 3];
            }
            match self.constants[j - MOTION_STATES] {
                Constant::Inertia(number) => by_L.dot(turn.by_inertia(parameters, number)),
                _ => 0.0,
            }
        })
    }

    /// The contact conditions of all palms over a block.
    pub(super) fn conditions(&self, x: &SVector<f64, N>, touch: &Touch) -> [Condition<N>; 3] {
        let (motion, parameters) = (unpack(x), self.parameters(x));
        let turn = Turn::new(&parameters, motion.q, motion.L);
        let rates = BlockRates::new(self, &motion, &parameters, &turn, touch);
        std::array::from_fn(|i| self.condition(i, &motion, &parameters, &turn, &rates, touch))
    }

    fn condition(
        &self,
        i: usize,
        motion: &Motion,
        parameters: &Parameters,
        turn: &Turn,
        rates: &BlockRates,
        touch: &Touch,
    ) -> Condition<N> {
        let palm = &touch.palms[i];
        let (frame, n) = (&palm.frame, palm.normal[0]);
        let arm = palm.arm[0];
        let curved: f64 =
            (0..2).map(|k| palm.normal[k + 1].dot(rates.u[k]) - palm.arm[k + 1].dot(rates.w[k])).sum();
        let value = n.dot(motion.v + motion.p.cross(turn.w)) - arm.dot(turn.w) + palm.lift + curved;
        let by_contact = [-turn.w.dot(frame.t2), turn.w.dot(frame.t1) - palm.rate];
        let of_contact = self.noise.contact * self.noise.contact / touch.samples;
        let floor = CONDITION_FLOOR * self.scales.velocity;
        let square = by_contact[0] * by_contact[0] + by_contact[1] * by_contact[1] + touch.slide_variance[i];
        let variance =
            of_contact * square + self.between_samples(i, motion, parameters, turn, touch) + floor * floor;
        let farthest = FARTHEST_FOOT / variance.sqrt();
        let near = (value / variance).abs() <= farthest;
        let foot_slope = if near { -of_contact / variance } else { 0.0 };
        let foot = -of_contact * (value / variance).max(-farthest).min(farthest);
        // The part of the arm's noise that the condition itself holds is taken out with the foot.
        let own = foot * palm.own_share;
        let adjusted = palm.smooth_arm + own * (by_contact[0] * frame.t2 - by_contact[1] * frame.t1);
        // de = n . dv + (w x n) . dp - a . dw, a = n x (c - p).
        let a = adjusted - n.cross(motion.p);
        let mut row = self.turning_row(-a, motion, parameters, turn);
        for axis in 0..3 {
            row[axis] = turn.w.cross(n)[axis];
            row[3 + axis] = n[axis];
        }
        Condition { value, row, by_contact, variance, foot, foot_slope }
    }

    /// What a condition varies by since the force at the node acts half before it and half after: as noise it counts to
    /// neither. It is no more than what noise there is, and keeps a condition from counting for all where a palm hardly slides.
    fn between_samples(
        &self,
        i: usize,
        motion: &Motion,
        parameters: &Parameters,
        turn: &Turn,
        touch: &Touch,
    ) -> f64 {
        let half = 0.5 * self.noise.force * touch.spacing;
        let push = |i: usize| {
            let palm = &touch.palms[i];
            let n = palm.normal[0];
            Push { normal: n, arm: palm.arm[0] - n.cross(motion.p) }
        };
        let own = push(i);
        let by = |other: usize| own.speed_by(&push(other), parameters.mass, turn.K);
        (0..3).map(|other| (half * by(other)).powi(2)).sum()
    }

    fn step<'a>(&'a self, x: &SVector<f64, N>, input: &'a NodeInput) -> Step<'a, N> {
        Step::new(self, unpack(x), self.parameters(x), self.conditions(x, &input.from), input)
    }
}

/// First and second derivatives of `u = v + p x w` and of `w` at a node, for the moments of a block.
struct BlockRates {
    u: [DVec3; 2],
    w: [DVec3; 2],
}

impl BlockRates {
    fn new<const N: usize>(
        model: &ThreePalmModel<N>,
        motion: &Motion,
        parameters: &Parameters,
        turn: &Turn,
        touch: &Touch,
    ) -> Self {
        if touch.samples <= 1.0 {
            return Self { u: [DVec3::ZERO; 2], w: [DVec3::ZERO; 2] };
        }
        let sum = |part: &dyn Fn(usize) -> DVec3| (0..3).map(part).sum::<DVec3>();
        let force: [DVec3; 2] = std::array::from_fn(|k| sum(&|i| touch.palms[i].force[k]));
        let torque: [DVec3; 2] = std::array::from_fn(|k| sum(&|i| touch.palms[i].torque[k]));
        let Motion { p, v, L, .. } = *motion;
        let (K, w) = (turn.K, turn.w);
        let a = model.gravity + force[0] / parameters.mass;
        let jerk = force[1] / parameters.mass;
        let dL = torque[0] - p.cross(force[0]);
        let ddL = torque[1] - v.cross(force[0]) - p.cross(force[1]);
        // K' = [w]x K - K [w]x and w x w = 0: w' = K y, y = L' - w x L.
        let y = dL - w.cross(L);
        let dw = K * y;
        let ddw = w.cross(dw) + K * (ddL - dw.cross(L) - w.cross(dL) - w.cross(y));
        Self {
            u: [a + v.cross(w) + p.cross(dw), jerk + a.cross(w) + 2.0 * v.cross(dw) + p.cross(ddw)],
            w: [dw, ddw],
        }
    }
}

pub(super) fn unpack<const N: usize>(x: &SVector<f64, N>) -> Motion {
    let block = |k: usize| DVec3::new(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
    Motion { p: block(0), v: block(1), L: block(2), q: exponential(block(3)) }
}

impl<const N: usize> Model<N, 3> for ThreePalmModel<N> {
    type Input = NodeInput;

    fn flow(&self, x: &SVector<f64, N>, input: &NodeInput) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        let step = self.step(x, input);
        (step.end(x), step.transition(&self.constants))
    }

    fn advance(&self, x: &SVector<f64, N>, input: &NodeInput) -> SVector<f64, N> {
        self.step(x, input).end(x)
    }

    fn output(&self, x: &SVector<f64, N>, input: &NodeInput) -> (SVector<f64, 3>, SMatrix<f64, 3, N>) {
        let conditions = self.conditions(x, &input.here);
        let weights = conditions.each_ref().map(|c| 1.0 / c.variance.sqrt());
        (
            SVector::from_fn(|i, _| conditions[i].value * weights[i]),
            SMatrix::from_fn(|i, j| conditions[i].row[j] * weights[i]),
        )
    }

    fn process_noise(&self, x: &SVector<f64, N>, input: &NodeInput) -> Option<SMatrix<f64, N, N>> {
        Some(self.step(x, input).noise())
    }

    fn retract(&self, x: &SVector<f64, N>, step: &SVector<f64, N>) -> SVector<f64, N> {
        let turned = exponential(rotation(step)) * exponential(rotation(x));
        with_rotation(x + step, logarithm(turned))
    }

    fn difference(&self, to: &SVector<f64, N>, from: &SVector<f64, N>) -> SVector<f64, N> {
        let turn = exponential(rotation(to)) * exponential(rotation(from)).inverse();
        with_rotation(to - from, logarithm(turn))
    }

    fn scales(&self) -> SVector<f64, N> {
        let blocks = self.scales.by_block();
        SVector::from_fn(|i, _| {
            if i < MOTION_STATES {
                blocks[i / 3]
            } else {
                self.constants[i - MOTION_STATES].scale(&self.scales)
            }
        })
    }

    fn names(&self) -> [&'static str; N] {
        const MOTION: [&str; MOTION_STATES] = [
            "centre of mass along x",
            "centre of mass along y",
            "centre of mass along z",
            "velocity along x",
            "velocity along y",
            "velocity along z",
            "angular velocity about x",
            "angular velocity about y",
            "angular velocity about z",
            "orientation about x",
            "orientation about y",
            "orientation about z",
        ];
        std::array::from_fn(|i| {
            if i < MOTION_STATES { MOTION[i] } else { self.constants[i - MOTION_STATES].name() }
        })
    }
}

/// The rotation vector among the states.
fn rotation<const N: usize>(x: &SVector<f64, N>) -> DVec3 {
    DVec3::new(x[9], x[10], x[11])
}

fn with_rotation<const N: usize>(mut x: SVector<f64, N>, rotation: DVec3) -> SVector<f64, N> {
    for axis in 0..3 {
        x[9 + axis] = rotation[axis];
    }
    x
}
