//! How far a motion may be off that numbers with a covariance make.

use super::problem::{DIFFERENCE, Guess, Row, TouchProblem, UNKNOWNS};
use super::suspects::Wrong;
use glam::{DQuat, DVec3};
use nalgebra::SMatrix;
use object_dynamics::Instant;

/// Derivatives of what moves at an instant by one number: centre of mass, velocity, angular velocity, turn.
type Slope = [DVec3; 4];

/// Standard deviations at each of `nodes` nodes of centre of mass (m), velocity (m/s), angular velocity (rad/s) and turn since the first
/// node (rad), world axes, for the covariance by noise of steps from `point` in natural sizes and for what may be wrong beside it. None where steps next to
/// it make no motion.
pub(super) fn deviations(
    problem: &TouchProblem,
    point: &Guess,
    nodes: usize,
    covariance: &SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    wrong: &[Wrong],
) -> Option<Vec<[DVec3; 4]>> {
    let moved = |i: usize, h: f64| {
        problem.motion(&problem.retract_by(point, &Row::from_fn(|j, _| if i == j { h } else { 0.0 })), nodes)
    };
    let mut slopes: Vec<Vec<Slope>> = Vec::with_capacity(UNKNOWNS);
    for i in 0..UNKNOWNS {
        let (ahead, behind) = (moved(i, DIFFERENCE)?, moved(i, -DIFFERENCE)?);
        slopes.push(ahead.iter().zip(&behind).map(|(a, b)| slope(a, b)).collect());
    }
    let mut errors: Vec<Vec<Slope>> = Vec::with_capacity(wrong.len());
    for wrong in wrong {
        let moved = |share: f64| wrong.motion(problem, point, share, nodes);
        let (ahead, behind) = (moved(DIFFERENCE)?, moved(-DIFFERENCE)?);
        errors.push(ahead.iter().zip(&behind).map(|(a, b)| slope(a, b)).collect());
    }
    let deviation = |k: usize, what: usize, axis: usize| {
        let along = Row::from_fn(|i, _| slopes[i][k][what][axis]);
        let beside: f64 = errors.iter().map(|of| of[k][what][axis].powi(2)).sum();
        (along.dot(&(covariance * along)).max(0.0) + beside).sqrt()
    };
    let at = |k: usize| -> [DVec3; 4] {
        std::array::from_fn(|what| DVec3::from_array([0, 1, 2].map(|axis| deviation(k, what, axis))))
    };
    Some((0..nodes).map(at).collect())
}

/// By central differences of two steps either way.
fn slope(ahead: &Instant, behind: &Instant) -> Slope {
    let turn = turn_between(behind.R_WO, ahead.R_WO);
    let differences = [
        ahead.touch.p_WCm - behind.touch.p_WCm,
        ahead.rates.v_WCm - behind.rates.v_WCm,
        ahead.w_WO - behind.w_WO,
        turn,
    ];
    differences.map(|difference| difference / (2.0 * DIFFERENCE))
}

/// The small turn, world axes, that takes one orientation into another.
fn turn_between(from: DQuat, to: DQuat) -> DVec3 {
    let d = to * from.conjugate();
    2.0 * d.w.signum() * d.xyz()
}
