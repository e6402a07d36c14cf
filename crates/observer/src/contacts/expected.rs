//! A body as it was expected before the log was read, where noise alone tells another one.
//!
//! A body of revolution whose spin about its axis is known no better than its moment about it leaves conditions as they are: what noise of the levers makes of
//! them is then all that tells, by far more than it should seem to. The motion that leaves least is far from the right one, at the end of a valley where the body
//! is hardly one any more. What the conditions tell without that noise is asked where the body is as it was expected.

use super::body::CONSTANTS;
use super::levers::{Levers, Spin, spins};
use super::problem::{Problem, Unknowns};
use super::rivals::Rival;
use super::search::{ENOUGH, of_ball};
use super::solve::{Solved, solve};
use super::spurious::KEPT;
use crate::reliability::LARGEST_MISFIT;
use nalgebra::SVector;

/// Linearisations of the motion with what is not told held.
const MOST: usize = 60;
/// By how many times what noise may make of it the motion that is held may be dearer.
const DEARER: f64 = 2.0;

/// The motion of a body whose inertia is nearly what was expected before the log was read: noise alone can pull one that hardly shows far from
/// there, to a spin that leaves less and is far less probable. None in the plane.
pub(super) fn as_expected(problem: &mut Problem, found: &Unknowns) -> Option<Unknowns> {
    if problem.planar {
        return None;
    }
    problem.frozen.clear();
    Some(of_ball(problem, found.with(problem.body.0))?.unknowns)
}

/// The motion of a body with those combinations of its constants held that noise alone tells of it, where it explains the log as well as noise can say; with these.
/// None where noise tells none. `start` is the motion [as expected](as_expected), `best` is the motion that leaves least, with what is held in it.
pub(super) fn held_as_expected(
    problem: &mut Problem,
    (best, frozen): &Rival,
    start: Unknowns,
) -> Option<Rival> {
    problem.frozen.clone_from(frozen);
    let of_best = problem.cost_of_log(best);
    problem.frozen.clear();
    problem.frozen = told_by_noise(problem, &start)?;
    let held = solve::<CONSTANTS>(problem, start, MOST, ENOUGH[1])?;
    if !held.settled || held.misfit() >= LARGEST_MISFIT {
        return None;
    }
    let dearer = problem.cost_of_log(&held) - of_best;
    let levers = Levers::new(problem, &held.unknowns);
    let [own, other] = [&held, best].map(|of: &Solved<CONSTANTS>| spins(&of.unknowns));
    let apart: Vec<Spin> = own.iter().zip(&other).map(|(own, other)| own - other).collect();
    let (added, chance) = levers.added(&apart);
    // Where less of the noise is there than was taken for it, a slower spin leaves less by that.
    let slower = (levers.added(&own).0 - levers.added(&other).0).max(0.0);
    let allowed = DEARER * (slower + 2.0 * added.sqrt() + chance);
    (dearer < allowed).then(|| (held, problem.frozen.clone()))
}

/// Combinations of the body's constants that are known better beforehand than from what conditions tell without noise of the levers; none where there
/// are none.
fn told_by_noise(problem: &Problem, at: &Unknowns) -> Option<Vec<SVector<f64, CONSTANTS>>> {
    let here = solve::<CONSTANTS>(problem, at.clone(), 1, ENOUGH[1])?;
    let (chain, _) = here.equations.solver(&problem.natural_information())?;
    let mut all = Vec::new();
    for claimed in Levers::new(problem, &here.unknowns).most_claimed(&here.unknowns, &chain) {
        let body = &claimed.step.body;
        // Held, the constants are the likeliest beforehand along the step, whatever the others are.
        let combination = problem.body.1 * body;
        let known = body.dot(&combination);
        if known < KEPT && known > claimed.left.powi(2) {
            all.push(combination / known.sqrt());
        }
    }
    (!all.is_empty()).then_some(all)
}
