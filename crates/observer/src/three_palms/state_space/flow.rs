//! One interval of the motion with its derivative and its noise.

use super::constants::{Constant, Parameters};
use super::input::{NodeInput, Wrench};
use super::model::{Condition, MOTION_STATES, Motion, ThreePalmModel, Turn};
use crate::three_palms::sensitivity::{cross_matrix, logarithm};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, SMatrix, SVector};

type Columns<const N: usize> = SMatrix<f64, 3, N>;

/// The motion over an interval from a given state.
pub(super) struct Step<'a, const N: usize> {
    model: &'a ThreePalmModel<N>,
    input: &'a NodeInput,
    motion: Motion,
    parameters: Parameters,
    conditions: [Condition<N>; 3],
    /// Wrench over the first half and over the whole.
    wrenches: [Wrench; 2],
    /// Angular momentum and orientation at the middle and at the end.
    later: [(DVec3, DQuat); 2],
}

impl<'a, const N: usize> Step<'a, N> {
    pub(super) fn new(
        model: &'a ThreePalmModel<N>,
        motion: Motion,
        parameters: Parameters,
        conditions: [Condition<N>; 3],
        input: &'a NodeInput,
    ) -> Self {
        let held = held(input);
        let shifts = std::array::from_fn(|i| {
            let frame = &input.from.palms[i].frame;
            let foot = held * conditions[i].foot;
            let shift = |axis: usize| foot * conditions[i].by_contact[axis];
            shift(0) * frame.t1 + shift(1) * frame.t2
        });
        let half = input.duration * 0.5;
        let [first, second] = input.halves.each_ref().map(|palms| total(palms, &shifts));
        let wrenches = [first, first.then(half, second)];
        let mut step =
            Self { model, input, motion, parameters, conditions, wrenches, later: [(motion.L, motion.q); 2] };
        let middle_L = step.momentum(half, &first);
        let end_L = step.momentum(input.duration, &step.wrenches[1]);
        let (middle, end) = step.turned(middle_L, end_L);
        step.later = [(middle_L, middle), (end_L, end)];
        step
    }

    /// Angular momentum after the time `s`. What the fall between the first order of the path adds is taken for a force
    /// that changes linearly: an error of fifth order.
    fn momentum(&self, s: f64, wrench: &Wrench) -> DVec3 {
        let Motion { p, v, L, .. } = self.motion;
        let second = wrench.first * s - wrench.impulse * (s * s / 6.0);
        L + wrench.torque
            - p.cross(wrench.impulse)
            - v.cross(wrench.first)
            - 0.5 * self.model.gravity.cross(second)
            - wrench.impulse.cross(wrench.first) / self.parameters.mass
    }

    /// Runge-Kutta step of order 4 of the orientation: at the middle and at the end.
    fn turned(&self, middle_L: DVec3, end_L: DVec3) -> (DQuat, DQuat) {
        let h = self.input.duration;
        let rate = |q: DQuat, L: DVec3| {
            let w = self.parameters.inverse_inertia * (q.inverse() * L);
            q * DQuat::from_xyzw(0.5 * w.x, 0.5 * w.y, 0.5 * w.z, 0.0)
        };
        let q = self.motion.q;
        let k1 = rate(q, self.motion.L);
        let k2 = rate((q + k1 * (0.5 * h)).normalize(), middle_L);
        let middle = (q + k2 * (0.5 * h)).normalize();
        let k3 = rate(middle, middle_L);
        let k4 = rate((q + k3 * h).normalize(), end_L);
        (middle, (q + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)).normalize())
    }

    /// State at the end; the constants are those of the start `x`.
    pub(super) fn end(&self, x: &SVector<f64, N>) -> SVector<f64, N> {
        let Motion { p, v, .. } = self.motion;
        let (h, g, mass) = (self.input.duration, self.model.gravity, self.parameters.mass);
        let wrench = &self.wrenches[1];
        let (L, q) = self.later[1];
        let blocks = [
            p + v * h + 0.5 * g * h * h + (wrench.impulse * h - wrench.first) / mass,
            v + g * h + wrench.impulse / mass,
            L,
            logarithm(q),
        ];
        SVector::from_fn(|i, _| if i < MOTION_STATES { blocks[i / 3][i % 3] } else { x[i] })
    }

    /// Wrench over the first half or the whole, without the noise that the estimate has found in it.
    fn adjusted(&self, part: usize) -> Wrench {
        let wrench = self.wrenches[part];
        let (share, s) =
            if part == 0 { (0.5, 0.5 * self.input.duration) } else { (1.0, self.input.duration) };
        let impulse = self.input.correction * share;
        Wrench { impulse: wrench.impulse + impulse, first: wrench.first + impulse * (0.5 * s), ..wrench }
    }

    /// Derivative of the end by the start.
    pub(super) fn transition(&self, constants: &[Constant]) -> SMatrix<f64, N, N> {
        let h = self.input.duration;
        let identity = DMat3::IDENTITY;
        let [mut p, mut v] = [Columns::<N>::zeros(); 2];
        put(&mut p, 0, identity);
        put(&mut p, 1, identity * h);
        put(&mut v, 1, identity);
        let mut start_L = Columns::<N>::zeros();
        put(&mut start_L, 2, identity);
        let middle_L = self.momentum_slope(0, constants);
        let end_L = self.momentum_slope(1, constants);
        let turning = |(L, q): (DVec3, DQuat), by_L: &Columns<N>| self.turning_slope(q, L, by_L, constants);
        let slopes = [
            turning((self.motion.L, self.motion.q), &start_L),
            turning(self.later[0], &middle_L),
            turning(self.later[1], &end_L),
        ];
        let theta = advance(&slopes, h);
        let mass = self.parameters.mass;
        for (j, _) in constants.iter().enumerate().filter(|(_, constant)| **constant == Constant::LogMass) {
            let wrench = self.adjusted(1);
            let impulse = -wrench.impulse / mass;
            let travel = -(wrench.impulse * h - wrench.first) / mass;
            v.set_column(MOTION_STATES + j, &impulse.into());
            p.set_column(MOTION_STATES + j, &travel.into());
        }
        let mut all = SMatrix::<f64, N, N>::identity();
        for (block, rows) in [p, v, end_L, theta].iter().enumerate() {
            all.fixed_rows_mut::<3>(3 * block).copy_from(rows);
        }
        all
    }

    /// Derivative of the angular momentum after the time `s`; `part` is the first half or the whole.
    fn momentum_slope(&self, part: usize, constants: &[Constant]) -> Columns<N> {
        let (wrench, mass) = (self.adjusted(part), self.parameters.mass);
        let mut L = Columns::<N>::zeros();
        // -dp x impulse = impulse x dp.
        put(&mut L, 0, cross_matrix(wrench.impulse));
        put(&mut L, 1, cross_matrix(wrench.first));
        put(&mut L, 2, DMat3::IDENTITY);
        for (j, _) in constants.iter().enumerate().filter(|(_, constant)| **constant == Constant::LogMass) {
            L.set_column(MOTION_STATES + j, &(wrench.impulse.cross(wrench.first) / mass).into());
        }
        // The foot of the contact depends on the state before.
        let held = held(self.input);
        for i in 0..3 {
            let (condition, frame) = (&self.conditions[i], &self.input.from.palms[i].frame);
            let impulse: DVec3 = self.input.halves[..=part].iter().map(|palms| palms[i].impulse).sum();
            let along = condition.by_contact[0] * frame.t1 + condition.by_contact[1] * frame.t2;
            let kick: SVector<f64, 3> = (along.cross(impulse) * (held * condition.foot_slope)).into();
            L.ger(1.0, &kick, &condition.row, 1.0);
        }
        L
    }

    /// `M` and `S` of `theta' = M theta + S` at one time.
    fn turning_slope(
        &self,
        q: DQuat,
        L: DVec3,
        by_L: &Columns<N>,
        constants: &[Constant],
    ) -> (Matrix3<f64>, Columns<N>) {
        let turn = Turn::new(&self.parameters, q, L);
        let mut source = *by_L;
        for (j, constant) in constants.iter().enumerate() {
            if let Constant::Inertia(number) = *constant {
                let change: SVector<f64, 3> = turn.by_inertia(&self.parameters, number).into();
                let mut column = source.column_mut(MOTION_STATES + j);
                column += change;
            }
        }
        (Matrix3::from(turn.K * cross_matrix(L)), Matrix3::from(turn.K) * source)
    }

    /// Covariance of what noise of forces and contacts adds over the interval.
    pub(super) fn noise(&self) -> SMatrix<f64, N, N> {
        let mut q = SMatrix::<f64, MOTION_STATES, MOTION_STATES>::zeros();
        let h = self.input.duration;
        let K = Turn::new(&self.parameters, self.motion.q, self.motion.L).K;
        let held = held(self.input);
        // Of the mean contact over the interval.
        let of_contact = if h > 0.0 {
            self.model.noise.contact * self.model.noise.contact * self.input.from.spacing / h
        } else {
            0.0
        };
        // White noise over an interval: its mean moves the path by half the interval, and what is left of the path's
        // variance, h^2 / 3 - h^2 / 4, is independent of the mean.
        let mut add = |variance: f64, velocity: DVec3, momentum: DVec3| {
            let rates = [velocity, K * momentum];
            for (path, size) in [(0.5 * h, 1.0), (h / 12f64.sqrt(), 0.0)] {
                let blocks = [rates[0] * path, velocity * size, momentum * size, rates[1] * path];
                let kick = SVector::<f64, MOTION_STATES>::from_fn(|i, _| blocks[i / 3][i % 3]);
                q.ger(variance, &kick, &kick, 1.0);
            }
        };
        for i in 0..3 {
            let palm = &self.input.from.palms[i];
            let n = palm.normal[0];
            let of_force = self.model.noise.force.powi(2) * h * self.input.from.spacing;
            let lever = -0.5 * (palm.arm[0] + self.input.here.palms[i].arm[0]) - self.motion.p.cross(n);
            add(of_force, n / self.parameters.mass, lever);
            let impulse: DVec3 = self.input.halves.iter().map(|palms| palms[i].impulse).sum();
            let [a, b] = self.conditions[i].by_contact;
            let size = a.hypot(b);
            let (a, b) = if size > 0.0 { (a / size, b / size) } else { (1.0, 0.0) };
            let known = -held * held * self.conditions[i].foot_slope * size * size;
            let (t1, t2) = (palm.frame.t1, palm.frame.t2);
            add((of_contact - known).max(0.0), DVec3::ZERO, (a * t1 + b * t2).cross(impulse));
            add(of_contact, DVec3::ZERO, (a * t2 - b * t1).cross(impulse));
        }
        let mut all = SMatrix::<f64, N, N>::zeros();
        all.fixed_view_mut::<MOTION_STATES, MOTION_STATES>(0, 0).copy_from(&q);
        all
    }
}

/// Share of the interval that the contacts of the block at its start are taken to act for: as long as the block lasts,
/// from its node on. (The half before the node has acted already; the delay by half a block is the price of a noise that
/// is independent from interval to interval.)
fn held(input: &NodeInput) -> f64 {
    let block = input.from.samples * input.from.spacing;
    if block < input.duration { block / input.duration } else { 1.0 }
}

/// The wrench of all palms about contacts that are shifted.
fn total(palms: &[Wrench; 3], shifts: &[DVec3; 3]) -> Wrench {
    (0..3).fold(Wrench::default(), |sum, i| {
        let wrench = palms[i];
        sum + Wrench { torque: wrench.torque + shifts[i].cross(wrench.impulse), ..wrench }
    })
}

fn put<const N: usize>(columns: &mut Columns<N>, block: usize, value: DMat3) {
    for (j, column) in [value.x_axis, value.y_axis, value.z_axis].into_iter().enumerate() {
        columns.set_column(3 * block + j, &column.into());
    }
}

/// One Runge-Kutta step of order 4 of `theta' = M theta + S` from the unit matrix, with slopes at start, middle, end.
fn advance<const N: usize>(slopes: &[(Matrix3<f64>, Columns<N>); 3], h: f64) -> Columns<N> {
    let mut theta = Columns::<N>::zeros();
    put(&mut theta, 3, DMat3::IDENTITY);
    let [(m0, s0), (m1, s1), (m2, s2)] = slopes;
    let k1 = m0 * theta + s0;
    let k2 = m1 * (theta + k1 * (0.5 * h)) + s1;
    let k3 = m1 * (theta + k2 * (0.5 * h)) + s1;
    let k4 = m2 * (theta + k3 * h) + s2;
    theta + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)
}
