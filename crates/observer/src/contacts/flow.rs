//! A node's motion carried through the samples of its link by what was measured, with its derivatives.

use super::body::Body;
use super::equations::Row;
use super::record::{Interval, Wrench};
use super::state::{MOTION, Motion, Tangent, Turn, parts, tangent};
use crate::rigid::{cross_matrix, exponential};
use glam::{DQuat, DVec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Derivatives of a motion by the motion at its node.
pub(super) type Transition = SMatrix<f64, MOTION, MOTION>;

/// The motion some samples after its node, and what its derivatives are made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carried<const P: usize> {
    pub(super) motion: Motion,
    pub(super) turn: Turn,
    /// Time since the node, s.
    pub(super) after: f64,
    inverse_mass: f64,
    /// Integrals since the node: force, force times time, integral of the force, and that crossed with the force.
    impulse: DVec3,
    first: DVec3,
    second: DVec3,
    crossed: DVec3,
    /// Derivatives of the orientation by motion and constants at the node.
    turn_by_motion: SMatrix<f64, 3, MOTION>,
    turn_by_body: SMatrix<f64, 3, P>,
}

impl<const P: usize> Carried<P> {
    pub(super) fn new(motion: Motion, body: &Body) -> Self {
        let mut turn_by_motion = SMatrix::<f64, 3, MOTION>::zeros();
        turn_by_motion.fixed_view_mut::<3, 3>(0, 9).copy_from(&Matrix3::identity());
        Self {
            motion,
            turn: body.turn(motion.q, motion.L),
            after: 0.0,
            inverse_mass: body.inverse_mass(),
            impulse: DVec3::ZERO,
            first: DVec3::ZERO,
            second: DVec3::ZERO,
            crossed: DVec3::ZERO,
            turn_by_motion,
            turn_by_body: SMatrix::zeros(),
        }
    }

    /// To the end of an interval, at whose ends the forces are `wrenches`.
    pub(super) fn advance(
        &mut self,
        interval: &Interval,
        wrenches: [&Wrench; 2],
        body: &Body,
        gravity: DVec3,
    ) {
        if interval.parts > 1 {
            for (part, [a, b]) in interval.in_parts(wrenches) {
                self.advance(&part, [&a, &b], body, gravity);
            }
            return;
        }
        let before = *self;
        self.step(interval, wrenches, body, gravity);
        let h = interval.h;
        // Heun's rule serves derivatives. By what they are off an iteration ends beside the least cost: by a hundredth of a deviation, by a
        // quarter where a body rolls by a tenth of a radian a link.
        let (motion_start, body_start) = before.turn_rates(body);
        self.turn_by_motion = before.turn_by_motion + motion_start * h;
        self.turn_by_body = before.turn_by_body + body_start * h;
        let (motion_end, body_end) = self.turn_rates(body);
        self.turn_by_motion = before.turn_by_motion + (motion_start + motion_end) * (0.5 * h);
        self.turn_by_body = before.turn_by_body + (body_start + body_end) * (0.5 * h);
    }

    /// The motion alone.
    pub(super) fn step(&mut self, interval: &Interval, wrenches: [&Wrench; 2], body: &Body, gravity: DVec3) {
        if interval.parts > 1 {
            for (part, [a, b]) in interval.in_parts(wrenches) {
                self.step(&part, [&a, &b], body, gravity);
            }
            return;
        }
        let (h, m) = (interval.h, self.inverse_mass);
        let (force, first) = (interval.impulse.force, interval.first);
        let second = h * force - first;
        let Motion { p, v, L, q } = self.motion;
        // The line with the impulse and the first moment of the force: of how the body moves under gravity and force while the force acts.
        let slope = (first - force * (0.5 * h)) * (12.0 / (h * h * h));
        let start = force / h - slope * (0.5 * h);
        let fall = 0.5 * gravity.cross(start * (h * h * h / 3.0) + slope * (h.powi(4) / 4.0));
        let drift = fall + start.cross(slope) * (m * h.powi(4) / 12.0);
        let after = Motion {
            p: p + v * h + gravity * (0.5 * h * h) + second * m,
            v: v + gravity * h + force * m,
            L: L + interval.impulse.moment - p.cross(force) - v.cross(first) - drift,
            q,
        };
        let moment = |w: &Wrench, p: DVec3| w.moment - p.cross(w.force);
        let rates = [moment(wrenches[0], p), moment(wrenches[1], after.p)];
        let q = turned(q, [L, after.L], rates, body, h);
        self.crossed += self.second.cross(force) + self.impulse.cross(first);
        self.first += self.after * force + first;
        self.second += self.impulse * h + second;
        self.impulse += force;
        self.after += h;
        self.motion = Motion { q, ..after };
        self.turn = body.turn(q, after.L);
    }

    /// Moves the motion by a step.
    pub(super) fn shift(&mut self, by: &Tangent, body: &Body) {
        let [place, velocity, momentum, turn] = parts(by);
        let Motion { p, v, L, q } = self.motion;
        let q = (exponential(turn) * q).normalize();
        self.motion = Motion { p: p + place, v: v + velocity, L: L + momentum, q };
        self.turn = body.turn(q, self.motion.L);
    }

    /// `phi' = K ([L]x phi + dL) + K (-dI w)`.
    fn turn_rates(&self, body: &Body) -> (SMatrix<f64, 3, MOTION>, SMatrix<f64, 3, P>) {
        let K = Matrix3::from(self.turn.K);
        let KL = K * Matrix3::from(cross_matrix(self.motion.L));
        let mut by_motion = KL * self.turn_by_motion;
        let mut add = |at: usize, block: Matrix3<f64>| {
            let mut view = by_motion.fixed_view_mut::<3, 3>(0, at);
            view += K * block;
        };
        add(0, Matrix3::from(cross_matrix(self.impulse)));
        add(3, Matrix3::from(cross_matrix(self.first)));
        add(6, Matrix3::identity());
        let mut by_body = KL * self.turn_by_body;
        if P > 0 {
            let mut add = |at: usize, change: DVec3| {
                let mut column = by_body.column_mut(at);
                column += Vector3::from(self.turn.K * change);
            };
            add(0, self.crossed * self.inverse_mass);
            for (i, change) in body.by_inertia(&self.turn).into_iter().enumerate() {
                add(i + 1, change);
            }
        }
        (by_motion, by_body)
    }

    /// A condition on the motion here as one on the motion at the node.
    pub(super) fn at_node(&self, row: &Row<P>) -> Row<P> {
        let (motion, body) = self.pulled(&tangent(&row.by_motion));
        Row { by_motion: parts(&motion), by_body: row.by_body + body, value: row.value }
    }

    /// The transposed derivatives by motion and constants at the node, times columns.
    pub(super) fn pulled<const N: usize>(
        &self,
        columns: &SMatrix<f64, MOTION, N>,
    ) -> (SMatrix<f64, MOTION, N>, SMatrix<f64, P, N>) {
        let (mut motion, mut body) = (*columns, SMatrix::<f64, P, N>::zeros());
        let (turn, turn_by_body) = (self.turn_by_motion.transpose(), self.turn_by_body.transpose());
        let (own, _) = columns.as_slice().as_chunks::<MOTION>();
        let (to, _) = motion.as_mut_slice().as_chunks_mut::<MOTION>();
        for (j, (x, to)) in own.iter().zip(to).enumerate() {
            let part = |i: usize| DVec3::new(x[i], x[i + 1], x[i + 2]);
            let (a, b, c) = (part(0), part(3), part(6));
            to[9..].fill(0.0);
            for i in 0..MOTION {
                to[i] += turn[(i, 0)] * x[9] + turn[(i, 1)] * x[10] + turn[(i, 2)] * x[11];
            }
            let (by_place, by_velocity) = (c.cross(self.impulse), a * self.after + c.cross(self.first));
            for i in 0..3 {
                to[i] += by_place[i];
                to[i + 3] += by_velocity[i];
            }
            for i in 0..P {
                body[(i, j)] =
                    turn_by_body[(i, 0)] * x[9] + turn_by_body[(i, 1)] * x[10] + turn_by_body[(i, 2)] * x[11];
            }
            if P > 0 {
                let by_mass = c.dot(self.crossed) - a.dot(self.second) - b.dot(self.impulse);
                body[(0, j)] += by_mass * self.inverse_mass;
            }
        }
        (motion, body)
    }

    /// The derivatives by motion and constants at the node, times a step of these.
    pub(super) fn along(&self, step: &Tangent, body: &SVector<f64, P>) -> Tangent {
        let [a, b, c, _] = parts(step);
        let by_mass = if P > 0 { self.inverse_mass * body[0] } else { 0.0 };
        let turn = DVec3::from(self.turn_by_motion * step + self.turn_by_body * body);
        tangent(&[
            a + b * self.after - self.second * by_mass,
            b - self.impulse * by_mass,
            c + self.impulse.cross(a) + self.first.cross(b) + self.crossed * by_mass,
            turn,
        ])
    }

    /// Derivatives by the motion at the node and by the constants: logarithm of the mass, those of the inertia.
    pub(super) fn derivatives(&self) -> (Transition, SMatrix<f64, MOTION, P>) {
        let (by_motion, by_body) = self.pulled(&Transition::identity());
        (by_motion.transpose(), by_body.transpose())
    }

    /// The same with derivatives at the impulses that a link's residual `r` says there were: with noisy ones the noise of a derivative
    /// would meet its own residual.
    pub(super) fn adjusted(&self, body: &Body, r: &Tangent) -> Self {
        let m = self.inverse_mass;
        let missing = [DVec3::new(r[0], r[1], r[2]) / m, DVec3::new(r[3], r[4], r[5]) / m];
        let mut at = *self;
        at.impulse += missing[1];
        at.second += missing[0];
        at.first += missing[1] * self.after;
        // As much of the turn is owed to the noise of the moments.
        let turn = DVec3::new(r[9], r[10], r[11]);
        let K = Matrix3::from(self.turn.K);
        let inertia = body.inertia_along(self.turn.R);
        let by_turn = K * Matrix3::from(cross_matrix(inertia * turn)) - Matrix3::from(cross_matrix(turn));
        at.turn_by_motion += by_turn * self.turn_by_motion;
        // Moments are about the centre of mass at the end, whose place moves the turn by the forces' second integral as well. Without this a
        // grasp, of whose centre of mass little is known, does not settle.
        let by_place = K * Matrix3::from(cross_matrix(missing[0]));
        for (column, by) in [(0, by_place), (3, by_place * self.after)] {
            let mut view = at.turn_by_motion.fixed_view_mut::<3, 3>(0, column);
            view += by;
        }
        if P > 0 {
            at.turn_by_body += by_turn * self.turn_by_body;
            let owed = body.by_inertia(&Turn { w: turn, ..self.turn });
            for (i, change) in owed.into_iter().enumerate() {
                let mut column = at.turn_by_body.column_mut(i + 1);
                column += Vector3::from(self.turn.K * change);
            }
        }
        at
    }
}

/// Orientation after `h` while the angular momentum goes from one value to another with given rates at both ends: the
/// commutator-free Lie group method of order 4 (Celledoni, Marthinsen, Owren 2003).
fn turned(q: DQuat, L: [DVec3; 2], rates: [DVec3; 2], body: &Body, h: f64) -> DQuat {
    let middle = 0.5 * (L[0] + L[1]) + (rates[0] - rates[1]) * (h / 8.0);
    let w = |q: DQuat, L: DVec3| body.spin(q, L);
    let k1 = w(q, L[0]);
    let half = exponential(k1 * (0.5 * h)) * q;
    let k2 = w(half, middle);
    let k3 = w(exponential(k2 * (0.5 * h)) * q, middle);
    let k4 = w(exponential((k3 - 0.5 * k1) * h) * half, L[1]);
    let first = exponential((3.0 * k1 + 2.0 * k2 + 2.0 * k3 - k4) * (h / 12.0));
    let second = exponential((-k1 + 2.0 * k2 + 2.0 * k3 + 3.0 * k4) * (h / 12.0));
    (second * (first * q)).normalize()
}
