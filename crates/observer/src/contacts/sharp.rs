//! Logs as good as exact: what conditions are off by is told by what is left of them.
//!
//! A search needs conditions that give way. Where noise is not what they are off by, the motion that it finds leaves far less than that, and the
//! body may be held by what was known beforehand where the log knows better. Conditions are then as good as what is left of them, all that lasts
//! counted once. A wrong motion does not bear it.

use super::body::CONSTANTS;
use super::problem::{Problem, Units, Unknowns};
use super::search::{fine, fine_within};
use super::solve::{Covariances, Solved, solve};
use crate::chance::lasting;

/// Best conditions, as a share of the natural speed: beyond, equations of some scenes are singular in double precision.
const BEST: f64 = 1e-8;
/// What conditions without noise are off by at most where nothing better is looked for, as a share of the natural speed.
const NOTHING: f64 = 1e-6;
/// How much worse than the best it is not worth a trial of its own.
const NEARLY: f64 = 10.0;
/// By how much conditions are taken to be better at least, as a trial.
const SHARPER: f64 = 0.1;
/// Linearisations of a trial beyond the first ones.
const TRIED: usize = 20;
/// Linearisations of the very last solution, and what a step of it promises in units of chi-squared.
const LAST: usize = 8;
const ENOUGH: f64 = 1e-8;
/// How much worse conditions are taken to be where the equations are singular.
const BLUNTER: f64 = 10.0;

/// A solution, and whether there is nothing to look for beyond it: noise explains what is left of it; or, where noise is not what conditions are
/// off by, next to nothing is, with conditions that are then as good as that.
pub(super) fn found(problem: &mut Problem, solved: Solved<CONSTANTS>) -> (Solved<CONSTANTS>, bool) {
    if !problem.exact || !solved.explained() {
        let found = solved.explained();
        return (solved, found);
    }
    let before = (problem.noise.floor, problem.frozen.clone());
    let sharp = sharper(problem, solved.clone());
    if !leaves_something(problem) {
        return (sharp, true);
    }
    (problem.noise.floor, problem.frozen) = before;
    (solved, false)
}

/// The solution with conditions as good as what is left of them.
fn sharper(problem: &mut Problem, mut solved: Solved<CONSTANTS>) -> Solved<CONSTANTS> {
    let best = best(problem);
    while problem.noise.floor > best {
        let (before, frozen) = (problem.noise.floor, problem.frozen.clone());
        let next = (before * left(problem, &solved).min(SHARPER)).max(best);
        let tries = if next < NEARLY * best { [best, next] } else { [next; 2] };
        let sharper = tries.into_iter().take(1 + usize::from(tries[0] < next)).find_map(|floor| {
            problem.noise.floor = floor;
            problem.frozen.clone_from(&frozen);
            fine_within(problem, solved.unknowns.clone(), TRIED).filter(Solved::explained)
        });
        let Some(sharper) = sharper else {
            (problem.noise.floor, problem.frozen) = (before, frozen);
            break;
        };
        solved = sharper;
    }
    solved
}

/// The solution with conditions as good, or as bad, as what is left of them, and its covariances. None where the equations are singular.
pub(super) fn sharpened(
    problem: &mut Problem,
    solved: Solved<CONSTANTS>,
) -> Option<(Solved<CONSTANTS>, Covariances<CONSTANTS>)> {
    let mut solved = sharper(problem, solved);
    // Rounding: with conditions that give way more the equations are farther from singular.
    let mut blunter = left(problem, &solved);
    loop {
        if blunter > 1.0 {
            problem.noise.floor *= blunter;
            solved = solve::<CONSTANTS>(problem, solved.unknowns, LAST, ENOUGH)?;
        }
        if let Some(covariances) = solved.covariances(problem) {
            return Some((solved, covariances));
        }
        blunter = BLUNTER;
        if problem.noise.floor * blunter > problem.floor {
            return None;
        }
    }
}

/// The solution from a start near it, with conditions as good as they may be; where it does not bear that, as they were. None where it cannot be
/// evaluated.
pub(super) fn sharpest(problem: &mut Problem, start: Unknowns) -> Option<Solved<CONSTANTS>> {
    let floor = problem.noise.floor;
    problem.noise.floor = floor.min(best(problem));
    let sharp = solve::<CONSTANTS>(problem, start.clone(), LAST, ENOUGH).filter(Solved::explained);
    sharp.or_else(|| {
        problem.noise.floor = floor;
        problem.frozen.clear();
        fine(problem, start)
    })
}

/// The solution with conditions as bad as all that is left of them, as if it were one error: what else is known is then held against deviations that
/// count it. The same where they are not. None where it cannot be evaluated.
pub(super) fn blunted(problem: &mut Problem, solved: Solved<CONSTANTS>) -> Option<Solved<CONSTANTS>> {
    let all = problem.cost_of_log(&solved).sqrt();
    if all <= 1.0 {
        return Some(solved);
    }
    problem.noise.floor *= all;
    fine(problem, solved.unknowns)
}

/// The solution with conditions off by what was stated or guessed. None where it cannot be evaluated.
pub(super) fn stated(problem: &mut Problem, solved: Solved<CONSTANTS>) -> Option<Solved<CONSTANTS>> {
    problem.noise.floor = problem.floor;
    fine(problem, solved.unknowns)
}

/// Conditions cannot be taken to be better than that, m/s.
fn best(problem: &Problem) -> f64 {
    let Units { length, speed, .. } = problem.units;
    (BEST * speed).max(problem.noise.contact * speed / length)
}

/// Whether conditions came out worse than a search is content with.
pub(super) fn leaves_something(problem: &Problem) -> bool {
    problem.noise.floor > NOTHING * problem.units.speed
}

/// Whether conditions came out as good as they may: of a wrong motion over a short time more is left.
pub(super) fn is_sharp(problem: &Problem) -> bool {
    problem.noise.floor < 2.0 * best(problem)
}

/// Whether noise of the contacts, little as it is, is what is left: more of them then tell more.
pub(super) fn is_rounded(problem: &Problem) -> bool {
    is_sharp(problem) && best(problem) > BEST * problem.units.speed
}

/// What is left of the conditions in their deviations, if what lasts of it is one error and not many.
fn left(problem: &Problem, solved: &Solved<CONSTANTS>) -> f64 {
    let misfit = problem.cost_of_log(solved) / solved.equations.conditions.max(1) as f64;
    (misfit * lasting(&problem.conditions_left(&solved.unknowns), 0.0)).sqrt()
}
