//! Other motions that explain a log as well: a covariance tells of what is near the one that was found, and of no other.
//!
//! Readings that hardly change (at rest, of a disc, over a short time) are explained by motions far from each other. They are looked for
//! from starts of their own, motions that spin otherwise, all along or at an end, or are higher, and what the motion comes to of a body as it was expected; one that is
//! about as probable and farther away than deviations reach says that the log does not tell.

use super::body::{Body, CONSTANTS};
use super::cold;
use super::ends;
use super::expected::{as_expected, held_as_expected};
use super::problem::{Problem, Unknowns};
use super::redrawn::SMALL;
use super::samples::deviations;
use super::search::{ENOUGH, fine_within};
use super::solve::{Covariances, Solved, solve};
use super::surprise::surprise;
use crate::random::Normal;
use crate::reliability::Reason;
use glam::{DMat3, DVec3};
use nalgebra::SVector;
use object_dynamics::MassProperties;

/// What the spins of the starts in space are off by, in natural rates: motions that explain a log almost as well were seen to lie 0.2 apart and more.
const SHIFTED: [f64; 3] = [0.2, 0.3, 0.7];
/// How much higher the centre of mass is in other starts in the plane, natural lengths: of a body that hardly turns forces tell the line that it is on, and its
/// height last. A body was found 0.14 and 0.22 sizes off, with a misfit of 1.0 to 1.3, in 21 of 60 noises.
const HEIGHTS: [f64; 4] = [0.5, -0.5, 1.0, -1.0];
/// Of a short log that tells little of the body: spins that round bodies are flung with, up to so many natural ones. One in five leads to the most
/// probable motion, or one about as probable, and of thirteen such logs none of the others did in six.
const FLUNG: u32 = 24;
const FASTEST: f64 = 0.7;
const SEED: u64 = 0xf1;
/// Natural times up to which a log is short.
const SHORT: f64 = 12.0;
/// Linearisations that each may take, and after how many it is asked whether to go on; how many times as much as the best motion one may
/// leave by then.
const MOST: usize = 40;
const TRIED: usize = 12;
const HOPELESS: f64 = 3.0;
/// How often the better ones are looked for again from where a better one was found.
pub(super) const SEARCHES: usize = 3;
/// Fall of chi-squared that makes one motion the more probable one: odds of a thousand to one.
const MORE_PROBABLE: f64 = 13.8;
/// The same of the windows of a stream: twenty to one.
const MORE_PROBABLE_IN_WINDOW: f64 = 6.0;
/// Deviations from which on another motion is one that they do not reach, and within which it is the same.
const BEYOND: f64 = 5.0;
const SAME: f64 = 1.0;
/// Deviation of a constant of a body, as a share of what it is, or of a turn in rad, from which on other motions are looked for as a stream goes on.
const UNSURE: f64 = 0.1;

/// A motion, with the combinations of the body's constants that are held in it.
pub(super) type Rival = (Solved<CONSTANTS>, Vec<SVector<f64, CONSTANTS>>);

/// A motion that was decided on.
pub(super) struct Decided {
    pub(super) solved: Solved<CONSTANTS>,
    /// Of a linear model, in space, where there were others to compare it with.
    pub(super) covariances: Option<Covariances<CONSTANTS>>,
    /// Those that cannot be ruled out, nearly as probable and farther than deviations reach, the most probable first.
    pub(super) others: Vec<Rival>,
    /// By how many deviations the farthest of them is another one.
    pub(super) open: Option<Reason>,
}

impl Decided {
    /// Of one to which there is no other.
    fn alone(solved: Solved<CONSTANTS>) -> Self {
        Self { solved, covariances: None, others: Vec::new(), open: None }
    }
}

/// The most probable of the motions that are found, begun from the one that was found first. None where the equations are singular.
///
/// In space a body whose moments are known well has no others. Of one that is nearly round noise leaves the spin between palms without friction
/// open, which is felt through its inertia alone.
pub(super) fn decided(problem: &mut Problem, found: Solved<CONSTANTS>) -> Option<Decided> {
    if !problem.planar && well_known(problem, &found) {
        return Some(Decided::alone(found));
    }
    let mut all = vec![Weighed::of(problem, found)];
    let mut best = 0;
    let mut expected = None;
    for _ in 0..SEARCHES {
        let (solved, frozen) = &all[best].rival;
        problem.frozen.clone_from(frozen);
        let before = best;
        let covariances = solved.covariances(problem)?;
        let mut starts = starts(problem, solved, &covariances, round(&solved.unknowns.body));
        let found = solved.unknowns.clone();
        if !problem.planar && all.len() == 1 && is_short(problem) && is_unsure(problem, solved) {
            starts.extend(flung(problem));
        }
        expected = as_expected(problem, &found);
        starts.extend(expected.clone());
        for start in starts {
            problem.frozen.clear();
            let so_far = [before, best].map(|i| &all[i].rival.0);
            if let Some(other) = tried(problem, start, so_far, &covariances) {
                all.push(Weighed::of(problem, other));
                let last = all.len() - 1;
                // What was found first stays unless another one is clearly better: the best of several is no better for a share of a deviation.
                if all[last].surprise < all[best].surprise - 1.0 {
                    best = last;
                }
            }
        }
        if best == before || problem.planar || well_known(problem, &all[best].rival.0) {
            break;
        }
    }
    let held = expected.and_then(|start| held_as_expected(problem, &all[best].rival, start));
    if let Some((held, combinations)) = held {
        problem.frozen = combinations;
        best = all.len();
        all.push(Weighed::of(problem, held));
    }
    let best = all.swap_remove(best);
    problem.frozen.clone_from(&best.rival.1);
    among(problem, best, all)
}

/// A motion with what `surprise` says of it.
struct Weighed {
    rival: Rival,
    surprise: f64,
}

impl Weighed {
    /// Of a motion with what `problem` holds of the body in it.
    fn of(problem: &mut Problem, solved: Solved<CONSTANTS>) -> Self {
        let surprise = surprise(problem, &solved);
        Self { rival: (solved, problem.frozen.clone()), surprise }
    }
}

/// The best of several motions, and those of the others that cannot be ruled out beside it: by what they leave or by all near them, since the latter is no
/// better than a parabola fits.
fn among(problem: &Problem, best: Weighed, others: Vec<Weighed>) -> Option<Decided> {
    let (solved, least) = (best.rival.0, best.surprise);
    if others.is_empty() {
        return Some(Decided::alone(solved));
    }
    let mut covariances = solved.covariances(problem)?;
    let likely = |of: &Weighed| {
        (of.surprise - least).min(of.rival.0.equations.cost - solved.equations.cost) < MORE_PROBABLE
    };
    let mut open: Vec<Rival> = others.into_iter().filter(likely).map(|of| of.rival).collect();
    open.retain(|(other, _)| apart(&solved, other, &covariances) > BEYOND);
    // In the plane one is part of the same valley as far as motions reach whose spin is held off.
    if problem.planar && !open.is_empty() {
        covariances = covariances.reaching(problem, &solved);
        open.retain(|(other, _)| apart(&solved, other, &covariances) > BEYOND);
    }
    let farthest = open.iter().map(|(other, _)| apart(&solved, other, &covariances)).fold(0.0, f64::max);
    open.sort_by(|a, b| a.0.equations.cost.total_cmp(&b.0.equations.cost));
    let reason = (!open.is_empty()).then_some(Reason::Ambiguous { apart: farthest });
    // What is reported of the plane is widened at its end.
    let covariances = if problem.planar { None } else { Some(covariances) };
    Some(Decided { solved, covariances, others: open, open: reason })
}

/// Whether the less probable one of two motions cannot be ruled out, at odds of a thousand to one: by how many deviations it is another one.
/// None where it can, or where the equations are singular.
pub(super) fn as_probable(
    problem: &Problem,
    best: &Solved<CONSTANTS>,
    other: &Solved<CONSTANTS>,
) -> Option<Reason> {
    as_cheap(problem, best, other, MORE_PROBABLE)
}

/// The same of one that is dearer by less than `most`, in units of chi-squared.
fn as_cheap(
    problem: &Problem,
    best: &Solved<CONSTANTS>,
    other: &Solved<CONSTANTS>,
    most: f64,
) -> Option<Reason> {
    let likely = other.equations.cost < best.equations.cost + most;
    let apart = likely.then(|| Some(apart(best, other, &best.covariances(problem)?))).flatten()?;
    (apart > BEYOND).then_some(Reason::Ambiguous { apart })
}

/// Motions of a known body, whatever its axes, that are about as probable as the one that was found with certain axes, or more, and others; the
/// most probable first, with what is held of the body in each. `problem` is left with axes that may lie in any way.
pub(super) fn others_of_any_axes(
    problem: &mut Problem,
    known: &Solved<CONSTANTS>,
    mass: &MassProperties,
) -> Option<Vec<Rival>> {
    let covariances = known.covariances(problem)?;
    problem.take_any_axes(mass)?;
    let mut others: Vec<Rival> = Vec::new();
    for start in starts(problem, known, &covariances, problem.body.0) {
        problem.frozen.clear();
        let Some(other) = tried(problem, start, [known; 2], &covariances) else { continue };
        let likely = other.equations.cost < known.equations.cost + MORE_PROBABLE;
        let another = |of: &Solved<CONSTANTS>| apart(known, of, &covariances) > BEYOND;
        let found = |(of, _): &Rival| (of.equations.cost - other.equations.cost).abs() < ENOUGH[0];
        if likely && another(&other) && !others.iter().any(found) {
            others.push((other, problem.frozen.clone()));
        }
    }
    others.sort_by(|a, b| a.0.equations.cost.total_cmp(&b.0.equations.cost));
    Some(others)
}

/// Whether mass and inertia are known so well that there is nothing beyond first order.
pub(super) fn well_known(problem: &Problem, solved: &Solved<CONSTANTS>) -> bool {
    let claimed = solved.equations.covariance_of_body(&problem.natural_information());
    claimed.is_some_and(|claimed| claimed.diagonal().max() < SMALL * SMALL)
}

/// Whether mass, inertia or how a known body lies are known so badly that other motions may explain the log as well.
pub(super) fn is_unsure(problem: &Problem, solved: &Solved<CONSTANTS>) -> bool {
    let claimed = solved.equations.covariance_of_body(&problem.natural_information());
    let units = solved.unknowns.body.inertia_units();
    let share = |i: usize, variance: f64| variance / if i == 0 { 1.0 } else { units[i - 1] * units[i - 1] };
    claimed.is_none_or(|claimed| {
        claimed.diagonal().iter().enumerate().any(|(i, of)| share(i, *of) > UNSURE * UNSURE)
    })
}

/// Whether another motion of a stream's window cannot be ruled out: the windows before have spoken for the one that is followed.
pub(super) fn goes_on_beside(problem: &Problem, best: &Solved<CONSTANTS>, other: &Solved<CONSTANTS>) -> bool {
    as_cheap(problem, best, other, MORE_PROBABLE_IN_WINDOW).is_some()
}

/// Another motion of a stream's window that cannot be ruled out, from one of the other starts: of as many as there are each in turn.
pub(super) fn another(
    problem: &mut Problem,
    found: &Solved<CONSTANTS>,
    which: usize,
) -> Option<Solved<CONSTANTS>> {
    let covariances = found.covariances(problem)?;
    let mut starts = starts(problem, found, &covariances, found.unknowns.body);
    let start = starts.swap_remove(which.checked_rem(starts.len())?);
    problem.frozen.clear();
    let other = tried(problem, start, [found; 2], &covariances)?;
    goes_on_beside(problem, found, &other).then_some(other)
}

/// In the plane the motion with another spin at an end, with what follows from that, or at another height; in space the motion as it is, of `body`, that spins
/// otherwise.
fn starts(
    problem: &Problem,
    found: &Solved<CONSTANTS>,
    covariances: &Covariances<CONSTANTS>,
    body: Body,
) -> Vec<Unknowns> {
    if problem.planar {
        let mut all = ends::starts(problem, found, &covariances.chain);
        all.extend(displaced(problem, &found.unknowns));
        return all;
    }
    let rate = problem.units.speed / problem.units.length;
    let along = |shift: f64| DVec3::AXES.map(|axis| [axis * shift, axis * -shift]);
    let shifts = SHIFTED.into_iter().flat_map(along).flatten();
    shifts.map(|shift| cold::shifted(problem, &found.unknowns, body, shift * rate)).collect()
}

/// The motion in the plane of a body whose centre of mass is higher or lower.
fn displaced(problem: &Problem, found: &Unknowns) -> [Unknowns; HEIGHTS.len()] {
    let up = -problem.gravity.normalize_or_zero() * problem.units.length;
    HEIGHTS.map(|height| cold::displaced(problem, found, up * height))
}

/// Whether a log of an unknown body is one over which starts that differ much lead to motions that leave little.
pub(super) fn is_short(problem: &Problem) -> bool {
    problem.lasts() < SHORT
}

/// Bodies that are expected before a log is read, which turn at constant rates.
fn flung(problem: &Problem) -> Vec<Unknowns> {
    let mut random = Normal::seeded(SEED);
    let rate = FASTEST / problem.units.time();
    let one = |i: u32| {
        let along = DVec3::new(random.draw(), random.draw(), random.draw()).normalize_or_zero();
        let share = (f64::from(i) + 0.5) / f64::from(FLUNG);
        cold::turning(problem, problem.body.0, along * (share * rate))
    };
    (0..FLUNG).map(one).collect()
}

/// A body as heavy as another one, and round.
fn round(body: &Body) -> Body {
    let DMat3 { x_axis, y_axis, z_axis } = body.inertia();
    let moment = (x_axis.x + y_axis.y + z_axis.z) / 3.0;
    Body::free(body.log_mass, DMat3::from_diagonal(DVec3::splat(moment)))
}

/// Where a start leads; none where that leaves far more than the best motion so far, or back to the one that it was made of, whose covariances these are.
fn tried(
    problem: &mut Problem,
    start: Unknowns,
    [from, best]: [&Solved<CONSTANTS>; 2],
    covariances: &Covariances<CONSTANTS>,
) -> Option<Solved<CONSTANTS>> {
    let first = solve::<CONSTANTS>(problem, start, TRIED, ENOUGH[1])?;
    if first.equations.cost > HOPELESS * best.equations.cost || apart(from, &first, covariances) < SAME {
        return None;
    }
    fine_within(problem, first.unknowns, MOST)
}

/// Largest difference of positions and velocities of two motions, in deviations of the first.
fn apart(of: &Solved<CONSTANTS>, other: &Solved<CONSTANTS>, covariances: &Covariances<CONSTANTS>) -> f64 {
    let spin = |solved: &Solved<CONSTANTS>, j: usize| {
        let motion = &solved.unknowns.motions[j];
        solved.unknowns.body.spin(motion.q, motion.L)
    };
    let one = |j: usize| {
        let (here, there) = (&of.unknowns.motions[j], &other.unknowns.motions[j]);
        let [p, v, w, _] = deviations(here, &of.unknowns.body, j, covariances);
        let off = [(there.p - here.p, p), (there.v - here.v, v), (spin(other, j) - spin(of, j), w)];
        let share = |(off, of): (DVec3, DVec3)| off.abs() / of.max(DVec3::splat(f64::MIN_POSITIVE));
        off.into_iter().map(|off| share(off).max_element()).fold(0.0, f64::max)
    };
    (0..of.unknowns.motions.len()).map(one).fold(0.0, f64::max)
}
