use super::cold;
use super::modes::by_ratio;
use super::options::{ContactEstimateError, ContactOptions, check};
use super::problem::{Problem, Units, Unknowns};
use super::record::Record;
use super::rows::Rows;
use super::samples::at_all;
use super::solve::{Covariances, Solved, solve};
use super::state::{Motion, Tangent};
use super::verdict::{ContactEvidence, relied_on, stretches};
use super::windows::longest;
use crate::three_palms::{LARGEST_MISFIT, Reliability};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{SMatrix, SVector};
use object_dynamics::{BodyState, ContactLog, ContactMode, MOST_PALMS};
use std::ops::Range;

/// Constants of an unknown body: logarithm of the mass, six numbers of the inertia tensor.
const CONSTANTS: usize = 7;
/// Natural times from node to node in the coarse solution, whose contacts are carried there from the node before, and the
/// floors of its conditions over the natural speed: the first one finds nearly all motions, the other one some of the rest.
const COARSE: f64 = 0.08;
const COARSE_FLOORS: [f64; 2] = [1e-2, 1e-3];
/// How much better the inertia is taken for known at first, in information.
const BALL: f64 = 30.0;
/// Linearisations that each of the solutions may take.
const MOST: usize = 60;
/// Linearisations after which it is asked what of the inertia is learned.
const FIRST: usize = 12;
/// A step that promises less in units of chi-squared than these is not worth taking: coarse solution, last one.
const ENOUGH: [f64; 2] = [1.0, 1e-2];
/// Deviation of the logarithms of the roots of the second moments before the log is read, about those of a ball of the body's
/// size, and of that of the mass.
const PRIOR: f64 = 0.7;
const PRIOR_MASS: f64 = 10.0;
/// Deviation of the first orientation, rad: an unknown body has no axes but those it is given.
const FIRST_TURN: f64 = 1e-5;

/// Share of the information of natural units that may be added at each node against rounding.
const MENDED: f64 = 1e-3;
/// Natural times on either side over which the ratio of friction to normal force is averaged, to tell modes.
const AVERAGED: f64 = 0.12;
/// Conditions of a contact that sticks are contradicted beyond this: three numbers in their deviations go there once in a million.
const CONTRADICTED: f64 = 30.7;
/// How often modes are taken back.
const ROUNDS: usize = 6;

/// Motion, mass and inertia of an unknown body.
#[derive(Clone, Debug)]
pub struct ContactEstimate {
    /// Motion at all samples; body axes are those of the world at the first one.
    pub states: Vec<BodyState>,
    /// Standard deviations there: centre of mass (m), velocity (m/s), angular velocity (rad/s), turn since the first sample (rad), world axes.
    pub deviations: Vec<[DVec3; 4]>,
    /// Whether a sample's motion is to be relied on: to within its deviations.
    pub relied_on: Vec<bool>,
    /// Contact modes at all samples: those that were given, or the estimated ones.
    pub modes: Vec<[ContactMode; MOST_PALMS]>,
    /// Mass, kg.
    pub mass: f64,
    /// Standard deviation of the logarithm of the mass.
    pub mass_deviation: f64,
    /// Inertia about the centre of mass, body axes, kg m^2.
    pub inertia: DMat3,
    /// Standard deviations of the logarithms of the roots of the second moments: beyond 0.5 nothing much was learned.
    pub inertia_deviations: [f64; 3],
    /// Whether to believe it.
    pub reliability: Reliability,
    /// What it rests on.
    pub evidence: ContactEvidence,
}

/// Motion, mass and inertia of an unknown body from contacts of any palms and their forces in three axes, from no guess, with
/// the contact modes at all samples if they are known (`contacts.md`, sections 5 and 8).
///
/// Nodes hold the motion, one a sample or one for a few samples whose contacts are averaged; measured impulses link them, and
/// contacts are conditions on it. What is minimised is the squared distance of the true readings from the measured ones in
/// their deviations: contacts and impulses are adjusted with the motion.
///
/// # Errors
/// [`ContactEstimateError`] where the log lacks what is needed.
pub fn estimate_contacts(
    log: &ContactLog,
    modes: Option<&[[ContactMode; MOST_PALMS]]>,
    options: &ContactOptions,
) -> Result<ContactEstimate, ContactEstimateError> {
    options.check()?;
    check(log, modes)?;
    let mut record = Record::new(log, &options.noise).ok_or(ContactEstimateError::NoContact)?;
    let length = options.size.or_else(|| cold::size(&record)).ok_or(ContactEstimateError::NoSize)?;
    let ball = cold::ball(&record, options.gravity, length);
    let impulse = (options.gravity * length).sqrt() / ball.inverse_mass();
    record.free_blows(impulse, impulse * length, options.gravity / ball.inverse_mass());
    match modes {
        Some(modes) => Ok(with_modes(&mut record, modes.to_vec(), options, length)?.0),
        None => with_estimated_modes(log, &mut record, options, length),
    }
}

/// With modes from the ratios of forces, those of the conditions that the motion contradicts taken back.
fn with_estimated_modes(
    log: &ContactLog,
    record: &mut Record,
    options: &ContactOptions,
    length: f64,
) -> Result<ContactEstimate, ContactEstimateError> {
    let natural = length / (options.gravity * length).sqrt();
    let mut modes = by_ratio(log, &options.noise, AVERAGED * natural);
    for _ in 0..ROUNDS {
        let (found, slips) = with_modes(record, modes, options, length)?;
        if slips.is_empty() {
            return Ok(found);
        }
        modes = found.modes;
        for (samples, palm) in slips {
            for mode in modes[samples].iter_mut().map(|modes| &mut modes[palm]) {
                *mode = if *mode == ContactMode::Off { ContactMode::Off } else { ContactMode::Slide };
            }
        }
    }
    Ok(with_modes(record, modes, options, length)?.0)
}

/// Samples at which the motion contradicts that a contact sticks, and the palm.
type Slips = Vec<(Range<usize>, usize)>;

fn with_modes(
    record: &mut Record,
    modes: Vec<[ContactMode; MOST_PALMS]>,
    options: &ContactOptions,
    length: f64,
) -> Result<(ContactEstimate, Slips), ContactEstimateError> {
    record.set_modes(&modes);
    let log = &*record;
    let mut problem = problem(log, options, length);
    let averaged = log.averaged(longest(&options.noise, &problem.units));
    problem.record = &averaged;
    let (solved, coarse) = search(&mut problem, options).ok_or(ContactEstimateError::Singular)?;
    let covariances = solved.equations.covariances(&problem.natural_information());
    let covariances =
        covariances.and_then(|claimed| claimed.widened(&problem, &solved.equations, &solved.unknowns));
    let covariances = covariances.ok_or(ContactEstimateError::Singular)?;
    let slips = slips(&problem, &solved.unknowns);
    let found = estimate(log, &problem, modes, &solved, &covariances, coarse);
    Ok((found, slips))
}

/// A coarse solution from nothing and the last one from there, with one floor of the coarse conditions after the other until noise explains
/// what is left, else the one that leaves least; and the linearisations before the last solution.
fn search(problem: &mut Problem, options: &ContactOptions) -> Option<(Solved<CONSTANTS>, usize)> {
    let times = &problem.record.times;
    let coarse_nodes = spaced(problem.record, COARSE * problem.units.length / problem.units.speed);
    let all_nodes: Vec<usize> = (0..times.len()).collect();
    let mut best: Option<Solved<CONSTANTS>> = None;
    let mut before = 0;
    for floor in COARSE_FLOORS {
        problem.nodes.clone_from(&coarse_nodes);
        problem.noise.floor = options.noise.floor.max(floor * problem.units.speed);
        problem.friction = true;
        problem.frozen.clear();
        let start = cold::start(problem, problem.body.0, DQuat::IDENTITY);
        let coarse = coarse(problem, start);
        problem.nodes.clone_from(&all_nodes);
        problem.noise = options.noise;
        problem.friction = false;
        let Some(coarse) = coarse else { continue };
        let start = refined(problem, &coarse_nodes, &coarse.unknowns);
        before += coarse.iterations;
        let Some(found) = fine(problem, start) else { continue };
        if found.settled && found.misfit() < LARGEST_MISFIT {
            return Some((found, before));
        }
        let better = best.as_ref().is_none_or(|best| found.equations.cost < best.equations.cost);
        before += best.as_ref().map_or(0, |best| best.iterations);
        if better {
            best = Some(found);
        }
    }
    best.map(|best| (best, before))
}

/// First of a body that is nearly a ball: its angular velocity follows from the angular momentum whatever its orientation, and what has to be
/// found is the motion's start. Then of any body.
fn coarse(problem: &mut Problem, start: Unknowns) -> Option<Solved<CONSTANTS>> {
    let known = problem.body.1;
    problem.body.1 = known * BALL;
    let ball = solve::<CONSTANTS>(problem, start, MOST, ENOUGH[0]);
    problem.body.1 = known;
    let ball = ball?;
    let mut found = solve::<CONSTANTS>(problem, ball.unknowns, MOST, ENOUGH[0])?;
    found.iterations += ball.iterations;
    Some(found)
}

/// The last solution, in which the inertia keeps its expected value along directions of which noise alone would tell.
fn fine(problem: &mut Problem, start: Unknowns) -> Option<Solved<CONSTANTS>> {
    let first = solve::<CONSTANTS>(problem, start, FIRST, ENOUGH[1])?;
    let claimed = first.equations.covariances(&problem.natural_information())?;
    let frozen = claimed.frozen(&first.equations, &first.unknowns)?;
    problem.frozen = frozen;
    let mut found = solve::<CONSTANTS>(problem, first.unknowns, MOST, ENOUGH[1])?;
    found.iterations += first.iterations;
    Some(found)
}

fn slips(problem: &Problem, at: &Unknowns) -> Slips {
    let record = problem.record;
    let mut slips = Vec::new();
    for (j, motion) in problem.at_samples(at).iter().enumerate() {
        let turn = at.body.turn(motion.q, motion.L);
        let from = record.samples[j.saturating_sub(1)];
        let to = record.samples.get(j + 1).copied().unwrap_or(record.samples[j]);
        for contact in record.contacts[j].iter().filter(|c| c.mode == ContactMode::Stick) {
            let rows = Rows::new(contact, motion, &turn, &problem.noise, false);
            if rows.is_some_and(|rows| rows.cost() > CONTRADICTED) {
                slips.push((from..to + 1, contact.palm));
            }
        }
    }
    slips
}

/// Samples at least `apart` from each other, the first and the last among them, and those after blows.
fn spaced(record: &Record, apart: f64) -> Vec<usize> {
    let times = &record.times;
    let last = times.len() - 1;
    let mut nodes = vec![0];
    for k in 1..last {
        if record.intervals[k - 1].blow || times[k] - times[nodes[nodes.len() - 1]] >= apart {
            nodes.push(k);
        }
    }
    nodes.push(last);
    nodes.dedup();
    nodes
}

fn problem<'a>(record: &'a Record, options: &ContactOptions, length: f64) -> Problem<'a> {
    let body = cold::ball(record, options.gravity, length);
    let none = Motion { p: DVec3::ZERO, v: DVec3::ZERO, L: DVec3::ZERO, q: DQuat::IDENTITY };
    let information = |deviation: f64| 1.0 / (deviation * deviation);
    let mass = body.log_mass.exp();
    // Entries beside the diagonal of the factor of the second moments are of the size of those on it.
    let entry = PRIOR * (0.2 * mass).sqrt() * length;
    let known = SVector::<f64, CONSTANTS>::from_fn(|i, _| match i {
        0 => information(PRIOR_MASS),
        1..=3 => information(PRIOR),
        _ => information(entry),
    });
    Problem {
        record,
        noise: options.noise,
        friction: false,
        gravity: DVec3::new(0.0, 0.0, -options.gravity),
        nodes: Vec::new(),
        frozen: Vec::new(),
        units: Units { length, speed: (options.gravity * length).sqrt(), mass },
        first: (none, Tangent::from_fn(|i, _| if i < 9 { 0.0 } else { information(FIRST_TURN) })),
        body: (body, SMatrix::from_diagonal(&known)),
    }
}

/// Motions at the nodes of `problem` by what was measured after the coarse node before each.
fn refined(problem: &Problem, coarse: &[usize], unknowns: &Unknowns) -> Unknowns {
    let mut motions = Vec::with_capacity(problem.nodes.len());
    for (j, &from) in coarse.iter().enumerate() {
        let end = coarse.get(j + 1).copied().unwrap_or(from + 1);
        let within: Vec<usize> = problem.nodes.iter().copied().filter(|k| (from..end).contains(k)).collect();
        motions.extend(problem.carried(from, unknowns.motions[j], &unknowns.body, &within));
    }
    Unknowns { motions, body: unknowns.body }
}

fn estimate(
    log: &Record,
    problem: &Problem,
    modes: Vec<[ContactMode; MOST_PALMS]>,
    solved: &Solved<CONSTANTS>,
    covariances: &Covariances<CONSTANTS>,
    coarse: usize,
) -> ContactEstimate {
    let Solved { unknowns, equations, iterations, settled } = solved;
    let body = &unknowns.body;
    let evidence = ContactEvidence {
        samples: log.times.len(),
        nodes: problem.nodes.len(),
        conditions: equations.conditions,
        misfit: solved.misfit(),
        iterations: [coarse, coarse + iterations],
        settled: *settled && covariances.mended <= MENDED,
    };
    let state = |motion: &Motion| BodyState {
        p_WCm: motion.p + log.origin,
        v_WCm: motion.v,
        w_WO: body.turn(motion.q, motion.L).w,
        R_WO: motion.q,
    };
    let (reliability, wider) = (evidence.reliability(), evidence.widening());
    let motion = at_all(log, problem, unknowns, covariances);
    let deviations: Vec<_> = motion.iter().map(|(_, of)| of.map(|of| of * wider)).collect();
    let excess = stretches(problem, equations);
    let one = |(k, of): (usize, &_)| {
        let j = problem.record.samples.partition_point(|&node| node <= k).saturating_sub(1);
        reliability.is_reliable() && relied_on(excess[j], of, &problem.units)
    };
    let deviation = |i: usize| covariances.body[(i, i)].max(0.0).sqrt() * wider;
    ContactEstimate {
        states: motion.iter().map(|(motion, _)| state(motion)).collect(),
        relied_on: deviations.iter().enumerate().map(one).collect(),
        deviations,
        modes,
        mass: body.log_mass.exp(),
        mass_deviation: deviation(0),
        inertia: body.inertia(),
        inertia_deviations: [deviation(1), deviation(2), deviation(3)],
        reliability,
        evidence,
    }
}
