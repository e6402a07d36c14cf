//! Least squares of the contact conditions with mass and inertia among the unknowns.
//!
//! The axes of the inertia tensor are the world's at the start, so that the orientation there is no unknown: 16 remain.

use crate::least_squares::{LeastSquares, NormalEquations};
use crate::three_palms::momentum::{Scales, StartState, momentum};
use crate::three_palms::sensitivity::cross_matrix;
use crate::three_palms::state_space::{BODY, Constant, inertia_of_numbers, inertia_slope};
use crate::three_palms::track::{Integrals, Track};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, SMatrix, SVector};
use object_dynamics::MassProperties;

/// Unknowns: centre of mass, velocity, angular momentum, mass, inertia.
pub(crate) const BODY_UNKNOWNS: usize = 16;
/// Place of the logarithm of the mass among them; the inertia's numbers follow.
pub(super) const MASS: usize = 9;
pub(super) type BodyRow = SVector<f64, BODY_UNKNOWNS>;
type Columns = SMatrix<f64, 3, BODY_UNKNOWNS>;

/// A motion's start, orientation apart, and the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BodyPoint {
    pub(crate) start: StartState,
    pub(crate) log_mass: f64,
    pub(crate) inertia: [f64; 6],
}

impl BodyPoint {
    /// The body, in world axes at the start; none where exponentials have left the numbers.
    pub(crate) fn mass(&self) -> Option<MassProperties> {
        MassProperties::new(self.log_mass.exp(), inertia_of_numbers(&self.inertia)).ok()
    }
}

/// Contact conditions over the first samples of a track.
pub(crate) struct BodyProblem<'a> {
    track: &'a Track,
    scales: Scales,
    end: usize,
}

/// What follows from a point and an orientation at one time.
struct Turn {
    K: DMat3,
    w: DVec3,
    R: DMat3,
}

/// A point with what does not change over the walk.
struct Body {
    inverse_mass: f64,
    /// Difference of the inverse mass from the track's.
    excess: f64,
    inverse_inertia: DMat3,
    slopes: [DMat3; 6],
}

impl Body {
    fn turn(&self, q: DQuat, L: DVec3) -> Turn {
        let R = DMat3::from_quat(q);
        let K = R * self.inverse_inertia * R.transpose();
        Turn { K, w: K * L, R }
    }

    /// Angular momentum from the integrals.
    fn momentum(&self, start: &StartState, integrals: &[DVec3; 4]) -> DVec3 {
        momentum(start, integrals) - self.excess * integrals[3]
    }
}

impl<'a> BodyProblem<'a> {
    /// Of the samples up to `window` seconds after the start.
    pub(crate) fn new(track: &'a Track, scales: Scales, window: f64) -> Self {
        let end = track.t.partition_point(|&t| t <= window + 1e-12).max(2).min(track.t.len());
        Self { track, scales, end }
    }

    /// Natural sizes of the unknowns.
    pub(super) fn sizes(&self) -> BodyRow {
        let blocks = self.scales.by_block();
        BodyRow::from_fn(|i, _| if i < MASS { blocks[i / 3] } else { BODY[i - MASS].scale(&self.scales) })
    }

    fn body(&self, point: &BodyPoint) -> Option<Body> {
        let inverse_mass = (-point.log_mass).exp();
        let inertia = inertia_of_numbers(&point.inertia);
        let inverse_inertia = inertia.inverse();
        let sound = inverse_mass.is_finite() && inverse_inertia.is_finite();
        sound.then(|| Body {
            inverse_mass,
            excess: inverse_mass - 1.0 / self.track.mass,
            inverse_inertia,
            slopes: std::array::from_fn(|k| inertia_slope(&point.inertia, k)),
        })
    }

    /// Travel by the impulses of a unit mass.
    fn travel(&self, k: usize) -> DVec3 {
        let t = self.track.t[k];
        (self.track.integrals[k].position - 0.5 * self.track.gravity * t * t) * self.track.mass
    }

    /// Velocity, position and angular momentum at a sample.
    fn kinematics(&self, point: &BodyPoint, body: &Body, k: usize) -> (DVec3, DVec3, DVec3) {
        let (start, t) = (&point.start, self.track.t[k]);
        let Integrals { impulse, first_moment, moment, velocity, position, curl, .. } =
            self.track.integrals[k];
        (
            start.v_WCm + velocity + body.excess * impulse,
            start.p_WCm + start.v_WCm * t + position + body.excess * self.travel(k),
            body.momentum(start, &[impulse, first_moment, moment, curl]),
        )
    }

    fn walk(&self, point: &BodyPoint, body: &Body, mut visit: impl FnMut(usize, DQuat, (DQuat, DVec3))) {
        let rate = |q: DQuat, L: DVec3| {
            let w = body.inverse_inertia * (q.inverse() * L);
            q * DQuat::from_xyzw(0.5 * w.x, 0.5 * w.y, 0.5 * w.z, 0.0)
        };
        let mut q = DQuat::IDENTITY;
        let mut L = point.start.L_WO;
        visit(0, q, (q, L));
        for k in 1..self.end {
            let h = self.track.t[k] - self.track.t[k - 1];
            let middle_L = body.momentum(&point.start, &self.track.middle[k - 1]);
            let end_L = self.kinematics(point, body, k).2;
            let k1 = rate(q, L);
            let k2 = rate((q + k1 * (0.5 * h)).normalize(), middle_L);
            let q3 = (q + k2 * (0.5 * h)).normalize();
            let k3 = rate(q3, middle_L);
            let k4 = rate((q + k3 * h).normalize(), end_L);
            q = (q + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)).normalize();
            L = end_L;
            visit(k, q, (q3, middle_L));
        }
    }

    /// Contact conditions at a sample, m/s.
    fn residuals(&self, k: usize, v: DVec3, p: DVec3, w: DVec3) -> [f64; 3] {
        let node = &self.track.nodes[k];
        std::array::from_fn(|i| {
            let n = node.palms[i].frame.n;
            n.dot(v) - w.dot(n.cross(node.p_WC[i] - p)) + node.lift[i]
        })
    }

    /// Derivative of the angular momentum by the unknowns.
    fn momentum_slope(&self, body: &Body, [impulse, first_moment, _, curl]: &[DVec3; 4]) -> Columns {
        let mut L = Columns::zeros();
        put(&mut L, 0, cross_matrix(*impulse));
        put(&mut L, 1, cross_matrix(*first_moment));
        put(&mut L, 2, DMat3::IDENTITY);
        L.set_column(MASS, &(*curl * body.inverse_mass).into());
        L
    }

    /// `M` and `S` of `theta' = M theta + S`.
    fn slope(&self, body: &Body, turn: &Turn, L: DVec3, by_L: &Columns) -> (Matrix3<f64>, Columns) {
        let mut source = *by_L;
        for (number, slope) in body.slopes.iter().enumerate() {
            let change = -(turn.R * (*slope * (turn.R.transpose() * turn.w)));
            source.set_column(MASS + 1 + number, &change.into());
        }
        (Matrix3::from(turn.K * cross_matrix(L)), Matrix3::from(turn.K) * source)
    }
}

fn put(columns: &mut Columns, block: usize, value: DMat3) {
    for (j, column) in [value.x_axis, value.y_axis, value.z_axis].into_iter().enumerate() {
        columns.set_column(3 * block + j, &column.into());
    }
}

fn vector(v: DVec3) -> SVector<f64, 3> {
    v.into()
}

impl LeastSquares<BODY_UNKNOWNS> for BodyProblem<'_> {
    type Point = BodyPoint;

    fn linearise(&self, point: &BodyPoint) -> Option<NormalEquations<BODY_UNKNOWNS>> {
        let body = self.body(point)?;
        let sizes = self.sizes();
        let mut normal = NormalEquations::default();
        let mut theta = Columns::zeros();
        let mut before: Option<(Matrix3<f64>, Columns)> = None;
        self.walk(point, &body, |k, q, (middle, middle_L)| {
            let (v, p, L) = self.kinematics(point, &body, k);
            let turn = body.turn(q, L);
            let Integrals { impulse, first_moment, moment, curl, .. } = self.track.integrals[k];
            let by_L = self.momentum_slope(&body, &[impulse, first_moment, moment, curl]);
            let here = self.slope(&body, &turn, L, &by_L);
            if let Some((m0, s0)) = &before {
                let h = self.track.t[k] - self.track.t[k - 1];
                let halfway = self.momentum_slope(&body, &self.track.middle[k - 1]);
                let (m1, s1) = self.slope(&body, &body.turn(middle, middle_L), middle_L, &halfway);
                let k1 = m0 * theta + s0;
                let k2 = m1 * (theta + k1 * (0.5 * h)) + s1;
                let k3 = m1 * (theta + k2 * (0.5 * h)) + s1;
                let k4 = here.0 * (theta + k3 * h) + here.1;
                theta += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
            }
            // dw = M theta - w x theta + S.
            let turning = here.0 * theta - Matrix3::from(cross_matrix(turn.w)) * theta + here.1;
            let (t, travel) = (self.track.t[k], self.travel(k));
            let values = self.residuals(k, v, p, turn.w);
            for i in 0..3 {
                let node = &self.track.nodes[k];
                let n = node.palms[i].frame.n;
                let a = n.cross(node.p_WC[i] - p);
                let by_p = turn.w.cross(n);
                let mut row: BodyRow = -(turning.transpose() * vector(a));
                for axis in 0..3 {
                    row[axis] += by_p[axis];
                    row[3 + axis] += n[axis] + t * by_p[axis];
                }
                row[MASS] -= body.inverse_mass * (n.dot(impulse) + by_p.dot(travel));
                normal.add(&row.component_mul(&sizes), values[i]);
            }
            before = Some(here);
        });
        normal.cost.is_finite().then_some(normal)
    }

    fn cost(&self, point: &BodyPoint) -> Option<f64> {
        let body = self.body(point)?;
        let mut cost = 0.0;
        self.walk(point, &body, |k, q, _| {
            let (v, p, L) = self.kinematics(point, &body, k);
            let w = q * (body.inverse_inertia * (q.inverse() * L));
            cost += self.residuals(k, v, p, w).iter().map(|e| e * e).sum::<f64>();
        });
        cost.is_finite().then_some(cost)
    }

    fn retract(&self, point: &BodyPoint, step: &BodyRow) -> BodyPoint {
        let step = step.component_mul(&self.sizes());
        let part = |block: usize| DVec3::new(step[3 * block], step[3 * block + 1], step[3 * block + 2]);
        let start = StartState {
            p_WCm: point.start.p_WCm + part(0),
            v_WCm: point.start.v_WCm + part(1),
            L_WO: point.start.L_WO + part(2),
            ..point.start
        };
        let inertia = std::array::from_fn(|k| point.inertia[k] + step[MASS + 1 + k]);
        BodyPoint { start, log_mass: point.log_mass + step[MASS], inertia }
    }
}

/// The constants in the order of the unknowns.
pub(super) fn constants() -> &'static [Constant] {
    &BODY
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::three_palms::cold_start::scales;
    use crate::three_palms::state_space::numbers_of_inertia;
    use crate::three_palms::test_scenes::on_swinging_palms;

    /// The gradient is that of the sum of squares, far from the solution, on moving palms, at a mass that is not the
    /// track's; and at the truth nothing is left.
    #[test]
    fn derivatives_are_those_of_the_sum_of_squares() {
        let (log, mass, gravity) = on_swinging_palms();
        let track = Track::new(&log, 1.0, gravity, None).unwrap();
        let sizes = scales(&track, &mass);
        let now = log.truth().unwrap()[0];
        let L_WO = mass.inertia() * now.w_WO;
        let truth = BodyPoint {
            start: StartState { p_WCm: now.p_WCm, v_WCm: now.v_WCm, L_WO, R_WO: DQuat::IDENTITY },
            log_mass: 1.3f64.ln(),
            inertia: numbers_of_inertia(mass.inertia()),
        };
        let problem = BodyProblem::new(&track, sizes, f64::INFINITY);
        assert!(problem.linearise(&truth).unwrap().rms() < 1e-9);
        let step = BodyRow::from_fn(|i, _| 0.1 * ((i * i + 1) as f64).sin());
        let point = problem.retract(&truth, &step);
        let normal = problem.linearise(&point).unwrap();
        for i in 0..BODY_UNKNOWNS {
            let unit = |h: f64| BodyRow::from_fn(|j, _| if i == j { h } else { 0.0 });
            let cost = |h: f64| problem.cost(&problem.retract(&point, &unit(h))).unwrap();
            let slope = (cost(1e-5) - cost(-1e-5)) / 2e-5;
            let error = (slope - 2.0 * normal.gradient[i]).abs();
            // Sensitivities have Runge-Kutta steps of their own: equal to their order.
            assert!(error < 1e-6 * normal.information.diagonal().max(), "{i}: {slope:e}, {error:e}");
        }
        // The same motion on a track of the right mass.
        let right = track.of_mass(1.3);
        assert!(BodyProblem::new(&right, sizes, f64::INFINITY).linearise(&truth).unwrap().rms() < 1e-9);
    }
}
