//! The momentum form: position, velocity and angular momentum are affine in their initial values, and only the
//! orientation needs an integration. Its residual is the contact condition `e_i = n_i . v - w . (n_i x (c_i - p)) +
//! p_i = 0`, which no derivative of the data enters.

use super::covariance::Linearised;
use super::polish::Conditions;
use super::sensitivity::{Sensitivity, Turning, cross_matrix, exponential};
use super::track::{Integrals, Node, Track};
use crate::least_squares::{LeastSquares, NormalEquations};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{SMatrix, SVector};
use object_dynamics::MassProperties;
use std::ops::Range;

/// Number of unknowns: centre of mass, velocity, angular momentum, orientation.
pub(super) const UNKNOWNS: usize = 12;
pub(super) type Row = SVector<f64, UNKNOWNS>;
/// By position, velocity, angular momentum and orientation at a sample, world axes.
pub(super) type StateRow = SVector<f64, UNKNOWNS>;

/// Motion of the body at the start of a track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartState {
    /// Centre of mass, world, m.
    pub p_WCm: DVec3,
    /// Its velocity, world, m/s.
    pub v_WCm: DVec3,
    /// Angular momentum about the centre of mass, world axes, kg m^2/s.
    pub L_WO: DVec3,
    /// Orientation of the axes of the inertia tensor, body to world.
    pub R_WO: DQuat,
}

/// Motion at one sample of a track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionState {
    /// Time as in the log, s.
    pub t: f64,
    /// Centre of mass, world, m.
    pub p_WCm: DVec3,
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Velocity of the centre of mass, world, m/s.
    pub v_WCm: DVec3,
    /// Angular velocity, world axes, rad/s.
    pub w_WO: DVec3,
}

/// Natural sizes of the unknowns, by which they are scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Length, m: mean distance of the contacts from their mean.
    pub length: f64,
    /// Velocity, m/s.
    pub velocity: f64,
    /// Angular momentum, kg m^2/s.
    pub momentum: f64,
}

impl Scales {
    /// Of centre of mass, velocity, angular momentum and orientation.
    pub(super) fn by_block(&self) -> [f64; 4] {
        [self.length, self.velocity, self.momentum, 1.0]
    }
}

/// Least squares of the contact conditions over the first samples of a track.
pub(super) struct MomentumProblem<'a> {
    pub(super) track: &'a Track,
    pub(super) mass: &'a MassProperties,
    scales: Scales,
    pub(super) end: usize,
}

/// The part of a sample that follows from the start state and the orientation.
pub(super) struct Kinematics {
    pub(super) v: DVec3,
    pub(super) p: DVec3,
    pub(super) L: DVec3,
}

impl<'a> MomentumProblem<'a> {
    /// The contact conditions along a motion, m/s.
    pub(super) fn residuals_along(&self, motion: &[MotionState]) -> Vec<[f64; 3]> {
        let residual = |k: usize, m: &MotionState| {
            let at = Kinematics { v: m.v_WCm, p: m.p_WCm, L: DVec3::ZERO };
            std::array::from_fn(|i| self.residual(k, i, &at, m.w_WO))
        };
        motion.iter().enumerate().map(|(k, m)| residual(k, m)).collect()
    }

    /// Of the samples up to `window` seconds after the start.
    pub(super) fn new(track: &'a Track, mass: &'a MassProperties, scales: Scales, window: f64) -> Self {
        let end = track.t.partition_point(|&t| t <= window + 1e-12).max(2).min(track.t.len());
        Self { track, mass, scales, end }
    }

    /// Derivatives of the residuals by the contact coordinates `(s1, s2)` of palm `i` at sample `k`, rad/s: the rates
    /// at which the body turns against the palm about its tangents.
    pub(super) fn by_contact(&self, k: usize, i: usize, w: DVec3) -> [f64; 2] {
        let palm = &self.track.nodes[k].palms[i];
        // -w . (n x t1) = -w . t2; -w . (n x t2) = w . t1; and the palm's own speed: p = -rate s2.
        [-w.dot(palm.frame.t2), w.dot(palm.frame.t1) - palm.rate]
    }

    pub(super) fn kinematics(&self, start: &StartState, k: usize) -> Kinematics {
        let t = self.track.t[k];
        let Integrals { impulse, first_moment, moment, velocity, position, .. } = self.track.integrals[k];
        Kinematics {
            v: start.v_WCm + velocity,
            p: start.p_WCm + start.v_WCm * t + position,
            L: momentum(start, &[impulse, first_moment, moment, DVec3::ZERO]),
        }
    }

    /// Walks the orientation along the track: calls `visit(k, q, middle)` at each sample, with the orientation there
    /// and at the middle of the step that led to it.
    fn walk(&self, start: &StartState, visit: impl FnMut(usize, DQuat, DQuat)) {
        self.walk_part(start, start.R_WO, 0..self.end, visit);
    }

    /// The same over some of the samples, with the orientation `q` at the first of them.
    pub(super) fn walk_part(
        &self,
        start: &StartState,
        q: DQuat,
        samples: Range<usize>,
        mut visit: impl FnMut(usize, DQuat, DQuat),
    ) {
        let inverse = self.mass.inverse_inertia();
        let rate = |q: DQuat, L: DVec3| {
            let w = inverse * (q.conjugate() * L);
            q * DQuat::from_xyzw(0.5 * w.x, 0.5 * w.y, 0.5 * w.z, 0.0)
        };
        let first = samples.start;
        let mut q = q.normalize();
        let mut L = self.kinematics(start, first).L;
        visit(first, q, q);
        for k in first + 1..samples.end {
            let h = self.track.t[k] - self.track.t[k - 1];
            let middle_L = momentum(start, &self.track.middle[k - 1]);
            let end_L = self.kinematics(start, k).L;
            let k1 = rate(q, L);
            let k2 = rate(q + k1 * (0.5 * h), middle_L);
            let q3 = q + k2 * (0.5 * h);
            let k3 = rate(q3, middle_L);
            let k4 = rate(q + k3 * h, end_L);
            q = (q + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)).normalize();
            L = end_L;
            visit(k, q, q3.normalize());
        }
    }

    /// Contact condition of palm `i` at sample `k`, m/s.
    pub(super) fn residual(&self, k: usize, i: usize, at: &Kinematics, w: DVec3) -> f64 {
        let node = &self.track.nodes[k];
        let n = node.palms[i].frame.n;
        n.dot(at.v) - w.dot(n.cross(node.p_WC[i] - at.p)) + node.lift[i]
    }

    /// Motion at every sample of the window.
    pub(super) fn motion(&self, start: &StartState) -> Vec<MotionState> {
        let mut states = Vec::with_capacity(self.end);
        let times: Vec<f64> = self.track.times().take(self.end).collect();
        self.walk(start, |k, q, _| {
            let at = self.kinematics(start, k);
            let w_WO = q * (self.mass.inverse_inertia() * (q.inverse() * at.L));
            states.push(MotionState { t: times[k], p_WCm: at.p, R_WO: q, v_WCm: at.v, w_WO });
        });
        states
    }

    /// Motion at the last sample of the window.
    pub(super) fn end(&self, start: &StartState) -> StartState {
        let mut end = *start;
        self.walk(start, |k, q, _| {
            let at = self.kinematics(start, k);
            end = StartState { p_WCm: at.p, v_WCm: at.v, L_WO: at.L, R_WO: q };
        });
        end
    }

    /// Residuals in time order, palm by palm, m/s.
    pub(super) fn residuals(&self, start: &StartState) -> Vec<[f64; 3]> {
        let mut all = Vec::with_capacity(self.end);
        let inverse = self.mass.inverse_inertia();
        self.walk(start, |k, q, _| {
            let at = self.kinematics(start, k);
            let w = q * (inverse * (q.inverse() * at.L));
            all.push(std::array::from_fn(|i| self.residual(k, i, &at, w)));
        });
        all
    }

    /// Calls `visit(k, kinematics, turning, sensitivity)` at every sample.
    fn each_turning(
        &self,
        start: &StartState,
        mut visit: impl FnMut(usize, &Kinematics, &Turning, &Sensitivity),
    ) {
        let mut theta = Sensitivity::at_start();
        let mut before: Option<Turning> = None;
        self.walk(start, |k, q, middle| {
            let at = self.kinematics(start, k);
            let here = Turning::new(self.mass, q, at.L, &self.track.integrals[k]);
            if let Some(before) = &before {
                let halfway = &self.track.middle[k - 1];
                let mid = Turning::at(self.mass, middle, momentum(start, halfway), halfway[0], halfway[1]);
                theta.advance(before, &mid, &here, self.track.t[k] - self.track.t[k - 1]);
            }
            visit(k, &at, &here, &theta);
            before = Some(here);
        });
    }

    fn by_state(&self, k: usize, i: usize, at: &Kinematics, here: &Turning) -> [DVec3; 4] {
        by_state(&self.track.nodes[k], i, at.p, at.L, here)
    }

    /// The same by the scaled unknowns: `dp = dcm0 + t dv0`, `dL = dL0 + impulse x dcm0 + first_moment x dv0`.
    fn row(&self, k: usize, by_state: &[DVec3; 4], here: &Turning, theta: &Sensitivity) -> Row {
        let [by_p, by_v, by_L, by_theta] = *by_state;
        let t = self.track.t[k];
        let by_start = [
            by_p + by_L.cross(here.impulse) + theta.transposed(0, by_theta),
            by_v + by_p * t + by_L.cross(here.first_moment) + theta.transposed(1, by_theta),
            by_L + theta.transposed(2, by_theta),
            theta.transposed(3, by_theta),
        ];
        let [length, velocity, momentum, turn] = self.scales.by_block();
        let [p, v, L, theta] = by_start;
        stack([p * length, v * velocity, L * momentum, theta * turn])
    }

    /// The linearised motion with its noise inputs, sample by sample, and the derivatives of the residuals by the scaled
    /// unknowns.
    pub(super) fn linearised(&self, start: &StartState) -> (Vec<Linearised>, Vec<[Row; 3]>) {
        let mut all = Vec::with_capacity(self.end);
        let mut rows = Vec::with_capacity(self.end);
        self.each_turning(start, |k, at, here, theta| {
            let node = &self.track.nodes[k];
            let by_state = std::array::from_fn(|i| self.by_state(k, i, at, here));
            rows.push(std::array::from_fn(|i| self.row(k, &by_state[i], here, theta)));
            let step = if k + 1 < self.end { self.track.t[k + 1] - self.track.t[k] } else { 0.0 };
            let force = (0..3).map(|i| node.forces[i] * node.palms[i].frame.n).sum();
            let kick =
                |velocity: DVec3, momentum: DVec3| stack([DVec3::ZERO, velocity, momentum, DVec3::ZERO]);
            let axes = |i: usize| [node.palms[i].frame.t1, node.palms[i].frame.t2];
            all.push(Linearised {
                by_state: by_state.map(stack),
                by_contact: std::array::from_fn(|i| self.by_contact(k, i, here.w)),
                by_force: std::array::from_fn(|i| {
                    let n = node.palms[i].frame.n;
                    kick(n / self.mass.mass(), (node.p_WC[i] - at.p).cross(n))
                }),
                through_torque: std::array::from_fn(|i| {
                    axes(i).map(|t| kick(DVec3::ZERO, t.cross(node.forces[i] * node.palms[i].frame.n)))
                }),
                flow: flow(here, force),
                step,
            });
        });
        (all, rows)
    }
}

/// Derivatives of the contact condition of palm `i` by position, velocity, angular momentum and orientation:
/// `de = n . dv + (w x n) . dp - a . dw`, `a = n x b`, `dw = (K [L]x - [w]x) theta + K dL`.
pub(super) fn by_state(node: &Node, i: usize, p: DVec3, L: DVec3, here: &Turning) -> [DVec3; 4] {
    let n = node.palms[i].frame.n;
    let a = n.cross(node.p_WC[i] - p);
    // K is symmetric: -a . K x = by_L . x, and by_L . (L x theta) = theta . (by_L x L).
    let by_L = -(here.K * a);
    [here.w.cross(n), n, by_L, by_L.cross(L) + a.cross(here.w)]
}

fn stack([a, b, c, d]: [DVec3; 4]) -> StateRow {
    StateRow::from([a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z])
}

/// `dp' = dv`, `dL' = F x dp`, `theta' = M theta + K dL`.
fn flow(here: &Turning, force: DVec3) -> SMatrix<f64, UNKNOWNS, UNKNOWNS> {
    let mut flow = SMatrix::zeros();
    let mut put = |row: usize, column: usize, block: DMat3| {
        for j in 0..3 {
            for i in 0..3 {
                flow[(3 * row + i, 3 * column + j)] = block.col(j)[i];
            }
        }
    };
    put(0, 1, DMat3::IDENTITY);
    put(2, 0, cross_matrix(force));
    put(3, 2, here.K);
    put(3, 3, here.M);
    flow
}

/// `L0 + moment - cm0 x impulse - v0 x first_moment` from `[impulse, first moment, moment, ..]`.
pub(super) fn momentum(start: &StartState, [impulse, first_moment, moment, _]: &[DVec3; 4]) -> DVec3 {
    start.L_WO + *moment - start.p_WCm.cross(*impulse) - start.v_WCm.cross(*first_moment)
}

impl LeastSquares<UNKNOWNS> for MomentumProblem<'_> {
    type Point = StartState;

    fn linearise(&self, point: &StartState) -> Option<NormalEquations<UNKNOWNS>> {
        let mut normal = NormalEquations::default();
        self.each_turning(point, |k, at, here, theta| {
            for i in 0..3 {
                let row = self.row(k, &self.by_state(k, i, at, here), here, theta);
                normal.add(&row, self.residual(k, i, at, here.w));
            }
        });
        normal.cost.is_finite().then_some(normal)
    }

    fn cost(&self, point: &StartState) -> Option<f64> {
        let mut cost = 0.0;
        self.walk(point, |k, q, _| {
            let at = self.kinematics(point, k);
            let w = q * (self.mass.inverse_inertia() * (q.inverse() * at.L));
            for i in 0..3 {
                cost += self.residual(k, i, &at, w).powi(2);
            }
        });
        cost.is_finite().then_some(cost)
    }

    fn retract(&self, point: &StartState, step: &Row) -> StartState {
        let part = |block: usize| DVec3::new(step[3 * block], step[3 * block + 1], step[3 * block + 2]);
        StartState {
            p_WCm: point.p_WCm + self.scales.length * part(0),
            v_WCm: point.v_WCm + self.scales.velocity * part(1),
            L_WO: point.L_WO + self.scales.momentum * part(2),
            R_WO: (exponential(part(3)) * point.R_WO).normalize(),
        }
    }
}

impl Conditions<UNKNOWNS> for MomentumProblem<'_> {
    fn conditions(&self, point: &StartState) -> Option<Vec<[f64; 3]>> {
        Some(self.residuals(point))
    }

    fn slopes(&self, point: &StartState) -> Option<Vec<[Row; 3]>> {
        let mut all = Vec::with_capacity(self.end);
        self.each_turning(point, |k, at, here, theta| {
            all.push(std::array::from_fn(|i| self.row(k, &self.by_state(k, i, at, here), here, theta)));
        });
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::super::cold_start::scales;
    use super::*;
    use crate::three_palms::test_scenes::on_swinging_palms;

    /// `2 J' r` is the gradient of the sum of squares, away from the solution and on
    /// moving palms.
    #[test]
    fn derivatives_are_those_of_the_sum_of_squares() {
        let (log, mass, gravity) = on_swinging_palms();
        let track = Track::new(&log, mass.mass(), gravity, None).unwrap();
        let sizes = scales(&track, &mass);
        let truth = log.truth().unwrap()[0];
        let point = StartState {
            p_WCm: truth.p_WCm + DVec3::new(0.1, -0.2, 0.15),
            v_WCm: truth.v_WCm + DVec3::new(-0.1, 0.05, 0.1),
            L_WO: mass.inertia() * truth.w_WO * 1.1,
            R_WO: exponential(DVec3::new(0.2, -0.1, 0.3)) * truth.R_WO,
        };
        {
            let problem = MomentumProblem::new(&track, &mass, sizes, f64::INFINITY);
            let normal = problem.linearise(&point).unwrap();
            assert!((normal.cost - problem.cost(&point).unwrap()).abs() < 1e-12 * normal.cost.abs());
            for i in 0..UNKNOWNS {
                let step = |h: f64| Row::from_fn(|j, _| if i == j { h } else { 0.0 });
                let cost = |h: f64| problem.cost(&problem.retract(&point, &step(h))).unwrap();
                let slope = (cost(1e-5) - cost(-1e-5)) / 2e-5;
                // The sensitivities come from Runge-Kutta steps of their own: equal to their order, not to rounding.
                let error = (slope - 2.0 * normal.gradient[i]).abs();
                assert!(
                    error < 1e-6 * normal.information[(i, i)],
                    "unknown {i}: {slope} {}",
                    2.0 * normal.gradient[i]
                );
            }
        }
    }
}
