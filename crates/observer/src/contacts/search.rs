//! From nothing to the most probable motion and body: coarse solutions first, then all nodes.

use super::backwards::backwards;
use super::body::CONSTANTS;
use super::cold;
use super::first::First;
use super::onward::{LONG, SHORT, is_too_long, onward};
use super::options::ContactOptions;
use super::plane;
use super::problem::{Problem, Units, Unknowns};
use super::record::Record;
use super::sharp::found;
use super::solve::{Solved, solve};
use glam::{DQuat, DVec3};
use nalgebra::{SMatrix, SVector};
use object_dynamics::ContactMode;

/// Natural times from node to node in the coarse solution at least, and in the last one at most: contacts between are carried there from the node
/// before. Forces without noise carry a motion farther.
const LINK: f64 = 0.08;
const LINK_OF_EXACT: f64 = 0.2;
/// Natural times from sample to sample in a record that is searched, if there are many more.
const THIN: f64 = 0.02;
const THIN_OF_EXACT: f64 = 0.04;
/// Floors of the coarse conditions over the natural speed: the first one finds nearly all motions, the other one some of the rest.
const COARSE_FLOORS: [f64; 2] = [1e-2, 1e-3];
/// Share of a condition's deviation, of all in a link together, that noise of the forces may make in it to be left out between nodes.
const NEGLIGIBLE: f64 = 0.1;
/// How much better the inertia is taken for known at first, in information.
const BALL: f64 = 30.0;
/// Linearisations that each of the solutions may take.
const MOST: usize = 60;
/// The same of the last solution, and of one with blows: where these are known by their impulses the chain is stiff and steps along a curved
/// valley are short. Of twelve falls seven settle within 60, all within 240.
const MOST_OF_LAST: usize = 150;
const MOST_OF_BLOWS: usize = 400;
/// Linearisations after which it is asked what of the inertia is learned.
const FIRST: usize = 12;
/// A step that promises less in units of chi-squared than these is not worth taking: coarse solution, last one.
pub(super) const ENOUGH: [f64; 2] = [1.0, 1e-2];
/// Share of their cost by which two solutions may differ to be taken for one.
const ALIKE: f64 = 1e-3;
/// Deviation of the logarithms of the roots of the second moments before the log is read, about those of a ball of the body's
/// size, and of that of the mass.
const PRIOR: f64 = 0.7;
const PRIOR_MASS: f64 = 10.0;

/// Where a search ended.
pub(super) struct Ended {
    pub(super) solved: Solved<CONSTANTS>,
    /// Whether there is nothing to look for beyond it; then the problem has conditions as good as what is left of it.
    pub(super) found: bool,
    /// Linearisations before the last solution.
    pub(super) before: usize,
    /// Whether searches on ways of their own came to it, so that there is nothing to look for on others though it is not explained.
    pub(super) agreed: bool,
}

impl Problem<'_> {
    /// Time from node to node, s.
    pub(super) fn link(&self) -> f64 {
        (if self.is_smooth() { LINK_OF_EXACT } else { LINK }) * self.units.time()
    }

    /// Whether forces carry the motion from sample to sample as well as noise nowhere does.
    pub(super) fn is_smooth(&self) -> bool {
        is_smooth(self.record, self.exact, self.planar)
    }
}

/// In space, without friction, where noise of the contacts is not what conditions are off by.
fn is_smooth(record: &Record, exact: bool, planar: bool) -> bool {
    exact && !planar && record.frictionless()
}

/// The record with fewer samples, if there are many more than a search needs.
pub(super) fn thinned(record: &Record, options: &ContactOptions, units: &Units) -> Option<Record> {
    let smooth = is_smooth(record, !options.noise.limits(units), options.planar);
    record.thinned(if smooth { THIN_OF_EXACT } else { THIN } * units.time())
}

impl Ended {
    /// At a solution, after so many linearisations.
    pub(super) fn at(problem: &mut Problem, solved: Solved<CONSTANTS>, before: usize) -> Self {
        let first = solved.iterations;
        let (solved, found) = found(problem, solved);
        Self { solved, found, before: if found { before + first } else { before }, agreed: false }
    }

    /// Linearisations.
    pub(super) fn all(&self) -> usize {
        self.before + self.solved.iterations
    }

    fn cost(&self) -> f64 {
        self.solved.equations.cost
    }

    /// Whether another one is the same solution: neither of both can be lowered, and they cost the same.
    fn agrees(&self, other: &Self) -> bool {
        let apart = (self.cost() - other.cost()).abs();
        self.solved.settled && other.solved.settled && apart < ALIKE * self.cost()
    }
}

/// The most probable motion and body from nothing; of a body in space without friction that is not explained from the end of the record as well.
pub(super) fn search(problem: &mut Problem) -> Option<Ended> {
    let ended = forwards(problem);
    if ended.as_ref().is_some_and(|ended| ended.found || ended.agreed)
        || problem.planar
        || !problem.record.frictionless()
    {
        return ended;
    }
    let (nodes, frozen) = (problem.nodes.clone(), problem.frozen.clone());
    let before = ended.as_ref().map_or(0, Ended::all);
    match backwards(problem) {
        Some(other) if other.found || ended.as_ref().is_none_or(|ended| other.cost() < ended.cost()) => {
            Some(Ended { before: other.before + before, ..other })
        }
        _ => {
            (problem.nodes, problem.frozen) = (nodes, frozen);
            ended
        }
    }
}

/// From the beginning on: of a long record over more and more of it, of others at once; where that is not explained a short one without friction
/// over more and more of it too, and the best is taken.
pub(super) fn forwards(problem: &mut Problem) -> Option<Ended> {
    let mut best = None;
    let mut before = 0;
    for way in [Some(&LONG), None, Some(&SHORT)] {
        let ended = match way {
            Some(way) if way.lasts.end.is_finite() && !problem.record.frictionless() => None,
            Some(way) => onward(problem, way),
            None if is_too_long(problem) => best.is_none().then(|| at_last(problem)).flatten(),
            None => whole(problem),
        };
        let Some(ended) = ended else { continue };
        if ended.found {
            return Some(Ended { before: before + ended.before, ..ended });
        }
        before += ended.all();
        keep(&mut best, ended, problem);
        if best.as_ref().is_some_and(|(best, _)| best.agreed) {
            break;
        }
    }
    let (best, frozen) = best?;
    (problem.nodes, problem.frozen) = (fine_nodes(problem), frozen);
    Some(Ended { before: before - best.solved.iterations, ..best })
}

/// A coarse solution from nothing and the last one from there, with one floor of the coarse conditions after the other until nothing better is to
/// be looked for, else the one that leaves least.
pub(super) fn whole(problem: &mut Problem) -> Option<Ended> {
    let coarse_nodes = problem.record.spaced(problem.link());
    let all_nodes = fine_nodes(problem);
    let mut best = None;
    let mut before = 0;
    for floor in COARSE_FLOORS {
        problem.nodes.clone_from(&coarse_nodes);
        problem.noise.floor = problem.floor.max(floor * problem.units.speed);
        problem.friction = true;
        problem.frozen.clear();
        let start = cold::start(problem, problem.body.0, DQuat::IDENTITY);
        let coarse = coarse(problem, start);
        problem.nodes.clone_from(&all_nodes);
        problem.noise.floor = problem.floor;
        problem.friction = false;
        let Some(coarse) = coarse else { continue };
        before += coarse.iterations;
        let start = refined(problem, &coarse_nodes, &coarse.unknowns);
        let Some(solved) = fine(problem, start) else { continue };
        let ended = Ended::at(problem, solved, before);
        if ended.found {
            return Some(ended);
        }
        before = ended.all();
        keep(&mut best, ended, problem);
    }
    let (best, frozen) = best?;
    problem.frozen = frozen;
    Some(Ended { before: before - best.solved.iterations, ..best })
}

/// What a few steps from nothing come to, where nothing is to be expected of a search: something that can be told of as what it is.
fn at_last(problem: &mut Problem) -> Option<Ended> {
    problem.nodes = fine_nodes(problem);
    let start = cold::start(problem, problem.body.0, DQuat::IDENTITY);
    let solved = solve::<CONSTANTS>(problem, start, FIRST, ENOUGH[0])?;
    Some(Ended { solved, found: false, before: 0, agreed: false })
}

/// What leaves least so far, with the combinations of the body's constants that are held in it.
type Best = Option<(Ended, Vec<SVector<f64, CONSTANTS>>)>;

/// Keeps what leaves less; two that agree are one. Not of exact logs: of one in 400 other ways led on where two agreed.
fn keep(best: &mut Best, mut ended: Ended, problem: &Problem) {
    if let Some((best, _)) = best.as_mut().filter(|_| !problem.exact) {
        ended.agreed |= best.agrees(&ended);
        best.agreed |= ended.agreed;
    }
    if best.as_ref().is_none_or(|(best, _)| ended.cost() < best.cost()) {
        *best = Some((ended, problem.frozen.clone()));
    }
}

/// First of a body that is nearly a ball: its angular velocity follows from the angular momentum whatever its orientation, and what has to be
/// found is the motion's start. Then of any body.
fn coarse(problem: &mut Problem, start: Unknowns) -> Option<Solved<CONSTANTS>> {
    let ball = of_ball(problem, start)?;
    let mut found = solve::<CONSTANTS>(problem, ball.unknowns, MOST, ENOUGH[0])?;
    found.iterations += ball.iterations;
    Some(found)
}

/// That of a body whose inertia is nearly the one that is expected beforehand.
pub(super) fn of_ball(problem: &mut Problem, start: Unknowns) -> Option<Solved<CONSTANTS>> {
    let known = problem.body.1;
    problem.body.1 = known * BALL;
    let ball = solve::<CONSTANTS>(problem, start, MOST, ENOUGH[0]);
    problem.body.1 = known;
    ball
}

/// The last solution, in which the inertia keeps its expected value along directions of which noise alone would tell.
pub(super) fn fine(problem: &mut Problem, start: Unknowns) -> Option<Solved<CONSTANTS>> {
    let most = if problem.record.has_blows() { MOST_OF_BLOWS } else { MOST_OF_LAST };
    fine_within(problem, start, most)
}

/// The same in so many linearisations beyond those after which it is asked what of the inertia is learned.
pub(super) fn fine_within(problem: &mut Problem, start: Unknowns, most: usize) -> Option<Solved<CONSTANTS>> {
    let first = solve::<CONSTANTS>(problem, start, FIRST, ENOUGH[1])?;
    let claimed = first.equations.covariances(&problem.natural_information());
    let frozen = claimed.and_then(|claimed| claimed.frozen(problem, &first.equations, &first.unknowns));
    problem.frozen = frozen.unwrap_or_default();
    if problem.frozen.is_empty() && first.settled {
        return Some(first);
    }
    let mut found = solve::<CONSTANTS>(problem, first.unknowns, most, ENOUGH[1])?;
    found.iterations += first.iterations;
    Some(found)
}

/// Nodes of the last solution: each sample, or as far apart as noise of the forces does nothing to the conditions between.
///
/// What noise of contacts does to a condition falls with the rate of the body: of one that rests, or rolls without slip, a condition may be as good as its
/// floor, and any noise of the forces is more than that. In the plane bodies rest and turn back, so that there each sample is a node.
pub(super) fn fine_nodes(problem: &Problem) -> Vec<usize> {
    nodes_within(problem, problem.link())
}

/// The same where forces are not known between samples: no farther apart than noisy ones.
pub(super) fn finest_nodes(problem: &Problem) -> Vec<usize> {
    nodes_within(problem, LINK * problem.units.time())
}

fn nodes_within(problem: &Problem, farthest: f64) -> Vec<usize> {
    let Problem { record, units, .. } = problem;
    let limit = (NEGLIGIBLE * problem.condition_deviation() * units.mass).powi(2);
    let last = record.times.len() - 1;
    let sticks = |k: usize| record.contacts[k].iter().any(|contact| contact.mode == ContactMode::Stick);
    let sharp = |k: usize| !problem.exact && (problem.planar || sticks(k));
    let (mut nodes, mut noise, mut conditions) = (vec![0], 0.0, 0.0);
    for k in 1..last {
        let interval = &record.intervals[k - 1];
        noise += interval.velocity_noise(units.length);
        conditions += record.contacts[k].len() as f64;
        let after = record.intervals[k].velocity_noise(units.length);
        let long = record.times[k + 1] - record.times[nodes[nodes.len() - 1]] > farthest;
        if long || interval.blow || sharp(k) || (noise + after) * conditions > limit {
            nodes.push(k);
            (noise, conditions) = (0.0, 0.0);
        }
    }
    nodes.push(last);
    nodes.dedup();
    nodes
}

pub(super) fn problem<'a>(record: &'a Record, options: &ContactOptions, units: Units) -> Problem<'a> {
    let Units { length, mass, .. } = units;
    let information = |deviation: f64| 1.0 / (deviation * deviation);
    // Entries beside the diagonal of the factor of the second moments are of the size of those on it.
    let entry = PRIOR * (0.2 * mass).sqrt() * length;
    let known = SVector::<f64, CONSTANTS>::from_fn(|i, _| match i {
        0 => information(PRIOR_MASS),
        1..=3 => information(PRIOR),
        _ => information(entry),
    });
    let body = match options.planar {
        true => plane::body(&cold::ball(&units), PRIOR_MASS, PRIOR),
        false => (cold::ball(&units), SMatrix::from_diagonal(&known)),
    };
    Problem {
        record,
        noise: options.noise,
        floor: options.noise.floor,
        exact: !options.noise.limits(&units),
        friction: false,
        gravity: DVec3::new(0.0, 0.0, -options.gravity),
        nodes: Vec::new(),
        frozen: Vec::new(),
        units,
        first: First::of_axes(DQuat::IDENTITY),
        body,
        planar: options.planar,
        shares: false,
        // Noise of nothing is explained, and chains with blows are stiff: steps along a curved valley are short there.
        patient: !options.noise.limits(&units) || record.has_blows(),
        missed: Vec::new(),
        held: None,
        blurred: Vec::new(),
    }
}

/// Motions at the nodes of `problem` by what was measured after the coarse node before each.
pub(super) fn refined(problem: &Problem, coarse: &[usize], unknowns: &Unknowns) -> Unknowns {
    let mut motions = Vec::with_capacity(problem.nodes.len());
    for (j, &from) in coarse.iter().enumerate() {
        let end = coarse.get(j + 1).copied().unwrap_or(from + 1);
        let place = |k: usize| problem.nodes.partition_point(|&node| node < k);
        let within = &problem.nodes[place(from)..place(end)];
        motions.extend(problem.carried(from, unknowns.motions[j], &unknowns.body, within));
    }
    Unknowns { motions, body: unknowns.body }
}
