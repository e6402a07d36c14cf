//! A known body in a short log: its motion is looked for with it, where without it none is found.
//!
//! Over less than a few natural times a log hardly tells an inertia. With that of a known body it tells the motion, from starts that lie
//! otherwise.

use super::axes::orientation;
use super::body::CONSTANTS;
use super::cold;
use super::problem::Problem;
use super::rivals::is_short;
use super::search::{ENOUGH, Ended, fine, fine_nodes, refined};
use super::solve::solve;
use glam::DQuat;
use object_dynamics::MassProperties;

/// Orientations that are begun from, of so many in all, and how many of them are followed.
const BEGUN: usize = 40;
const FOLLOWED: usize = 6;
/// Linearisations of a beginning, and what conditions are off by in it, as a share of the natural speed.
const MOST: usize = 20;
const FLOOR: f64 = 1e-2;

/// The motion of a body of the mass properties `mass` of which next to nothing is left; then the problem is that of the known body. None else, with
/// the problem as it was.
pub(super) fn directly(problem: &mut Problem, mass: &MassProperties) -> Option<Ended> {
    if !is_short(problem) {
        return None;
    }
    let before = (problem.body, problem.nodes.clone(), problem.frozen.clone());
    let (noise, mut iterations) = (problem.noise, 0);
    let mut begun = Vec::new();
    problem.nodes = problem.record.spaced(problem.link());
    problem.noise.floor = noise.floor.max(FLOOR * problem.units.speed);
    for i in 0..BEGUN {
        let body = problem.take_known(mass, orientation(i, BEGUN));
        let start = cold::start(problem, body, DQuat::IDENTITY);
        let Some(solved) = solve::<CONSTANTS>(problem, start, MOST, ENOUGH[0]) else { continue };
        iterations += solved.iterations;
        begun.push((solved, body));
    }
    begun.sort_by(|a, b| a.0.equations.cost.total_cmp(&b.0.equations.cost));
    problem.noise = noise;
    let all = fine_nodes(problem);
    let coarse = std::mem::replace(&mut problem.nodes, all);
    for (solved, body) in begun.into_iter().take(FOLLOWED) {
        problem.body.0 = body;
        problem.frozen.clear();
        let start = refined(problem, &coarse, &solved.unknowns);
        let Some(solved) = fine(problem, start) else { continue };
        let ended = Ended::at(problem, solved, iterations);
        if ended.found {
            return Some(ended);
        }
        iterations = ended.all();
    }
    (problem.body, problem.nodes, problem.frozen) = before;
    None
}
