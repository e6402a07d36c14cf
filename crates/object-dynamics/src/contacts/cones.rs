//! Forces of over-constrained sticking: of all that keep the motion, some inside of their friction cones.

use super::problem::{ContactProblem, Modes, Reaction};
use crate::ContactMode;
use glam::{DVec2, DVec3};
use nalgebra::{DMatrix, DVector};

/// Rounds of the projections. Where the cones have room for the forces some ten do; where they just touch, more than this are
/// taken for none.
const MOST_ROUNDS: u32 = 400;

/// Forces of the sticking contacts inside of their cones with the same effect on the body as those of `reaction`, or none.
///
/// Forces that keep the motion are an affine set (the squeezes between contacts are free), the cones a convex one: a point of
/// both by averaged alternating reflections, which find one wherever there is one (a second-order cone program without
/// an objective).
pub(crate) fn forces_in_cones(
    problem: &ContactProblem,
    modes: &Modes,
    reaction: &Reaction,
    slack: f64,
) -> Option<Reaction> {
    let sticking: Vec<usize> =
        (0..problem.contacts().len()).filter(|&i| modes[i] == ContactMode::Stick).collect();
    let n = 3 * sticking.len();
    // Wrench of the sticking forces, moments per mean lever so that both halves weigh the same.
    let lever =
        sticking.iter().map(|&i| problem.contacts()[i].b.length()).sum::<f64>() / sticking.len() as f64;
    // The force on a palm that gives way moves that palm: it is not free either.
    let wrench = DMatrix::from_fn(6 + n, n, |row, column| {
        let contact = &problem.contacts()[sticking[column / 3]];
        let axis = [contact.n, contact.t[0], contact.t[1]][column % 3];
        match row {
            0..3 => axis[row],
            3..6 => contact.b.cross(axis)[row - 3] / lever,
            _ if (row - 6) / 3 == column / 3 => contact.yields.direction(axis)[(row - 6) % 3],
            _ => 0.0,
        }
    });
    let held = DVector::from_fn(n, |k, _| {
        let contact = &problem.contacts()[sticking[k / 3]];
        reaction.forces[sticking[k / 3]].dot([contact.n, contact.t[0], contact.t[1]][k % 3])
    });
    let inverse = wrench.clone().pseudo_inverse(1e-10).ok()?;
    let onto_held = &inverse * &wrench;
    let onto_motion = |x: &DVector<f64>| x - &onto_held * (x - &held);
    let onto_cones = |x: &DVector<f64>| {
        let mut y = x.clone();
        for (k, &i) in sticking.iter().enumerate() {
            let part = onto_cone([x[3 * k], x[3 * k + 1], x[3 * k + 2]], problem.contacts()[i].friction);
            y.as_mut_slice()[3 * k..3 * k + 3].copy_from_slice(&part);
        }
        y
    };
    let mut x = held.clone();
    for _ in 0..MOST_ROUNDS {
        let inside = onto_cones(&x);
        let moved = onto_motion(&(&inside * 2.0 - &x));
        let off = &moved - &inside;
        if off.amax() <= slack {
            return Some(with_forces(problem, reaction, &sticking, &inside));
        }
        x += off;
    }
    None
}

fn with_forces(
    problem: &ContactProblem,
    reaction: &Reaction,
    sticking: &[usize],
    x: &DVector<f64>,
) -> Reaction {
    let mut forces = reaction.forces;
    for (k, &i) in sticking.iter().enumerate() {
        let contact = &problem.contacts()[i];
        let tangent: DVec3 = contact.along_tangent(DVec2::new(x[3 * k + 1], x[3 * k + 2]));
        forces[i] = x[3 * k] * contact.n + tangent;
    }
    // The accelerations stay: these forces have the same wrench.
    Reaction { forces, ..*reaction }
}

/// The point of the cone `|tangent| <= mu normal` that is nearest to a force `[normal, tangent, tangent]`.
fn onto_cone(force: [f64; 3], mu: f64) -> [f64; 3] {
    let [normal, a, b] = force;
    let tangent = DVec2::new(a, b).length();
    if tangent <= mu * normal {
        return force;
    }
    if mu * tangent <= -normal {
        return [0.0; 3];
    }
    let along = (normal + mu * tangent) / (1.0 + mu * mu);
    // `tangent` is above zero here: it exceeds `mu normal`, and a negative normal with no tangent was sent to the apex.
    let share = mu * along / tangent;
    [along, a * share, b * share]
}
