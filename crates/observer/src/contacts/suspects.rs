//! What the data speak against of what was taken as known of the sensors and of a stated body: a score test for each constant.
//!
//! With the motion and the body at their most probable, a constant `c` of the sensors that is not what it was taken for leaves a slope
//! `g` of half the cost in it. Motion and body would follow it; what information on `c` is left then, `I`, says that it is off by `-g / I`, known to
//! `1 / sqrt(I)`, and `g / sqrt(I)` is a standard normal number if nothing is wrong (Rao's score test).

use super::body::{Body, CONSTANTS};
use super::both::both;
use super::chain::Chain;
use super::changed::Averages;
use super::equations::Equations;
use super::noise::{ContactNoiseLevel, force_trace};
use super::problem::{Problem, Units};
use super::reach::{Conditions, Residuals};
use super::record::Record;
use super::samples::Deviations;
use super::sensor_change::{
    Change, slopes_of_contact_noise, slopes_of_contacts, slopes_of_forces, slopes_of_noise,
};
use super::solve::{Covariances, Solved, Step};
use super::state::{Motion, Tangent};
use super::stated_body::{CONSTANTS_OF_BODY, StatedBody};
use super::verdict::ContactEvidence;
use super::windows::Window;
use crate::doubted::{self, CERTAIN};
use crate::faults::{Constant, Suspect};
use crate::reliability::LARGEST_DEVIATION;
use contact_kinematics::{PalmSurface, in_parts};
use glam::DVec3;
use object_dynamics::ContactLog;
use std::borrow::Cow;

/// What of the information on a constant must be left when motion and body have followed it, for the data to tell of it.
const LEAST_LEFT: f64 = 1e-6;
/// What of the information must not be noise that poses as such, for it to be corrected for that.
const LEAST_SOUND: f64 = 0.3;
/// Step of differences to one side, in natural units: a millionth is what it leaves out, and rounding a tenth of that.
const STEP: f64 = 1e-6;

/// What constants of the sensors are judged by beside a solution.
pub(super) struct Readings<'a> {
    log: &'a ContactLog,
    /// What the forces change by in a unit of time, N/s, and what contacts move by in axes of their palms, m/s; by palm and sample.
    slopes: [Vec<Vec<DVec3>>; 2],
    /// Of which the record is one that a problem is on.
    averages: Averages<'a>,
}

impl<'a> Readings<'a> {
    /// Of `log`, whose record was averaged over `windows`.
    pub(super) fn new(
        log: &'a ContactLog,
        (noise, units): (&ContactNoiseLevel, &Units),
        records: [&'a Record; 2],
        windows: &[Window],
    ) -> Self {
        let slopes =
            both(log.times().len(), || slopes_of_forces(log, units), || slopes_of_contacts(log, units))
                .into();
        Self { log, slopes, averages: Averages::new(log, noise, records, windows) }
    }
}

/// What a log says of the constants of its sensors.
#[derive(Clone, Copy)]
pub(super) struct Sensors<'a> {
    readings: &'a Readings<'a>,
    /// Motion at all samples, positions from the record's origin.
    motions: &'a [(Motion, Deviations)],
    body: Body,
}

impl<'a> Sensors<'a> {
    /// With a motion of `body`.
    pub(super) fn new(readings: &'a Readings<'a>, motions: &'a [(Motion, Deviations)], body: Body) -> Self {
        Self { readings, motions, body }
    }

    /// With another body.
    pub(super) fn of_body(self, body: Body) -> Self {
        Self { body, ..self }
    }

    /// From sample to sample on average, s.
    pub(super) fn interval(&self) -> f64 {
        self.readings.log.duration() / (self.readings.log.times().len() - 1).max(1) as f64
    }

    /// The record of a log whose `fault` is known.
    pub(super) fn without(&self, fault: Constant, value: f64) -> Record {
        self.changed(fault, [value, 0.0], self.slopes_of(fault))
    }

    /// Of what comes late, if it is that.
    fn slopes_of(&self, fault: Constant) -> &'a [Vec<DVec3>] {
        let [forces, paths] = &self.readings.slopes;
        if fault == Constant::ContactDelay { paths } else { forces }
    }

    /// With a value of the constant, and a step from there along which what is late has some `slopes`.
    fn changed(&self, fault: Constant, [value, step]: [f64; 2], slopes: &[Vec<DVec3>]) -> Record {
        let Self { readings: Readings { log, averages, .. }, motions, ref body } = *self;
        let slopes = [self.slopes_of(fault), slopes];
        let origin = averages.origin();
        let by = value + step;
        let turn = [by.sin(), 2.0 * (0.5 * by).sin().powi(2)];
        let change = Change { fault, value, by, turn, log, motions, body, slopes, origin };
        averages.changed(change.palm(), |contact| change.of(contact))
    }

    /// Constants that the log may have.
    pub(super) fn constants(&self, problem: &Problem) -> Vec<Constant> {
        constants(self.readings.log, problem)
    }
}

/// A solution of a log, and how its cost changes with constants of the sensors.
pub(super) struct Scores<'a> {
    sensors: &'a Sensors<'a>,
    problem: &'a Problem<'a>,
    solved: &'a Solved<CONSTANTS>,
    equations: Cow<'a, Equations<CONSTANTS>>,
    solver: Chain<CONSTANTS>,
    followed: Step<CONSTANTS>,
    conditions: Conditions,
    residuals: Residuals,
    /// Share of noise in the squares of the impulses.
    noisy: f64,
}

/// What the data say of one constant, to first order.
pub(super) struct Score {
    /// By how much it is more than it was taken for.
    pub(super) value: f64,
    /// Standard deviation of that by the noise that was stated; infinite where the data cannot tell.
    pub(super) deviation: f64,
    /// What noise that poses as this constant makes of it.
    posing: f64,
    follows: Step<CONSTANTS>,
}

impl<'a> Scores<'a> {
    pub(super) fn new(
        sensors: &'a Sensors,
        problem: &'a Problem,
        solved: &'a Solved<CONSTANTS>,
    ) -> Option<Self> {
        let equations = problem.unfrozen(&solved.equations, &solved.unknowns);
        let solver = equations.solver(&problem.natural_information())?.0;
        let followed = solver.step(&equations.gradient());
        let conditions = Conditions::new(problem, &solved.unknowns);
        let residuals = Residuals::new(problem, &solved.unknowns)?;
        let noisy = share_of_noise(problem.record);
        Some(Self { sensors, problem, solved, equations, solver, followed, conditions, residuals, noisy })
    }

    /// Of a constant that the problem's record has as `value`. None where conditions come or go with it.
    pub(super) fn of(&self, fault: Constant, value: f64) -> Option<Score> {
        let Self { sensors, problem, solved, equations, solver, followed, conditions, residuals, .. } = self;
        let step = STEP * fault.natural(&problem.units);
        let told = |slopes: &[Vec<DVec3>]| {
            let record = sensors.changed(fault, [value, step], slopes);
            let changed = Residuals::new(&problem.on(&record), &solved.unknowns)?;
            let by = Residuals::slope(&changed, residuals, step)?;
            let (slope, own, mixed) = conditions.normal(equations, residuals, &by)?;
            // What motion and body take up when they follow: the step of a gradient is minus the inverse times it.
            let follows = solver.step(&mixed);
            Some((slope + mixed.dot(followed), own, own + mixed.dot(&follows), follows))
        };
        let (slope, own, left, follows) = told(sensors.slopes_of(fault))?;
        // Noise in slopes poses as information on a delay.
        let (log, units, noise) = (sensors.readings.log, &problem.units, &problem.noise);
        let spurious = match fault {
            Constant::ForceDelay => told(&slopes_of_noise(log, units, noise))?.2,
            Constant::ContactDelay => told(&slopes_of_contact_noise(log, units, noise.contact))?.2,
            _ => 0.0,
        };
        // Noise that forces and their slope share poses as a wrong gain.
        let posing = if matches!(fault, Constant::ForceGain { .. }) { self.noisy * own / left } else { 0.0 };
        Some(Score { posing, ..Score::of(slope, [own, left, spurious], follows) })
    }
}

impl Score {
    /// By the slope of half the cost and the information on a constant: its `own`, what is `left` when motion and body have followed it, and what of
    /// that is noise.
    pub(super) fn of(slope: f64, [own, left, spurious]: [f64; 3], follows: Step<CONSTANTS>) -> Self {
        let sound = left - spurious;
        let tells = sound > (LEAST_LEFT * own).max(LEAST_SOUND * left) && left.is_finite();
        let (value, deviation) =
            if tells { (-slope / sound, left.sqrt() / sound) } else { (0.0, f64::INFINITY) };
        Self { value, deviation, posing: 0.0, follows }
    }
}

/// Scores of all constants at a solution, and the errors of motion and body by each that may be wrong, as steps of one deviation each that the widening of
/// all deviations is not in.
pub(super) fn suspects(
    scores: &Scores,
    covariances: &Covariances<CONSTANTS>,
    evidence: &ContactEvidence,
) -> (Vec<Suspect>, Vec<Step<CONSTANTS>>) {
    let (suspects, follows): (Vec<Suspect>, Vec<_>) =
        followed(scores, covariances, evidence).into_iter().unzip();
    let off = doubted::errors(&suspects).into_iter().zip(&follows).filter(|(off, _)| *off > 0.0);
    let errors = off.map(|(off, follows)| follows.scaled(off / evidence.widening())).collect();
    (suspects, errors)
}

/// Scores of all constants, and by what motion and body follow a unit of each.
fn followed(
    scores: &Scores,
    covariances: &Covariances<CONSTANTS>,
    evidence: &ContactEvidence,
) -> Vec<(Suspect, Step<CONSTANTS>)> {
    let problem = scores.problem;
    let wider = evidence.widening_of_constants();
    let deviations: Vec<Tangent> = covariances.motions.iter().map(|of| covariances.deviations(of)).collect();
    let body = StatedBody::new(problem, scores.solved, covariances);
    let one = |fault: Constant| {
        let score = match &body {
            Some(body) if fault.is_of_body() => body.score(fault, &scores.solver, &scores.followed),
            _ => scores.of(fault, 0.0),
        }?;
        let deviation = (wider * score.deviation).hypot(score.posing);
        // A constant that is known no better than that is beyond what a linearisation tells.
        let reach = LARGEST_DEVIATION * fault.natural(&problem.units);
        // Noise of the spin poses as information on where contacts are: it was seen to tell of values as large as the body at five deviations.
        let posed = matches!(fault, Constant::ContactOffset { .. })
            && (reach..CERTAIN.sqrt() * deviation).contains(&score.value.abs());
        let far = deviation > reach || posed;
        let (value, deviation) = if far { (0.0, f64::INFINITY) } else { (score.value, deviation) };
        let moved = |(of, by): (&Tangent, &Tangent)| by.component_div(of).abs().max();
        let most = deviations.iter().zip(&score.follows.motions).map(moved).fold(0.0, f64::max);
        Some((Suspect { fault, value, deviation, tolerated: evidence.widening() / most }, score.follows))
    };
    // Each is a pass over all samples: two at a time.
    let mut constants = scores.sensors.constants(problem);
    constants.extend(body.iter().flat_map(|_| CONSTANTS_OF_BODY));
    in_parts(&constants, |faults| faults.iter().copied().filter_map(one).collect())
}

/// Share of noise in the squares of the impulses.
fn share_of_noise(record: &Record) -> f64 {
    let noise: f64 = record.intervals.iter().map(|interval| force_trace(&interval.noise.white)).sum();
    let all: f64 = record.intervals.iter().map(|interval| interval.impulse.force.length_squared()).sum();
    if all > 0.0 { noise / all } else { 0.0 }
}

/// Constants that a log may have: forces that are measured at samples, flat palms for offsets, frictionless ones for friction.
fn constants(log: &ContactLog, problem: &Problem) -> Vec<Constant> {
    let mut all = Vec::new();
    let planar = problem.record.contacts.iter().flatten().any(|contact| contact.planar);
    for (i, palm) in log.palms().iter().enumerate() {
        let number = i + 1;
        if !(0..log.times().len()).any(|k| palm.touch(k).is_some()) {
            continue;
        }
        if palm.force_axes().is_some() && !problem.record.all_impulses {
            all.push(Constant::ForceGain { palm: number });
            all.push(Constant::ForceBias { palm: number });
        }
        for axis in 0..2 {
            // In the plane contacts are along the palm's x axis, and palms turn about its y axis.
            if palm.surface() == PalmSurface::Plane && !(planar && axis == 1) {
                all.push(Constant::ContactOffset { palm: number, axis });
            }
            if !(planar && axis == 0) {
                all.push(Constant::PalmTilt { palm: number, axis });
            }
        }
    }
    if !problem.record.all_impulses {
        all.push(Constant::ForceDelay);
    }
    if planar && log.palms().iter().all(|palm| palm.surface() == PalmSurface::Plane) {
        all.push(Constant::ContactDelay);
    }
    if problem.record.contacts.iter().flatten().any(|contact| contact.frictionless) {
        all.push(Constant::Friction);
    }
    all
}

impl Constant {
    /// Its natural unit.
    pub(super) fn natural(self, units: &Units) -> f64 {
        let Units { length, speed, mass } = *units;
        match self {
            Self::ForceGain { .. } | Self::PalmTilt { .. } | Self::Friction => 1.0,
            Self::Mass | Self::Moment { .. } => 1.0,
            Self::ForceBias { .. } => mass * speed * speed / length,
            Self::ForceDelay | Self::ContactDelay => length / speed,
            Self::ContactOffset { .. } => length,
        }
    }
}
