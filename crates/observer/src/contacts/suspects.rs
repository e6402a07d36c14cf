//! What the data speak against of what was taken as known of the sensors: a score test for each constant.
//!
//! With the motion and the body at their most probable, a constant `c` of the sensors that is not what it was taken for leaves a slope
//! `g` of half the cost in it. Motion and body would follow it; what information on `c` is left then, `I`, says that it is off by `-g / I`, known to
//! `1 / sqrt(I)`, and `g / sqrt(I)` is a standard normal number if nothing is wrong (Rao's score test).

use super::body::{Body, CONSTANTS};
use super::changed::{Averages, ChangeBy};
use super::equations::Equations;
use super::noise::{ContactNoiseLevel, force_trace};
use super::problem::{Problem, Units};
use super::reach::Residuals;
use super::record::{Contact, Record};
use super::samples::Deviations;
use super::slopes::slopes;
use super::solve::{Covariances, Reduced, Solved, Step};
use super::state::{Motion, Tangent};
use crate::faults::{SensorFault, Suspect};
use crate::random::Normal;
use crate::reliability::LARGEST_DEVIATION;
use crate::rigid::exponential;
use contact_kinematics::PalmSurface;
use glam::DVec3;
use object_dynamics::{ContactLog, LoggedPalm};

/// What of the information on a constant must be left when motion and body have followed it, for the data to tell of it.
const LEAST_LEFT: f64 = 1e-6;
/// What of the information must not be noise that poses as such, for it to be corrected for that.
const LEAST_SOUND: f64 = 0.3;
/// Seed of noise that is drawn to see what of the information it makes.
const SEED: u64 = 0xd31a;
/// Natural times on either side over which slopes of forces are taken.
const SMOOTH: f64 = 0.12;
/// Step of differences to one side, in natural units: a millionth is what it leaves out, and rounding a tenth of that.
const STEP: f64 = 1e-6;

/// A change of what a log says, by a constant of the sensors that is not what it was taken for.
struct Change<'a> {
    fault: SensorFault,
    /// Near which the change is small: forces that are late are taken from the samples nearest to when they were by it.
    value: f64,
    by: f64,
    log: &'a ContactLog,
    /// Motion at all samples, positions from the record's origin.
    motions: &'a [(Motion, Deviations)],
    body: &'a Body,
    /// What the forces change by in a unit of time, N/s, by palm and sample; and what is taken for that from `value` on.
    slopes: [&'a [Vec<DVec3>]; 2],
    /// Of contacts.
    origin: DVec3,
}

/// What a log says of the constants of its sensors.
#[derive(Clone, Copy)]
pub(super) struct Sensors<'a> {
    log: &'a ContactLog,
    /// Motion at all samples, positions from the record's origin.
    motions: &'a [(Motion, Deviations)],
    body: Body,
    /// What the forces change by in a unit of time, N/s, by palm and sample.
    slopes: &'a [Vec<DVec3>],
    /// Of which the record is one that a problem is on.
    averages: &'a Averages<'a>,
}

impl<'a> Sensors<'a> {
    /// Of `log` with a motion of `body`; `slopes` are [`slopes_of_forces`].
    pub(super) fn new(
        log: &'a ContactLog,
        (motions, body): (&'a [(Motion, Deviations)], Body),
        slopes: &'a [Vec<DVec3>],
        averages: &'a Averages<'a>,
    ) -> Self {
        Self { log, motions, body, slopes, averages }
    }

    /// With another body.
    pub(super) fn of_body(self, body: Body) -> Self {
        Self { body, ..self }
    }

    /// From sample to sample on average, s.
    pub(super) fn interval(&self) -> f64 {
        self.log.duration() / (self.log.times().len() - 1).max(1) as f64
    }

    /// The record of a log whose `fault` is known.
    pub(super) fn without(&self, fault: SensorFault, value: f64) -> Record {
        self.changed(fault, [value, 0.0], self.slopes)
    }

    /// With a value of the constant, and a step from there along which the forces have some `slopes`.
    fn changed(&self, fault: SensorFault, [value, step]: [f64; 2], slopes: &[Vec<DVec3>]) -> Record {
        let Self { log, motions, ref body, averages, .. } = *self;
        let slopes = [self.slopes, slopes];
        let origin = averages.origin();
        let change = Change { fault, value, by: value + step, log, motions, body, slopes, origin };
        averages.changed(|k, contact| change.of(k, contact))
    }

    /// Constants that the log may have.
    pub(super) fn constants(&self, problem: &Problem) -> Vec<SensorFault> {
        constants(self.log, problem)
    }
}

/// A solution of a log, and how its cost changes with constants of the sensors.
pub(super) struct Scores<'a> {
    sensors: &'a Sensors<'a>,
    problem: &'a Problem<'a>,
    solved: &'a Solved<CONSTANTS>,
    equations: Equations<CONSTANTS>,
    solver: Reduced<CONSTANTS>,
    followed: Step<CONSTANTS>,
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
        let residuals = Residuals::new(problem, &solved.unknowns)?;
        let noisy = share_of_noise(problem.record);
        Some(Self { sensors, problem, solved, equations, solver, followed, residuals, noisy })
    }

    /// Of a constant that the problem's record has as `value`. None where conditions come or go with it.
    pub(super) fn of(&self, fault: SensorFault, value: f64) -> Option<Score> {
        let Self { sensors, problem, solved, equations, solver, followed, residuals, .. } = self;
        let step = STEP * fault.natural(&problem.units);
        let told = |slopes: &[Vec<DVec3>]| {
            let record = sensors.changed(fault, [value, step], slopes);
            let changed = Residuals::new(&problem.on(&record), &solved.unknowns)?;
            let by = Residuals::slope(&changed, residuals, step)?;
            let (slope, own, mixed) = residuals.normal(equations, &by)?;
            // What motion and body take up when they follow: the step of a gradient is minus the inverse times it.
            let follows = solver.step(&mixed);
            Some((slope + mixed.dot(followed), own, own + mixed.dot(&follows), follows))
        };
        let delay = fault == SensorFault::ForceDelay;
        let (slope, own, left, follows) = told(sensors.slopes)?;
        // Noise in the slopes of forces poses as information on their delay.
        let spurious = match delay {
            true => told(&slopes_of_noise(sensors.log, &problem.units, &problem.noise))?.2,
            false => 0.0,
        };
        let sound = left - spurious;
        let tells = sound > (LEAST_LEFT * own).max(LEAST_SOUND * left) && left.is_finite();
        // Noise that forces and their slope share poses as a wrong gain.
        let posing =
            if matches!(fault, SensorFault::ForceGain { .. }) { self.noisy * own / left } else { 0.0 };
        let (value, deviation) =
            if tells { (-slope / sound, left.sqrt() / sound) } else { (0.0, f64::INFINITY) };
        Some(Score { value, deviation, posing, follows })
    }
}

/// Scores of all constants at a solution.
pub(super) fn suspects(scores: &Scores, covariances: &Covariances<CONSTANTS>) -> Vec<Suspect> {
    let problem = scores.problem;
    let scale = scores.solved.misfit().max(1.0).sqrt();
    let deviations: Vec<Tangent> = covariances.motions.iter().map(|of| covariances.deviations(of)).collect();
    let one = |fault: SensorFault| {
        let score = scores.of(fault, 0.0)?;
        let deviation = (scale * score.deviation).hypot(score.posing);
        // A constant that is known no better than that is beyond what a linearisation tells.
        let far = deviation > LARGEST_DEVIATION * fault.natural(&problem.units);
        let (value, deviation) = if far { (0.0, f64::INFINITY) } else { (score.value, deviation) };
        let moved = |(of, by): (&Tangent, &Tangent)| by.component_div(of).abs().max();
        let most = deviations.iter().zip(&score.follows.motions).map(moved).fold(0.0, f64::max);
        Some(Suspect { fault, value, deviation, tolerated: most.recip() })
    };
    scores.sensors.constants(problem).into_iter().filter_map(one).collect()
}

/// Of a palm that is touched, N.
fn force(palm: &LoggedPalm, k: usize) -> Option<DVec3> {
    palm.touch(k).and_then(|_| palm.force(k)).map(|force| force.vector)
}

/// What the forces change by in a unit of time, N/s, by palm and sample.
pub(super) fn slopes_of_forces(log: &ContactLog, units: &Units) -> Vec<Vec<DVec3>> {
    slopes_of(log, units, force)
}

/// The same of noise that is drawn in place of the forces.
fn slopes_of_noise(log: &ContactLog, units: &Units, noise: &ContactNoiseLevel) -> Vec<Vec<DVec3>> {
    let mut random = Normal::seeded(SEED);
    slopes_of(log, units, |palm, k| {
        let drawn = DVec3::new(random.draw(), random.draw(), random.draw());
        force(palm, k).map(|force| drawn * noise.force(force))
    })
}

/// Of `value` at each: of the line through those around, as far as the palm is touched. The noise of two neighbours would be taken for slope.
fn slopes_of(
    log: &ContactLog,
    units: &Units,
    mut value: impl FnMut(&LoggedPalm, usize) -> Option<DVec3>,
) -> Vec<Vec<DVec3>> {
    let of = |palm| {
        let values: Vec<Option<DVec3>> = (0..log.times().len()).map(|k| value(palm, k)).collect();
        slopes(log.times(), &values, SMOOTH * units.time())
    };
    log.palms().iter().map(of).collect()
}

/// Share of noise in the squares of the impulses.
fn share_of_noise(record: &Record) -> f64 {
    let noise: f64 = record.intervals.iter().map(|interval| force_trace(&interval.noise.white)).sum();
    let all: f64 = record.intervals.iter().map(|interval| interval.impulse.force.length_squared()).sum();
    if all > 0.0 { noise / all } else { 0.0 }
}

/// Constants that a log may have: forces that are measured at samples, flat palms for offsets, frictionless ones for friction.
fn constants(log: &ContactLog, problem: &Problem) -> Vec<SensorFault> {
    let mut all = Vec::new();
    let planar = problem.record.contacts.iter().flatten().any(|contact| contact.planar);
    for (i, palm) in log.palms().iter().enumerate() {
        let number = i + 1;
        if !(0..log.times().len()).any(|k| palm.touch(k).is_some()) {
            continue;
        }
        if palm.force_axes().is_some() && !problem.record.all_impulses {
            all.push(SensorFault::ForceGain { palm: number });
            all.push(SensorFault::ForceBias { palm: number });
        }
        for axis in 0..2 {
            // In the plane contacts are along the palm's x axis, and palms turn about its y axis.
            if palm.surface() == PalmSurface::Plane && !(planar && axis == 1) {
                all.push(SensorFault::ContactOffset { palm: number, axis });
            }
            if !(planar && axis == 0) {
                all.push(SensorFault::PalmTilt { palm: number, axis });
            }
        }
    }
    if !problem.record.all_impulses {
        all.push(SensorFault::ForceDelay);
    }
    if problem.record.contacts.iter().flatten().any(|contact| contact.frictionless) {
        all.push(SensorFault::Friction);
    }
    all
}

impl SensorFault {
    /// Its natural unit.
    pub(super) fn natural(self, units: &Units) -> f64 {
        let Units { length, speed, mass } = *units;
        match self {
            Self::ForceGain { .. } | Self::PalmTilt { .. } | Self::Friction => 1.0,
            Self::ForceBias { .. } => mass * speed * speed / length,
            Self::ForceDelay => length / speed,
            Self::ContactOffset { .. } => length,
        }
    }
}

impl Change<'_> {
    /// What a contact at sample `k` is different by then.
    fn of(&self, k: usize, contact: &Contact) -> ChangeBy {
        let palm = &self.log.palms()[contact.palm];
        let (number, by) = (contact.palm + 1, self.by);
        let none = ChangeBy::default();
        match self.fault {
            SensorFault::ForceGain { palm } if palm == number => ChangeBy { f: contact.f * by, ..none },
            SensorFault::ForceBias { palm } if palm == number => ChangeBy { f: contact.n * by, ..none },
            SensorFault::ForceDelay => ChangeBy { f: self.later(k, contact), ..none },
            SensorFault::ContactOffset { palm: of, axis } if of == number => {
                ChangeBy { c: palm.motion(k).pose.R_WP * (DVec3::AXES[axis] * by), ..none }
            }
            SensorFault::PalmTilt { palm: of, axis } if of == number => {
                let pose = palm.motion(k).pose;
                let turn = exponential(pose.R_WP * (DVec3::AXES[axis] * by));
                let turned = |v: DVec3| turn * v - v;
                let c = turned(contact.c - (pose.p_WP - self.origin));
                ChangeBy { c, n: turned(contact.n), f: turned(contact.f) }
            }
            SensorFault::Friction if contact.frictionless => {
                let motion = &self.motions[k].0;
                let w = self.body.turn(motion.q, motion.L).w;
                let slip = motion.v + w.cross(contact.c - motion.p) - contact.u;
                let against = -slip.reject_from_normalized(contact.n).normalize_or_zero();
                ChangeBy { f: against * (by * contact.f.dot(contact.n)), ..none }
            }
            _ => none,
        }
    }

    /// What the force is more that a palm tells later than at sample `k`. From whole samples, as far as there are: what is between two of them has
    /// less noise than each.
    fn later(&self, k: usize, contact: &Contact) -> DVec3 {
        let (palm, times) = (&self.log.palms()[contact.palm], self.log.times());
        let after = times.partition_point(|t| *t < times[k] + self.value).min(times.len() - 1);
        let before = after.saturating_sub(1);
        let off = |k: usize, of: usize| times[k] + self.value - times[of];
        let nearest = if off(k, before).abs() < off(k, after).abs() { before } else { after };
        let at = if force(palm, nearest).is_some() { nearest } else { k };
        let told = |k: usize| force(palm, k).unwrap_or_default();
        let [own, along] = self.slopes.map(|slopes| slopes[contact.palm][at]);
        let rest = times[k] + self.value - times[at];
        let more = told(at) - told(k) + own * rest + along * (self.by - self.value);
        if contact.frictionless { more.project_onto_normalized(contact.n) } else { more }
    }
}
