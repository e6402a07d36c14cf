//! What the data speak against of what was taken as known of the sensors: a score test for each constant.
//!
//! With the motion and the body at their most probable, a constant `c` of the sensors that is not what it was taken for leaves a slope
//! `g` of half the cost in it. Motion and body would follow it; what information on `c` is left then, `I`, says that it is off by `-g / I`, known to
//! `1 / sqrt(I)`, and `g / sqrt(I)` is a standard normal number if nothing is wrong (Rao's score test).

use super::body::{Body, CONSTANTS};
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
pub(super) struct Change<'a> {
    fault: SensorFault,
    by: f64,
    log: &'a ContactLog,
    /// Motion at all samples, positions from the record's origin.
    motions: &'a [(Motion, Deviations)],
    body: &'a Body,
    /// What the forces change by in a unit of time, N/s, by palm and sample; none where that is not asked for.
    slopes: &'a [Vec<DVec3>],
}

/// What a log says of the constants of its sensors.
pub(super) struct Sensors<'a> {
    pub(super) log: &'a ContactLog,
    /// Motion at all samples, positions from the record's origin.
    pub(super) motions: &'a [(Motion, Deviations)],
    pub(super) body: Body,
    /// Makes the record that a problem is on from changed contacts.
    pub(super) remade: &'a dyn Fn(&Change) -> Option<Record>,
}

impl Sensors<'_> {
    /// The record of a log whose `fault` is known.
    pub(super) fn without(&self, fault: SensorFault, value: f64, problem: &Problem) -> Option<Record> {
        let slopes = if fault == SensorFault::ForceDelay { self.slopes(problem) } else { Vec::new() };
        self.changed(fault, value, &slopes)
    }

    fn changed(&self, fault: SensorFault, by: f64, slopes: &[Vec<DVec3>]) -> Option<Record> {
        let Self { log, motions, body, remade } = self;
        remade(&Change { fault, by, log, motions, body, slopes })
    }

    fn slopes(&self, problem: &Problem) -> Vec<Vec<DVec3>> {
        slopes_of_forces(self.log, SMOOTH * problem.units.time(), force)
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
            let record = sensors.changed(fault, value + step, slopes)?;
            let changed = Residuals::new(&problem.on(&record), &solved.unknowns)?;
            let by = Residuals::slope(&changed, residuals, step)?;
            let (slope, own, mixed) = residuals.normal(equations, &by)?;
            // What motion and body take up when they follow: the step of a gradient is minus the inverse times it.
            let follows = solver.step(&mixed);
            Some((slope + mixed.dot(followed), own, own + mixed.dot(&follows), follows))
        };
        let delay = fault == SensorFault::ForceDelay;
        let (slope, own, left, follows) = told(&if delay { sensors.slopes(problem) } else { Vec::new() })?;
        // Noise in the slopes of forces poses as information on their delay.
        let smooth = SMOOTH * problem.units.time();
        let spurious = match delay {
            true => told(&slopes_of_noise(sensors.log, smooth, &problem.noise))?.2,
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

/// Scores of all constants at a solution with its `motions` at all samples of `log`. `remade` makes the record that the problem is on from
/// changed contacts.
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

/// By palm and sample, N/s, of `value` at each: of the line through those around, `smooth` on either side in time and as far as the palm is touched.
/// The noise of two neighbours would be taken for slope.
fn slopes_of_forces(
    log: &ContactLog,
    smooth: f64,
    mut value: impl FnMut(&LoggedPalm, usize) -> Option<DVec3>,
) -> Vec<Vec<DVec3>> {
    let of = |palm| {
        let values: Vec<Option<DVec3>> = (0..log.times().len()).map(|k| value(palm, k)).collect();
        slopes(log.times(), &values, smooth)
    };
    log.palms().iter().map(of).collect()
}

/// The same of noise that is drawn in place of the forces.
fn slopes_of_noise(log: &ContactLog, smooth: f64, noise: &ContactNoiseLevel) -> Vec<Vec<DVec3>> {
    let mut random = Normal::seeded(SEED);
    slopes_of_forces(log, smooth, |palm, k| {
        let drawn = DVec3::new(random.draw(), random.draw(), random.draw());
        force(palm, k).map(|force| drawn * noise.force(force))
    })
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
    /// What a contact at sample `k` is then, its position from `origin`.
    pub(super) fn apply(&self, k: usize, contact: &mut Contact, origin: DVec3) {
        let palm = &self.log.palms()[contact.palm];
        let (number, by) = (contact.palm + 1, self.by);
        match self.fault {
            SensorFault::ForceGain { palm } if palm == number => contact.f *= 1.0 + by,
            SensorFault::ForceBias { palm } if palm == number => contact.f += contact.n * by,
            SensorFault::ForceDelay => contact.f += self.slope_of_force(k, contact) * by,
            SensorFault::ContactOffset { palm: of, axis } if of == number => {
                let moved = palm.motion(k).pose.R_WP * (DVec3::AXES[axis] * by);
                contact.c += moved;
                contact.u += contact.W.cross(moved);
            }
            SensorFault::PalmTilt { palm: of, axis } if of == number => {
                let pose = palm.motion(k).pose;
                let turn = exponential(pose.R_WP * (DVec3::AXES[axis] * by));
                let pivot = pose.p_WP - origin;
                let moved = pivot + turn * (contact.c - pivot);
                contact.u += contact.W.cross(moved - contact.c);
                (contact.c, contact.n, contact.f) = (moved, turn * contact.n, turn * contact.f);
            }
            SensorFault::Friction if contact.frictionless => {
                let motion = &self.motions[k].0;
                let w = self.body.turn(motion.q, motion.L).w;
                let slip = motion.v + w.cross(contact.c - motion.p) - contact.u;
                let against = -slip.reject_from_normalized(contact.n).normalize_or_zero();
                contact.f += against * (by * contact.f.dot(contact.n));
            }
            _ => {}
        }
    }

    fn slope_of_force(&self, k: usize, contact: &Contact) -> DVec3 {
        let slope = self.slopes[contact.palm][k];
        if contact.frictionless { slope.project_onto_normalized(contact.n) } else { slope }
    }
}
