//! Errors of the poses of all nodes together, for bounds on the shape.

use super::body::CONSTANTS;
use super::both::of_each;
use super::problem::{Problem, Unknowns};
use super::solve::{Covariances, Solved};
use super::state::Tangent;
use crate::random::Normal;
use crate::rigid::{DRAWS, PoseErrors, exponential, normals, root, turned};
use glam::{DQuat, DVec3};

/// Seed of what motions are drawn from.
const SEED: u64 = 0x6a01;
/// Natural times from node to node at which errors are kept, at least, and how many such times at most: between them errors go straight.
const SPACING: f64 = 0.08;
const KEPT: f64 = 400.0;

/// Joint errors of the poses at those nodes (by number) whose motion is relied on, in body axes that stand at `axes` in those of the first
/// sample, those of the body itself where it is `known`; all of them `wider` than the covariances say. None without such a node.
pub(super) fn pose_errors(
    problem: &Problem,
    solved: &Solved<CONSTANTS>,
    covariances: &Covariances<CONSTANTS>,
    relied_on: &[usize],
    (axes, known, wider): (DQuat, bool, f64),
) -> Option<PoseErrors> {
    let nodes = kept(problem, relied_on);
    let samples = problem.node_samples();
    let motions = &solved.unknowns.motions;
    let poses: Vec<_> = nodes.iter().map(|&j| (motions[j].p, (motions[j].q * axes).normalize())).collect();
    let (body, joint) = (root(&covariances.body), covariances.joint(&nodes));
    let draw = |number: usize| -> Vec<_> {
        let mut random = Normal::seeded(SEED.wrapping_add(number as u64));
        let mut constants = body * normals(&mut random);
        let mut steps = joint.draw(&constants, &mut random);
        for error in &covariances.errors {
            let by = random.draw();
            constants += error.body * by;
            steps.iter_mut().zip(&nodes).for_each(|(step, &j)| *step += error.motions[j] * by);
        }
        // Of a known body the last constants are how its own axes lie at the first sample.
        let lie = if known { DVec3::from_slice(&constants.as_slice()[4..7]) * wider } else { DVec3::ZERO };
        let own = (exponential(lie) * axes).normalize();
        let moved = |((j, (p, _)), step): ((&usize, &(DVec3, DQuat)), &Tangent)| {
            let part = |i: usize| DVec3::from_slice(&step.as_slice()[i..i + 3]) * wider;
            let [place, _, _, turn] = covariances.beyond(*j);
            (*p + part(0) * place, turned((motions[*j].q * own).normalize(), part(9) * turn))
        };
        nodes.iter().zip(&poses).zip(&steps).map(moved).collect()
    };
    let all = samples.last().map_or(0, |last| last + 1);
    let draws = of_each(all, &(0..DRAWS).collect::<Vec<_>>(), draw);
    let lasting = lasting(problem, solved);
    PoseErrors::from_draws(
        nodes.iter().map(|&j| samples[j]).collect(),
        &poses,
        draws.into_iter(),
        lasting,
        known,
    )
}

/// Of some nodes those at which errors are kept: apart by a share of the natural time at least, the first and the last among them.
fn kept(problem: &Problem, of: &[usize]) -> Vec<usize> {
    let time = |j: usize| problem.record.times[problem.nodes[j]];
    let (Some(&first), Some(&last)) = (of.first(), of.last()) else { return Vec::new() };
    let apart = (SPACING * problem.units.time()).max((time(last) - time(first)) / KEPT);
    let mut kept = vec![first];
    let mut before = time(first);
    for &j in of {
        if time(j) >= before + apart && time(last) >= time(j) + 0.5 * apart {
            kept.push(j);
            before = time(j);
        }
    }
    kept.push(last);
    kept.dedup();
    kept
}

/// Deviation of contacts, m, that would explain what is left of conditions that are not off by noise: soft contacts of simulators shift them so.
fn lasting(problem: &Problem, solved: &Solved<CONSTANTS>) -> f64 {
    if !problem.exact {
        return 0.0;
    }
    let Unknowns { motions, body } = &solved.unknowns;
    let squares: f64 = motions.iter().map(|m| body.spin(m.q, m.L).length_squared()).sum();
    let slowest = SLOWEST * problem.units.speed / problem.units.length;
    let spin = (squares / motions.len().max(1) as f64).sqrt().max(slowest);
    problem.noise.floor * solved.misfit().sqrt() / spin
}

/// Spin of a body, in natural ones, below which contacts are not blamed.
const SLOWEST: f64 = 0.1;
