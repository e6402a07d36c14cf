//! Least squares of the contact conditions with mass and inertia among the unknowns.
//!
//! The axes of the inertia tensor are the world's at the start, so that the orientation there is no unknown: 16 remain.

use crate::least_squares::{LeastSquares, NormalEquations};
use crate::three_palms::inertia::{inertia_of_numbers, inertia_slope};
use crate::three_palms::momentum::{Scales, StartState, by_state, momentum};
use crate::three_palms::polish::Conditions;
use crate::three_palms::sensitivity::{SensitivityStep, Turning};
use crate::three_palms::track::{Integrals, Track};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::SVector;
use object_dynamics::MassProperties;

/// Unknowns: centre of mass, velocity, angular momentum, mass, inertia.
pub(crate) const BODY_UNKNOWNS: usize = 16;
/// Place of the logarithm of the mass among them; the inertia's numbers follow.
pub(super) const MASS: usize = 9;
pub(super) type BodyRow = SVector<f64, BODY_UNKNOWNS>;
/// Mass and inertia.
const BODY_CONSTANTS: usize = BODY_UNKNOWNS - MASS;

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

/// What the sensitivities need at one time: of the orientation, and by mass and inertia the change of the angular momentum
/// that would turn the body as much.
struct BodyTurn {
    turning: Turning,
    by_body: [DVec3; BODY_CONSTANTS],
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
    fn turn(&self, q: DQuat, L: DVec3, [impulse, first_moment, _, curl]: &[DVec3; 4]) -> BodyTurn {
        let R = DMat3::from_quat(q);
        let turning = Turning::of(R, self.inverse_inertia, L, *impulse, *first_moment);
        let w_O = R.transpose() * turning.w;
        let by_body = std::array::from_fn(|j| match j {
            0 => *curl * self.inverse_mass,
            _ => -(R * (self.slopes[j - 1] * w_O)),
        });
        BodyTurn { turning, by_body }
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
        // Off the diagonal of the factor of the second moments: its own size, the root of a moment. Else logarithms.
        let root = (self.scales.momentum * self.scales.length / self.scales.velocity).sqrt();
        BodyRow::from_fn(|i, _| match i {
            i if i < MASS => blocks[i / 3],
            i if i > MASS + 3 => root,
            _ => 1.0,
        })
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
            let w = body.inverse_inertia * (q.conjugate() * L);
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
            let k2 = rate(q + k1 * (0.5 * h), middle_L);
            let q3 = q + k2 * (0.5 * h);
            let k3 = rate(q3, middle_L);
            let k4 = rate(q + k3 * h, end_L);
            q = (q + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)).normalize();
            L = end_L;
            visit(k, q, (q3.normalize(), middle_L));
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

    /// Calls `visit(k, rows, residuals)` at every sample: derivatives of the contact conditions by the scaled unknowns, and
    /// the conditions, m/s.
    fn each_row(&self, point: &BodyPoint, body: &Body, mut visit: impl FnMut(usize, [BodyRow; 3], [f64; 3])) {
        let sizes = self.sizes();
        let mut theta = BodySensitivity::at_start();
        let mut before: Option<BodyTurn> = None;
        self.walk(point, body, |k, q, (middle, middle_L)| {
            let (v, p, L) = self.kinematics(point, body, k);
            let Integrals { impulse, first_moment, moment, curl, .. } = self.track.integrals[k];
            let here = body.turn(q, L, &[impulse, first_moment, moment, curl]);
            if let Some(before) = &before {
                let halfway = body.turn(middle, middle_L, &self.track.middle[k - 1]);
                theta.advance([before, &halfway, &here], self.track.t[k] - self.track.t[k - 1]);
            }
            let rows = std::array::from_fn(|i| {
                let by_state = by_state(&self.track.nodes[k], i, p, L, &here.turning);
                self.row(k, &by_state, &here, &theta, body).component_mul(&sizes)
            });
            visit(k, rows, self.residuals(k, v, p, here.turning.w));
            before = Some(here);
        });
    }

    /// Derivatives of a contact condition by the unknowns from those by the state: `dp = dcm0 + t dv0 - travel dm / m^2`,
    /// `dL = dL0 + impulse x dcm0 + first_moment x dv0 + curl dm / m^2`.
    fn row(
        &self,
        k: usize,
        by_state: &[DVec3; 4],
        here: &BodyTurn,
        theta: &BodySensitivity,
        body: &Body,
    ) -> BodyRow {
        let [by_p, by_v, by_L, by_theta] = *by_state;
        let Turning { impulse, first_moment, .. } = here.turning;
        let t = self.track.t[k];
        let through = theta.blocks.map(|block| block.transpose() * by_theta);
        let p = by_p + by_L.cross(impulse) + through[0];
        let v = by_v + by_p * t + by_L.cross(first_moment) + through[1];
        let L = by_L + through[2];
        let mut row = BodyRow::zeros();
        row.as_mut_slice()[..9].copy_from_slice(&[p.x, p.y, p.z, v.x, v.y, v.z, L.x, L.y, L.z]);
        for j in 0..BODY_CONSTANTS {
            row[MASS + j] = by_theta.dot(theta.columns[j]) + by_L.dot(here.by_body[j]);
        }
        row[MASS] -= body.inverse_mass * (by_v.dot(impulse) + by_p.dot(self.travel(k)));
        row
    }
}

/// Derivatives of the orientation, a rotation vector in world axes, by the unknowns: centre of mass, velocity and angular
/// momentum at the start, then mass and inertia.
struct BodySensitivity {
    blocks: [DMat3; 3],
    columns: [DVec3; BODY_CONSTANTS],
}

impl BodySensitivity {
    fn at_start() -> Self {
        Self { blocks: [DMat3::ZERO; 3], columns: [DVec3::ZERO; BODY_CONSTANTS] }
    }

    fn advance(&mut self, turns: [&BodyTurn; 3], h: f64) {
        let [start, middle, end] = turns.map(|turn| &turn.turning);
        let step = SensitivityStep::new(start, middle, end, h);
        let [p, v, L] = self.blocks;
        self.blocks = [
            step.crossed(p, turns.map(|turn| turn.turning.impulse)),
            step.crossed(v, turns.map(|turn| turn.turning.first_moment)),
            step.turned(L),
        ];
        for (j, column) in self.columns.iter_mut().enumerate() {
            *column = step.column(*column, turns.map(|turn| turn.by_body[j]));
        }
    }
}

impl LeastSquares<BODY_UNKNOWNS> for BodyProblem<'_> {
    type Point = BodyPoint;

    fn linearise(&self, point: &BodyPoint) -> Option<NormalEquations<BODY_UNKNOWNS>> {
        let mut normal = NormalEquations::default();
        self.each_row(point, &self.body(point)?, |_, rows, residuals| {
            for (row, residual) in rows.iter().zip(residuals) {
                normal.add(row, residual);
            }
        });
        normal.cost.is_finite().then_some(normal)
    }

    fn cost(&self, point: &BodyPoint) -> Option<f64> {
        let body = self.body(point)?;
        let mut cost = 0.0;
        self.walk(point, &body, |k, q, _| {
            let (v, p, L) = self.kinematics(point, &body, k);
            let w = q * (body.inverse_inertia * (q.conjugate() * L));
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

impl Conditions<BODY_UNKNOWNS> for BodyProblem<'_> {
    fn conditions(&self, point: &BodyPoint) -> Option<Vec<[f64; 3]>> {
        let body = self.body(point)?;
        let mut all = Vec::with_capacity(self.end);
        self.walk(point, &body, |k, q, _| {
            let (v, p, L) = self.kinematics(point, &body, k);
            all.push(self.residuals(k, v, p, q * (body.inverse_inertia * (q.conjugate() * L))));
        });
        Some(all)
    }

    fn slopes(&self, point: &BodyPoint) -> Option<Vec<[BodyRow; 3]>> {
        let mut all = Vec::with_capacity(self.end);
        self.each_row(point, &self.body(point)?, |_, rows, _| all.push(rows));
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::three_palms::cold_start::scales;
    use crate::three_palms::inertia::numbers_of_inertia;
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
