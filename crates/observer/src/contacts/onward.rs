//! Long logs: a motion is found over their beginning and carried on, a few natural times at a time.
//!
//! What a start is wrong by the motion amplifies, so that over many natural times no search from nothing ends at the right one: of
//! clean logs at hand scale all are found over 15 natural times, and hardly any over 40.
//!
//! A window tells little of a body, and its axes drift from one to the next. All that was gone through is therefore solved at quarters of quarters of the record,
//! and the windows after know the body from there: the last solution then begins beside where it ends.

use super::beginning::Beginning;
use super::body::CONSTANTS;
use super::first::First;
use super::problem::{Beforehand, Problem, Unknowns};
use super::search::{ENOUGH, Ended, fine, fine_nodes, fine_within, refined, whole};
use super::solve::{Solved, solve};
use super::state::Motion;
use std::ops::Range;

/// Natural times of the window that a motion is solved over as it is carried on.
pub(in crate::contacts) const WINDOW: f64 = 20.0;
/// The same once the body is known from all before.
const WINDOW_OF_KNOWN: f64 = 8.0;
/// Deviation of how its axes lie at the beginning of such a window, rad.
const AXES: f64 = 0.3;
/// Linearisations within which a motion that goes on settles, beyond the first ones: most take four in all.
pub(in crate::contacts) const FOLLOWED: usize = 30;

/// Natural times over which hardly any motion is found from nothing.
const AT_ONCE: f64 = 40.0;
/// Chi-squared a condition of a window from which on a motion is lost.
const LOST: f64 = 10.0;

/// How a record is gone through, in natural times.
pub(super) struct Way {
    /// How much is searched from nothing: as much as the first of these whose solution is explained.
    beginnings: &'static [f64],
    /// By how much a motion is carried on.
    onward: f64,
    /// How long a record lasts.
    pub(super) lasts: Range<f64>,
}

/// Of a long record, and of a short one that is not explained when it is searched at once.
pub(super) const LONG: Way = Way { beginnings: &[8.0, 12.0, 20.0], onward: 4.0, lasts: 12.0..f64::INFINITY };
pub(super) const SHORT: Way = Way { beginnings: &[2.0, 3.0, 4.0, 6.0, 1.0], onward: 0.5, lasts: 1.0..12.0 };

/// Whether a record lasts so long that no search of all of it at once comes to its motion.
pub(super) fn is_too_long(problem: &Problem) -> bool {
    problem.lasts() > AT_ONCE
}

/// A solution of all of a record. None of one that lasts otherwise, or where no beginning is explained or a motion cannot be carried on.
pub(super) fn onward(problem: &mut Problem, way: &Way) -> Option<Ended> {
    if !way.lasts.contains(&problem.lasts()) {
        return None;
    }
    let nodes = fine_nodes(problem);
    let begun = beginning(problem, &nodes, way)?;
    carried_on(problem, nodes, begun, way.onward)
}

/// A solution of all of a record whose motion is known at its first samples. None where it is not known there, or cannot be carried on.
pub(super) fn resumed(problem: &mut Problem, from: &Beginning) -> Option<Ended> {
    let nodes = fine_nodes(problem);
    let body = from.body(problem);
    let motion = |&k: &usize| from.motion(problem.record.samples[k], problem.record.origin, &body);
    let motions: Vec<Motion> = nodes.iter().map_while(motion).collect();
    if motions.is_empty() {
        return None;
    }
    carried_on(problem, nodes, (Unknowns { motions, body }, 0), LONG.onward)
}

/// From motions at the first of `nodes`, found in so many linearisations, to a solution at all of them, so many natural times at once.
fn carried_on(
    problem: &mut Problem,
    nodes: Vec<usize>,
    (mut unknowns, mut iterations): (Unknowns, usize),
    onward: f64,
) -> Option<Ended> {
    let natural = problem.units.time();
    let times = &problem.record.times;
    let last = nodes.len() - 1;
    // The last solution is of four times as many nodes as the one before, and so on.
    let mut next = last >> (2 * (last / unknowns.motions.len()).max(1).ilog(4));
    let mut known = None;
    while unknowns.motions.len() <= last {
        let at = unknowns.motions.len() - 1;
        let end = until(problem, &nodes, at, onward).max(at + 1);
        let motion = unknowns.motions[at];
        unknowns.motions.extend(problem.carried(nodes[at], motion, &unknowns.body, &nodes[at + 1..=end]));
        let window = if known.is_some() { WINDOW_OF_KNOWN } else { WINDOW };
        let from = nodes.partition_point(|&k| times[k] < times[nodes[end]] - window * natural).min(at);
        let solved = over(problem, &nodes[from..=end], &unknowns, from, known)?;
        iterations += solved.iterations;
        if solved.misfit() > LOST {
            return None;
        }
        unknowns.motions.truncate(from);
        unknowns.motions.extend(solved.unknowns.motions);
        unknowns.body = solved.unknowns.body;
        if from > 0 && end > next && 2 * end < last {
            let solved = over(problem, &nodes[..=end], &unknowns, 0, None)?;
            iterations += solved.iterations;
            let claimed = solved.equations.covariance_of_body(&problem.natural_information())?;
            known = Some((solved.unknowns.body, claimed.try_inverse()?));
            unknowns = solved.unknowns;
            while next <= end {
                next *= 4;
            }
        }
    }
    problem.nodes = nodes;
    problem.frozen.clear();
    let solved = fine(problem, unknowns)?;
    Some(Ended::at(problem, solved, iterations))
}

/// Motions at some nodes, of which the first is number `from`, of a body that is known beforehand as `problem` or `known` says.
fn over(
    problem: &Problem,
    nodes: &[usize],
    unknowns: &Unknowns,
    from: usize,
    known: Option<Beforehand>,
) -> Option<Solved<CONSTANTS>> {
    let part = problem.record.part(nodes[0]..nodes[nodes.len() - 1] + 1);
    let mut window = problem.on(&part);
    window.nodes = nodes.iter().map(|k| k - nodes[0]).collect();
    let q = unknowns.motions[from].q;
    window.first = First::of_axes(q);
    window.frozen.clear();
    let start = Unknowns { motions: unknowns.motions[from..].to_vec(), body: unknowns.body };
    let Some(known) = known else { return fine_within(&mut window, start, FOLLOWED) };
    window.body = known;
    // The axes are not where the window before had them: where a body is nearly round they would drift.
    window.first = First::turned(q, AXES);
    solve(&window, start, FOLLOWED, ENOUGH[0])
}

/// Motions at the first of `nodes`, by a search of a beginning that is explained.
fn beginning(problem: &mut Problem, nodes: &[usize], way: &Way) -> Option<(Unknowns, usize)> {
    let (mut best, mut iterations) = (None, 0);
    for &lasts in way.beginnings {
        let end = until(problem, nodes, 0, lasts);
        let part = problem.record.part(0..nodes[end] + 1);
        let mut window = problem.on(&part);
        let Some(ended) = whole(&mut window) else { continue };
        iterations += ended.all();
        if best.is_none() && ended.solved.explained() || ended.found {
            problem.nodes = nodes[..=end].to_vec();
            best = Some(refined(problem, &window.nodes, &ended.solved.unknowns));
        }
        if ended.found {
            break;
        }
    }
    Some((best?, iterations))
}

/// The last of `nodes` within so many natural times of node `from`.
fn until(problem: &Problem, nodes: &[usize], from: usize, lasts: f64) -> usize {
    let times = &problem.record.times;
    let end = times[nodes[from]] + lasts * problem.units.length / problem.units.speed;
    nodes.partition_point(|&k| times[k] <= end) - 1
}
