//! Logs as good as exact: what conditions are off by is told by what is left of them.
//!
//! A search needs conditions that give way. Where noise is not what they are off by, the motion that it finds leaves far less than that, and the
//! body may be held by what was known beforehand where the log knows better. Conditions are then as good as what is left of them, all that lasts
//! counted once.

use super::body::CONSTANTS;
use super::problem::{Problem, Units};
use super::rows::Rows;
use super::search::fine;
use super::solve::{Covariances, Solved, solve};
use crate::chance::lasting;
use crate::reliability::LARGEST_MISFIT;
use object_dynamics::MOST_PALMS;

/// Best conditions, as a share of the natural speed: beyond, equations of some scenes are singular in double precision.
const BEST: f64 = 1e-8;
/// By how much conditions are taken to be better at least, as a trial.
const SHARPER: f64 = 0.1;
/// Linearisations of the very last solution, and what a step of it promises in units of chi-squared.
const LAST: usize = 8;
const ENOUGH: f64 = 1e-12;
/// How much worse conditions are taken to be where the equations are singular.
const BLUNTER: f64 = 10.0;

/// The solution with conditions as good, or as bad, as what is left of them, and its covariances. None where the equations are singular.
pub(super) fn sharpened(
    problem: &mut Problem,
    mut solved: Solved<CONSTANTS>,
) -> Option<(Solved<CONSTANTS>, Covariances<CONSTANTS>)> {
    let guessed = problem.noise.floor;
    let best = best(problem);
    while problem.noise.floor > best {
        let (before, frozen) = (problem.noise.floor, problem.frozen.clone());
        problem.noise.floor = (before * left(problem, &solved).min(SHARPER)).max(best);
        let better = fine(problem, solved.unknowns.clone());
        let Some(better) = better.filter(|better| better.misfit() < LARGEST_MISFIT) else {
            (problem.noise.floor, problem.frozen) = (before, frozen);
            break;
        };
        solved = better;
    }
    problem.noise.floor *= left(problem, &solved).max(1.0);
    loop {
        solved = solve::<CONSTANTS>(problem, solved.unknowns, LAST, ENOUGH)?;
        if let Some(covariances) = solved.covariances(problem) {
            return Some((solved, covariances));
        }
        // Rounding: with conditions that give way more the equations are farther from singular.
        problem.noise.floor *= BLUNTER;
        if problem.noise.floor > guessed {
            return None;
        }
    }
}

/// The solution with conditions as bad as all that is left of them, as if it were one error: what else is known is then held against deviations that
/// count it. The same where they are not. None where it cannot be evaluated.
pub(super) fn blunted(problem: &mut Problem, solved: Solved<CONSTANTS>) -> Option<Solved<CONSTANTS>> {
    let all = solved.equations.cost.sqrt();
    if all <= 1.0 {
        return Some(solved);
    }
    problem.noise.floor *= all;
    fine(problem, solved.unknowns)
}

fn best(problem: &Problem) -> f64 {
    let Units { length, speed, .. } = problem.units;
    (BEST * speed).max(problem.noise.contact * speed / length)
}

/// Whether conditions came out as good as they may: of a wrong motion over a short time more is left.
pub(super) fn is_sharp(problem: &Problem) -> bool {
    problem.noise.floor < 2.0 * best(problem)
}

/// What is left of the conditions in their deviations, if what lasts of it is one error and not many.
fn left(problem: &Problem, solved: &Solved<CONSTANTS>) -> f64 {
    let mut series: [Vec<f64>; MOST_PALMS] = Default::default();
    let motions = problem.at_all_samples(&solved.unknowns);
    for (contacts, motion) in problem.record.contacts.iter().zip(&motions) {
        let turn = solved.unknowns.body.turn(motion.q, motion.L);
        for contact in contacts {
            let rows = Rows::new(contact, motion, &turn, &problem.noise, problem.friction);
            series[contact.palm].extend(rows.map(|rows| rows.normal()));
        }
    }
    (solved.misfit() * lasting(&series)).sqrt()
}
