use super::cold;
use super::modes::by_ratio;
use super::options::{ContactEstimateError, ContactOptions, check};
use super::problem::{Problem, Unknowns};
use super::record::Record;
use super::rows::Rows;
use super::samples::at_all;
use super::search::{CONSTANTS, problem, search};
use super::solve::{Covariances, Solved};
use super::state::Motion;
use super::verdict::{ContactEvidence, relied_on, stretches};
use super::windows::longest;
use crate::three_palms::Reliability;
use glam::{DMat3, DVec3};
use object_dynamics::{BodyState, ContactLog, ContactMode, MOST_PALMS};
use std::ops::Range;

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

/// Motion, mass and inertia of an unknown body from contacts of any palms and their forces or impulses in three axes, from no guess, with
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
    check(log, &options.noise, modes)?;
    let mut record = Record::new(log, &options.noise).ok_or(ContactEstimateError::NoContact)?;
    let length = options.size.or_else(|| cold::size(&record)).ok_or(ContactEstimateError::NoSize)?;
    let ball = cold::ball(&record, options.gravity, length);
    let impulse = (options.gravity * length).sqrt() / ball.inverse_mass();
    record.mark_blows(impulse, impulse * length, options.gravity / ball.inverse_mass());
    match modes {
        Some(modes) => Ok(with_modes(&mut record, modes.to_vec(), options, length)?.0),
        None => with_estimated_modes(&mut record, options, length),
    }
}

/// With modes from the ratios of forces, those of the conditions that the motion contradicts taken back.
fn with_estimated_modes(
    record: &mut Record,
    options: &ContactOptions,
    length: f64,
) -> Result<ContactEstimate, ContactEstimateError> {
    let natural = length / (options.gravity * length).sqrt();
    let mut modes = by_ratio(record, AVERAGED * natural);
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
    let (solved, before) = search(&mut problem, options).ok_or(ContactEstimateError::Singular)?;
    let covariances = solved.equations.covariances(&problem.natural_information());
    let covariances =
        covariances.and_then(|claimed| claimed.widened(&problem, &solved.equations, &solved.unknowns));
    let covariances = covariances.ok_or(ContactEstimateError::Singular)?;
    let slips = slips(&problem, &solved.unknowns);
    let iterations = [before, before + solved.iterations];
    let found = estimate(log, &problem, modes, &solved, &covariances, iterations);
    Ok((found, slips))
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

fn estimate(
    log: &Record,
    problem: &Problem,
    modes: Vec<[ContactMode; MOST_PALMS]>,
    solved: &Solved<CONSTANTS>,
    covariances: &Covariances<CONSTANTS>,
    iterations: [usize; 2],
) -> ContactEstimate {
    let Solved { unknowns, equations, settled, .. } = solved;
    let body = &unknowns.body;
    let evidence = ContactEvidence {
        samples: log.times.len(),
        nodes: problem.nodes.len(),
        conditions: equations.conditions,
        misfit: solved.misfit(),
        iterations,
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
