use super::cold;
use super::modes::by_ratio;
use super::options::{ContactEstimateError, ContactOptions, check};
use super::problem::{Problem, Units, Unknowns};
use super::record::Record;
use super::rows::Rows;
use super::solve::{Covariances, Solved, solve};
use super::state::{Body, MOTION, Motion, Tangent};
use super::windows::longest;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{SMatrix, SVector};
use object_dynamics::{BodyState, ContactLog, ContactMode, MOST_PALMS};
use std::ops::Range;

/// Constants of an unknown body: logarithm of the mass, six numbers of the inertia tensor.
const CONSTANTS: usize = 7;
/// Natural times from node to node in the first, coarse solution, whose contacts are carried there from the node before, and the
/// floor of its conditions over the natural speed.
const COARSE: f64 = 0.15;
const COARSE_FLOOR: f64 = 1e-3;
/// Linearisations that each of the two solutions may take.
const MOST: usize = 60;
/// A step that promises less in units of chi-squared than these is not worth taking: coarse solution, last one.
const ENOUGH: [f64; 2] = [1.0, 1e-2];
/// Deviation of the logarithms of the roots of the second moments before the log is read, about those of a ball of the body's
/// size, and of that of the mass.
const PRIOR: f64 = 0.7;
const PRIOR_MASS: f64 = 10.0;
/// Deviation of the first orientation, rad: an unknown body has no axes but those it is given.
const FIRST_TURN: f64 = 1e-5;

/// Natural times on either side over which the ratio of friction to normal force is averaged, to tell modes.
const AVERAGED: f64 = 0.12;
/// Conditions of a contact that sticks are contradicted beyond this: three numbers in their deviations go there once in a million.
const CONTRADICTED: f64 = 30.7;
/// How often modes are taken back.
const ROUNDS: usize = 6;

/// Motion, mass and inertia of an unknown body.
#[derive(Clone, Debug)]
pub struct ContactEstimate {
    /// Motion at the nodes; body axes are those of the world at the first one.
    pub states: Vec<BodyState>,
    /// Standard deviations there: centre of mass (m), velocity (m/s), angular velocity (rad/s), turn (rad), world axes.
    pub deviations: Vec<[DVec3; 4]>,
    /// Sample of each node.
    pub nodes: Vec<usize>,
    /// Contact modes at all samples: those that were given, or the estimated ones.
    pub modes: Vec<[ContactMode; MOST_PALMS]>,
    /// Mass, kg.
    pub mass: f64,
    /// Standard deviation of the logarithm of the mass.
    pub mass_deviation: f64,
    /// Inertia about the centre of mass, body axes, kg m^2.
    pub inertia: DMat3,
    /// Standard deviations of the logarithms of the roots of the second moments: beyond 1 nothing was learned.
    pub inertia_deviations: [f64; 3],
    /// Linearisations: coarse, all.
    pub iterations: [usize; 2],
    /// Whether there was no more to gain.
    pub settled: bool,
    /// Squared residuals in units of their deviations, and how many conditions there are.
    pub chi_squared: f64,
    /// Contact conditions.
    pub conditions: usize,
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
    let mut problem = problem(record, options, length);
    let record = record.averaged(longest(&options.noise, &problem.units));
    problem.record = &record;
    problem.nodes = spaced(&record.times, COARSE * problem.units.length / problem.units.speed);
    problem.noise.floor = problem.noise.floor.max(COARSE_FLOOR * problem.units.speed);
    problem.friction = true;
    let start = cold::start(&problem, problem.body.0, DQuat::IDENTITY);
    let coarse =
        solve::<CONSTANTS>(&problem, start, MOST, ENOUGH[0]).ok_or(ContactEstimateError::Singular)?;
    let coarse_nodes = std::mem::replace(&mut problem.nodes, (0..record.times.len()).collect());
    problem.noise = options.noise;
    problem.friction = false;
    let start = refined(&problem, &coarse_nodes, &coarse.unknowns);
    let mut solved =
        solve::<CONSTANTS>(&problem, start, MOST, ENOUGH[1]).ok_or(ContactEstimateError::Singular)?;
    let unit = problem.natural_information();
    let covariances = solved.equations.covariances(&unit);
    let covariances = covariances.and_then(|claimed| claimed.widened(&solved.equations, &solved.unknowns));
    let covariances = covariances.ok_or(ContactEstimateError::Singular)?;
    solved.unknowns.motions = problem.at_samples(&solved.unknowns);
    let slips = slips(&problem, &solved.unknowns);
    Ok((estimate(&record, modes, solved, &covariances, coarse.iterations), slips))
}

fn slips(problem: &Problem, at: &Unknowns) -> Slips {
    let record = problem.record;
    let mut slips = Vec::new();
    for (j, motion) in at.motions.iter().enumerate() {
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

/// Samples at least `apart` from each other, the first and the last among them.
fn spaced(times: &[f64], apart: f64) -> Vec<usize> {
    let last = times.len() - 1;
    let mut nodes = vec![0];
    for k in 1..last {
        if times[k] - times[nodes[nodes.len() - 1]] >= apart {
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
    let known = SVector::from_fn(|i, _| match i {
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
        units: Units { length, speed: (options.gravity * length).sqrt(), mass },
        first: (none, Tangent::from_fn(|i, _| if i < 9 { 0.0 } else { information(FIRST_TURN) })),
        body: (body, known),
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
    record: &Record,
    modes: Vec<[ContactMode; MOST_PALMS]>,
    solved: Solved<CONSTANTS>,
    covariances: &Covariances<CONSTANTS>,
    coarse: usize,
) -> ContactEstimate {
    let Solved { unknowns, equations, iterations, settled } = solved;
    let body = &unknowns.body;
    let state = |motion: &Motion| BodyState {
        p_WCm: motion.p + record.origin,
        v_WCm: motion.v,
        w_WO: body.turn(motion.q, motion.L).w,
        R_WO: motion.q,
    };
    let of = |(motion, (own, follows)): (&Motion, &(_, _))| {
        deviations(motion, body, own, follows, &covariances.body)
    };
    let deviation = |i: usize| covariances.body[(i, i)].max(0.0).sqrt();
    ContactEstimate {
        states: unknowns.motions.iter().map(state).collect(),
        deviations: unknowns.motions.iter().zip(&covariances.motions).map(of).collect(),
        nodes: record.samples.clone(),
        modes,
        mass: body.log_mass.exp(),
        mass_deviation: deviation(0),
        inertia: body.inertia(),
        inertia_deviations: [deviation(1), deviation(2), deviation(3)],
        iterations: [coarse, coarse + iterations],
        settled,
        chi_squared: equations.cost,
        conditions: equations.conditions,
    }
}

/// With the angular velocity in place of the angular momentum.
fn deviations(
    motion: &Motion,
    body: &Body,
    own: &SMatrix<f64, MOTION, MOTION>,
    follows: &SMatrix<f64, MOTION, CONSTANTS>,
    constants: &SMatrix<f64, CONSTANTS, CONSTANTS>,
) -> [DVec3; 4] {
    let (by_motion, by_body) = motion.spin_derivatives(body);
    let mut to = SMatrix::<f64, MOTION, MOTION>::identity();
    let mut through = SMatrix::<f64, MOTION, CONSTANTS>::zeros();
    to.fixed_view_mut::<3, MOTION>(6, 0).copy_from(&by_motion);
    through.fixed_view_mut::<3, 6>(6, 1).copy_from(&by_body);
    let by_constants = to * follows + through;
    let covariance = to * own * to.transpose() + by_constants * constants * by_constants.transpose();
    let deviation = |i: usize| covariance[(i, i)].max(0.0).sqrt();
    std::array::from_fn(|k| DVec3::new(deviation(3 * k), deviation(3 * k + 1), deviation(3 * k + 2)))
}
