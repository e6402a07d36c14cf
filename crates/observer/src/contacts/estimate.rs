use super::axes::ANY_TURN;
use super::beginning::Beginning;
use super::body::{Body, CONSTANTS};
use super::both::both;
use super::cold;
use super::explanations::explanations;
use super::joint::pose_errors;
use super::lost::is_lost;
use super::mode_odds::{EstimatedModes, mode_odds};
use super::modes::by_ratio;
use super::options::{ContactEstimateError, ContactOptions, check};
use super::problem::{Problem, Units};
use super::record::Record;
use super::relabel::{apart, surer};
use super::rivals::is_short;
use super::rows::Rows;
use super::samples::{Deviations, at_all, poses_at_all};
use super::search::{problem, thinned};
use super::sharp::{is_rounded, is_sharp, leaves_something};
use super::slips::Known;
use super::solve::{Covariances, Solved, Step};
use super::stage::Stage;
use super::state::Motion;
use super::suspects::{Readings, Scores, Sensors, suspects};
use super::verdict::{ContactEvidence, relied_on, stretches};
use super::windows::{Window, longest, windows};
use crate::faults::{Explanation, Suspect};
use crate::reliability::{Reason, Reliability};
use crate::rigid::PoseErrors;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix6, Vector6};
use object_dynamics::{BodyState, ContactLog, ContactMode, MOST_PALMS, MassProperties, Rhythm};
use std::ops::Range;

/// Share of the information of natural units that may be added at each node against rounding.
const MENDED: f64 = 1e-3;
/// Natural times on either side over which the ratio of friction to normal force is averaged, to tell modes.
pub(super) const AVERAGED: f64 = 0.12;
/// Conditions of a contact that sticks are contradicted beyond this: three numbers in their deviations go there once in a million.
const CONTRADICTED: f64 = 30.7;
/// Natural times that a log must last at least, unless next to nothing is left of it: over less, the motion is hardly more than its start.
const SHORTEST: f64 = 4.0;
/// The same where noise is not what is left, but more than rounding is: over 2.1 of them wrong motions were seen that leave next to nothing.
const SHORTEST_OF_EXACT: f64 = 3.0;
/// The same of an unknown body where what is left is more than the search is content with: over 5.0 of them a wrong motion left 5e-5 of the natural speed.
const SHORTEST_OF_ROUGH: f64 = 6.0;
/// Natural times from sample to sample at most: of logs with 0.5 and 1 in the plane one in twenty was another motion, in silence; with 0.2 none of 40.
const SPARSEST: f64 = 0.4;
/// How often modes are taken back.
const ROUNDS: usize = 6;

/// Motion, mass and inertia of an unknown body.
#[derive(Clone, Debug)]
pub struct ContactEstimate {
    /// Motion at all samples; axes of an unknown body are those of the world at the first one, those of a known one its own, up to half
    /// turns about principal axes, which leave no trace.
    pub states: Vec<BodyState>,
    /// Standard deviations there: centre of mass (m), velocity (m/s), angular velocity (rad/s), turn since the first sample (rad), world axes.
    pub deviations: Vec<[DVec3; 4]>,
    /// Whether a sample's motion is to be relied on: to within its deviations.
    pub relied_on: Vec<bool>,
    /// Contact modes at all samples: those that were given, or the estimated ones, the most probable where probabilities are asked for.
    pub modes: Vec<[ContactMode; MOST_PALMS]>,
    /// How probable the modes are, of palms with friction; none unless asked for.
    pub mode_odds: Option<EstimatedModes>,
    /// Mass, kg.
    pub mass: f64,
    /// Of a known body, standard deviations of how its own axes lie at the first sample, rad about the axes of the world: beyond 1 nothing is
    /// known of that. None of an unknown body, whose axes are the world's there.
    pub axes_deviations: Option<DVec3>,
    /// Standard deviation of the logarithm of the mass; of a known body as good as none.
    pub mass_deviation: f64,
    /// Inertia about the centre of mass, body axes, kg m^2.
    pub inertia: DMat3,
    /// Covariance of its entries xx, yy, zz, xy, xz, yz, (kg m^2)^2; zero of a known body.
    pub inertia_covariance: [[f64; 6]; 6],
    /// Standard deviations of the logarithms of the roots of the second moments: beyond 0.5 nothing much was learned.
    pub inertia_deviations: [f64; 3],
    /// How far the poses that are relied on may be off, all of them together, for bounds on the shape; none unless asked for.
    pub pose_errors: Option<PoseErrors>,
    /// Covariances of the pose at all samples: centre of mass (m), turn since the first sample (rad), world axes. None unless asked for.
    pub pose_covariances: Vec<[[f64; 6]; 6]>,
    /// Samples and palms, from 0, of contacts that were misread: off by far more than those around them allow. They count as where these say.
    pub misread: Vec<(usize, usize)>,
    /// The same of forces that show in no motion: they count as those around them say.
    pub misread_forces: Vec<(usize, usize)>,
    /// What the data say of constants of the sensors that were taken as known; none unless asked for, nor of a log that is as good as exact.
    pub suspects: Vec<Suspect>,
    /// Where something contradicts what was taken as known: what that may be, the most probable first. None where nothing does, or nothing was asked.
    pub explanations: Vec<Explanation>,
    /// Whether to believe it.
    pub reliability: Reliability,
    /// What it rests on.
    pub evidence: ContactEvidence,
}

impl ContactEstimate {
    /// Standard deviation of the moment of inertia about the unit vector `axis` (body axes) through the centre of mass, kg m^2.
    #[must_use]
    pub fn moment_deviation(&self, axis: DVec3) -> f64 {
        let DVec3 { x, y, z } = axis;
        let by_entry = Vector6::new(x * x, y * y, z * z, 2.0 * x * y, 2.0 * x * z, 2.0 * y * z);
        by_entry.dot(&(Matrix6::from(self.inertia_covariance) * by_entry)).max(0.0).sqrt()
    }
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
    estimate(log, modes, options, None)
}

/// [`estimate_contacts`] of a log of whose first samples the motion is known: it is carried on to the others, in a fraction of the time that a search from
/// nothing takes.
///
/// Whether the log leaves other motions as probable is not asked again: what left none does not with more readings.
///
/// # Errors
/// As [`estimate_contacts`]; [`ContactEstimateError::Lost`] where the motion cannot be carried on.
pub fn estimate_contacts_from(
    beginning: &Beginning,
    log: &ContactLog,
    options: &ContactOptions,
) -> Result<ContactEstimate, ContactEstimateError> {
    estimate(log, None, options, Some(beginning))
}

fn estimate(
    log: &ContactLog,
    modes: Option<&[[ContactMode; MOST_PALMS]]>,
    options: &ContactOptions,
    beginning: Option<&Beginning>,
) -> Result<ContactEstimate, ContactEstimateError> {
    options.check()?;
    check(log, modes, options)?;
    if beginning.is_some_and(|of| of.samples() > log.times().len()) {
        return Err(ContactEstimateError::Lost);
    }
    let (rougher, record) = both(log.times().len(), || options.rougher(log), || Record::new(log, options));
    let record = record.ok_or(ContactEstimateError::NoContact)?;
    let length = options.size.or_else(|| cold::size(&record)).ok_or(ContactEstimateError::NoSize)?;
    let units = cold::units(&record, options.gravity, length);
    let (rough, rougher) = options.roughened(rougher, &units);
    let again = if rough == *options { None } else { Record::new(log, &rough) };
    let record = again.unwrap_or(record);
    let source = Source { log, options: &rough, units, beginning };
    let mut record = source.with_blows(record);
    let mut found = match modes {
        Some(modes) => source.with_modes(&mut record, modes.to_vec(), true)?.0,
        None => source.with_estimated_modes(&mut record)?,
    };
    found.evidence.rougher = rougher;
    let lost = options.suspects && is_lost(found.evidence.settled, log.duration(), &units);
    Ok(if lost { found.explained_by_beginning(log, modes, (options, &units)) } else { found })
}

/// What an estimate is made from.
struct Source<'a> {
    log: &'a ContactLog,
    options: &'a ContactOptions,
    units: Units,
    /// What is known of the motion at the first samples.
    beginning: Option<&'a Beginning>,
}

/// Samples at which the motion contradicts that a contact sticks, and the palm.
type Slips = Vec<(Range<usize>, usize)>;

impl Source<'_> {
    fn with_blows(&self, mut record: Record) -> Record {
        record.mark_blows(&self.units, self.options.gravity);
        record
    }

    /// With modes from the ratios of forces, those of the conditions that the motion contradicts taken back; where probabilities of modes are
    /// asked for, once more with those that they are sure of.
    fn with_estimated_modes(&self, record: &mut Record) -> Result<ContactEstimate, ContactEstimateError> {
        let mut found = self.uncontradicted(record)?;
        let Some(odds) = &found.mode_odds else { return Ok(found) };
        let time = AVERAGED * self.units.time();
        let again = surer(&record.times, &found.modes, odds, time);
        // Without noise a search is long, and what limits is when within a sample modes change.
        let worth = self.options.noise.limits(&self.units) && again != found.modes && !self.options.planar;
        let second = if worth { self.with_modes(record, again, false).ok() } else { None };
        let holds = |second: &ContactEstimate| second.evidence.settled && second.reliability.is_reliable();
        if let Some((mut second, slips)) = second.filter(|(second, _)| holds(second)) {
            let apart = apart(&found.states, &found.deviations, &second.states);
            let by_ratio = odds.by_ratio.clone();
            if let Some(odds) = second.mode_odds.take().filter(|_| slips.is_empty()) {
                found = ContactEstimate { mode_odds: Some(EstimatedModes { by_ratio, ..odds }), ..second };
            }
            found.relied_on.iter_mut().zip(apart).for_each(|(relied_on, apart)| *relied_on &= !apart);
        }
        if let Some(odds) = &found.mode_odds {
            found.modes = odds.most_probable();
        }
        Ok(found)
    }

    fn uncontradicted(&self, record: &mut Record) -> Result<ContactEstimate, ContactEstimateError> {
        let mut modes = by_ratio(record, AVERAGED * self.units.time());
        for _ in 0..ROUNDS {
            let (found, slips) = self.with_modes(record, modes, false)?;
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
        Ok(self.with_modes(record, modes, true)?.0)
    }

    /// With modes, of which there are no probabilities where the motion contradicts them, unless it is the `last` word.
    fn with_modes(
        &self,
        record: &mut Record,
        modes: Vec<[ContactMode; MOST_PALMS]>,
        last: bool,
    ) -> Result<(ContactEstimate, Slips), ContactEstimateError> {
        let Self { options, units, .. } = *self;
        record.set_modes(&modes);
        let log = &*record;
        let longest = longest(log, &options.noise, &units);
        let open = log.with_gaps_open(units.time());
        let log = open.as_ref().unwrap_or(log);
        let windows = windows(log, longest);
        let averaged = log.averaged_over(&windows);
        let thinned = thinned(&averaged, options, &units);
        let problem = problem(thinned.as_ref().unwrap_or(&averaged), options, units);
        let exact = problem.exact && log.frictionless() && !options.planar;
        let stage = self.solved(problem, log, (&averaged, thinned.is_some()));
        let mut stage = stage.ok_or(match self.beginning {
            Some(_) => ContactEstimateError::Lost,
            None => ContactEstimateError::Singular,
        })?;
        let covariances = stage.covariances().ok_or(ContactEstimateError::Singular)?;
        let (problem, solved) = (&stage.problem, &stage.solved);
        let shortest = match exact {
            true if options.guessed_floor && is_sharp(problem) => 0.0,
            true if options.guessed_floor && options.body.is_none() && leaves_something(problem) => {
                SHORTEST_OF_ROUGH
            }
            true => SHORTEST_OF_EXACT,
            false if thinned.is_some() => 0.0,
            _ => SHORTEST,
        };
        let mut motions = at_all(log, problem, &solved.unknowns, &covariances);
        let slips = slips(problem, &motions, &solved.unknowns.body);
        let uncontradicted = last || slips.is_empty();
        let covariances = if uncontradicted { stage.widened(covariances) } else { covariances };
        let covariances = if exact && options.guessed_floor {
            covariances.with_steps(log, problem, solved)
        } else {
            covariances
        };
        let (duration, needed) = (log.times[log.times.len() - 1] - log.times[0], shortest * units.time());
        let short = (duration < needed).then_some(Reason::TooShort { duration, needed });
        let short = short.or_else(|| too_sparse(&log.times, SPARSEST * units.time()));
        let evidence = stage.evidence(log, &covariances);
        let lost = is_lost(evidence.settled, duration, &units);
        let told = !exact && thinned.is_none() && uncontradicted && !lost;
        let (wrong, errors) = match options.suspects && told {
            true => self.suspects(&stage, &evidence, (&covariances, &motions), (log, &windows)),
            false => Default::default(),
        };
        let covariances = covariances.with_errors(errors);
        if covariances.are_wider() {
            motions = at_all(log, problem, &solved.unknowns, &covariances);
        }
        let odds = || {
            let (covariances, motions) = (&covariances, &motions);
            let known = Known { log, modes: &modes, problem, solved, covariances, motions, longest };
            mode_odds(&known, &options.noise, &units)
        };
        let mode_odds = if options.mode_odds && uncontradicted { odds() } else { None };
        let found = Found { log, stage: &stage, covariances: &covariances, evidence, short, wrong: &wrong };
        Ok((ContactEstimate { mode_odds, ..found.estimate(&motions, modes, options) }, slips))
    }

    /// From a search on a record, or on a thinned one, to the solution on the record. None where the equations are singular.
    fn solved<'r>(
        &self,
        problem: Problem<'r>,
        log: &Record,
        (averaged, thinned): (&'r Record, bool),
    ) -> Option<Stage<'r>> {
        let Self { options: ContactOptions { planar, guessed_floor, noise, body, .. }, .. } = self;
        // Conditions of exact logs are as good as what is left of them, unless it was said what they are off by.
        let (exact, sharp) = (problem.exact, problem.exact && *guessed_floor);
        let begun = match self.beginning {
            Some(beginning) => Stage::resumed(problem, beginning),
            None => Stage::searched(problem),
        };
        let mut stage = begun?.shared()?;
        if !sharp {
            stage = stage.stated()?;
        }
        let worth = stage.solved.explained() || !exact && is_short(&stage.problem);
        if !planar && log.frictionless() && worth {
            stage = match exact {
                false if self.beginning.is_some() => stage,
                false => stage.decided()?,
                true if sharp => stage.blunted()?,
                true => stage,
            };
        }
        if let Some(mass) = body {
            stage = stage.of_known(mass)?;
        }
        if stage.problem.noise.floor > noise.floor {
            stage = stage.stated()?;
        }
        if thinned && sharp && !is_rounded(&stage.problem) {
            stage = stage.over(averaged)?;
        } else if thinned || sharp {
            stage = stage.on_all(averaged, sharp)?;
        }
        stage = stage.finished()?;
        if *planar {
            stage = if self.beginning.is_none() { stage.decided()? } else { stage };
            stage = if exact { stage } else { stage.blurred()? };
        }
        if sharp { stage.sharpened() } else { Some(stage) }
    }

    /// Scores of constants of the sensors at a solution whose contacts were averaged over `windows`; where something contradicts
    /// it, what explains that; and errors that these constants may make.
    fn suspects(
        &self,
        stage: &Stage,
        evidence: &ContactEvidence,
        (covariances, motions): (&Covariances<CONSTANTS>, &[(Motion, Deviations)]),
        (record, windows): (&Record, &[Window]),
    ) -> (Wrong, Vec<Step<CONSTANTS>>) {
        let Stage { problem, solved, free, .. } = stage;
        let told = (&self.options.noise, &self.units);
        let readings = Readings::new(self.log, told, [record, problem.record], windows);
        let sensors = Sensors::new(&readings, motions, solved.unknowns.body);
        let scores = Scores::new(&sensors, problem, solved);
        let (suspects, errors) =
            scores.map(|scores| suspects(&scores, covariances, evidence)).unwrap_or_default();
        let contradicted = free.is_some()
            || !evidence.reliability().is_reliable()
            || ContactEvidence::against(&suspects, &[]).is_some();
        let explanations = match contradicted {
            true => explanations(&sensors, problem, solved, &suspects, free.as_ref()),
            false => Vec::new(),
        };
        (Wrong { suspects, explanations }, errors)
    }
}

/// What may be wrong of what was taken as known.
#[derive(Default)]
struct Wrong {
    suspects: Vec<Suspect>,
    explanations: Vec<Explanation>,
}

impl Stage<'_> {
    fn evidence(&self, log: &Record, covariances: &Covariances<CONSTANTS>) -> ContactEvidence {
        let Self { problem, solved, before, .. } = self;
        ContactEvidence {
            samples: log.times.len(),
            nodes: problem.nodes.len(),
            conditions: solved.equations.conditions,
            misfit: solved.misfit(),
            lasting: solved.lasting(problem),
            unresolved: if problem.exact { 0.0 } else { log.unresolved().sqrt() },
            rougher: [1.0; 2],
            iterations: [*before, before + solved.iterations],
            settled: solved.settled && covariances.mended <= MENDED,
        }
    }
}

fn too_sparse(times: &[f64], most: f64) -> Option<Reason> {
    let spacing = Rhythm::of(times).period?;
    (spacing > most).then_some(Reason::TooSparse { spacing, most })
}

fn slips(problem: &Problem, motions: &[(Motion, Deviations)], body: &Body) -> Slips {
    let record = problem.record;
    let mut slips = Vec::new();
    for (j, &k) in record.samples.iter().enumerate() {
        let motion = &motions[k].0;
        let turn = body.turn(motion.q, motion.L);
        let from = record.samples[j.saturating_sub(1)];
        let to = record.samples.get(j + 1).copied().unwrap_or(record.samples[j]);
        let noise = problem.noise_at(j);
        for contact in record.contacts[j].iter().filter(|c| c.mode == ContactMode::Stick) {
            let rows = Rows::new(contact, motion, &turn, &noise, false);
            if rows.is_some_and(|rows| rows.cost() > CONTRADICTED) {
                slips.push((from..to + 1, contact.palm));
            }
        }
    }
    slips
}

/// What was solved.
struct Found<'a> {
    log: &'a Record,
    stage: &'a Stage<'a>,
    covariances: &'a Covariances<CONSTANTS>,
    evidence: ContactEvidence,
    /// Why the log is too short, or its samples too few.
    short: Option<Reason>,
    wrong: &'a Wrong,
}

impl Found<'_> {
    fn estimate(
        &self,
        motions: &[(Motion, Deviations)],
        modes: Vec<[ContactMode; MOST_PALMS]>,
        options: &ContactOptions,
    ) -> ContactEstimate {
        let Self { log, stage, covariances, evidence, ref short, wrong } = *self;
        let Wrong { suspects, explanations } = wrong;
        let Stage { problem, solved, doubt, untold, against, open, .. } = stage;
        let Solved { unknowns, equations, .. } = solved;
        let (body, known) = (&unknowns.body, options.body.as_ref());
        // The body's own axes in those of the first sample.
        let told = || known.map_or(DQuat::IDENTITY, |mass| body.orientation(mass));
        let own = untold.unwrap_or_else(told);
        let state = |motion: &Motion| BodyState {
            p_WCm: motion.p + log.origin,
            v_WCm: motion.v,
            w_WO: body.turn(motion.q, motion.L).w,
            R_WO: (motion.q * own).normalize(),
        };
        let (mut reliability, wider) = (evidence.reliability(), evidence.widening());
        let spin =
            |(motion, of): &(Motion, Deviations)| (body.turn(motion.q, motion.L).w, of.map(|of| of * wider));
        let spins: Vec<_> = problem.node_samples().iter().map(|&k| spin(&motions[k])).collect();
        let against = [*short, *against, *open, ContactEvidence::still(&spins)];
        for reason in against.into_iter().flatten().chain(ContactEvidence::against(suspects, explanations)) {
            reliability.add(reason);
        }
        let deviations: Vec<_> = motions.iter().map(|(_, of)| of.map(|of| of * wider)).collect();
        let nodes = problem.node_samples();
        let excess = stretches(problem, equations);
        let one = |(k, of): (usize, &_)| {
            let j = nodes.partition_point(|&node| node <= k).saturating_sub(1);
            reliability.is_reliable() && relied_on(excess[j], of, &problem.units)
        };
        let relied_on: Vec<bool> = deviations.iter().enumerate().map(one).collect();
        let sound: Vec<usize> = (0..nodes.len()).filter(|&j| relied_on[nodes[j]]).collect();
        let joint = || pose_errors(problem, solved, covariances, &sound, (own, known.is_some(), wider));
        let poses = || {
            let all = poses_at_all(log, problem, unknowns, covariances);
            all.iter().map(|of| (of * (wider * wider)).into()).collect()
        };
        let of_body = covariances.of_body();
        let deviation = |i: usize| of_body[(i, i)].max(0.0).sqrt() * wider;
        ContactEstimate {
            states: motions.iter().map(|(motion, _)| state(motion)).collect(),
            misread: log.misread.iter().map(|of| (of.sample, of.palm)).collect(),
            misread_forces: log.misread_forces.iter().map(|of| (of.sample, of.palm)).collect(),
            suspects: suspects.clone(),
            explanations: explanations.clone(),
            pose_errors: if options.pose_errors { joint() } else { None },
            pose_covariances: if options.pose_covariances { poses() } else { Vec::new() },
            relied_on,
            deviations,
            modes,
            mode_odds: None,
            axes_deviations: doubt.map(|doubt| match untold {
                Some(_) => DVec3::splat(ANY_TURN),
                None => DVec3::from_array([4, 5, 6].map(|i| deviation(i).hypot(doubt))),
            }),
            mass: known.map_or_else(|| body.log_mass.exp(), MassProperties::mass),
            mass_deviation: deviation(0),
            inertia: known.map_or(body.inertia(), MassProperties::inertia),
            inertia_covariance: match known {
                Some(_) => Default::default(),
                None => (body.inertia_covariance(&of_body) * (wider * wider)).into(),
            },
            inertia_deviations: [deviation(1), deviation(2), deviation(3)],
            reliability,
            evidence,
        }
    }
}
