//! Estimates from one log, beside the truth.

use cpu_time::ThreadTime;
use glam::DVec3;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{Instant as Now, SensorLog, SensorNoise, ThreePalmScene};
use recon::observer::{
    KnownBody, MotionEstimate, NoiseLevel, StartState, UnknownBody, estimate_body, estimate_body_from,
    estimate_motion, estimate_motion_from, nearest_turn,
};

/// Errors and deviations of one estimate, and whether it is relied on.
pub(crate) struct Estimated {
    pub(crate) errors: Vec<f64>,
    pub(crate) deviations: Vec<f64>,
    pub(crate) covariance: Vec<Vec<f64>>,
    pub(crate) reliable: bool,
    /// Processor time.
    pub(crate) milliseconds: f64,
}

impl Estimated {
    /// Largest error in its deviations.
    pub(crate) fn worst(&self) -> f64 {
        self.errors.iter().zip(&self.deviations).fold(0.0, |m, (e, d)| m.max(e.abs() / d))
    }

    /// Whether there is an estimate at all.
    pub(crate) fn exists(&self) -> bool {
        self.errors.iter().all(|e| e.is_finite())
    }

    /// What the covariance would be under noise that is larger by a factor.
    pub(crate) fn scaled(mut self, factor: f64) -> Self {
        self.deviations.iter_mut().for_each(|d| *d *= factor);
        self.covariance.iter_mut().flatten().for_each(|c| *c *= factor * factor);
        self
    }
}

/// Another motion that an exact log leaves open.
pub(crate) struct Other {
    /// What it is off by.
    pub(crate) errors: Vec<f64>,
    /// Squared deviations by which the log has to be corrected for it.
    pub(crate) corrections: f64,
}

/// Where an estimate starts.
#[derive(Clone, Copy)]
pub(crate) enum Begun {
    /// From no guess.
    Cold,
    /// From the true motion and body.
    AtTruth,
}

/// What a log is of, and what is known of that.
pub(crate) struct Experiment<'a, S> {
    pub(crate) scene: &'a ThreePalmScene<S>,
    /// The truth at the first sample.
    pub(crate) now: &'a Now,
    /// Whether mass and inertia are unknown.
    pub(crate) unknown: bool,
}

impl<S: SupportFunction> Experiment<'_, S> {
    /// Estimates from a log and compares with the truth.
    pub(crate) fn estimate(&self, log: &SensorLog, noise: SensorNoise, begun: Begun) -> Estimated {
        let (scene, clock) = (self.scene, ThreadTime::now());
        if self.unknown {
            let known = UnknownBody { gravity: scene.gravity(), palm_inertias: None, noise: level(noise) };
            let found = match begun {
                Begun::Cold => estimate_body(log, &known),
                Begun::AtTruth => estimate_body_from(log, &known, scene.mass(), &self.truth()),
            };
            let Ok(found) = found else { return refused(13, clock) };
            let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
            let mut errors = self.errors(&found.motion.start, 9);
            let mut covariance = first(&found.motion, 9);
            let body = &found.body;
            let moments = body.mass.principal().moments - scene.mass().principal().moments;
            errors.push(body.mass.mass() - scene.mass().mass());
            errors.extend(moments.to_array());
            let deviations: Vec<f64> =
                std::iter::once(body.mass_deviation).chain(body.moment_deviations.to_array()).collect();
            for (k, d) in deviations.iter().enumerate() {
                covariance.iter_mut().for_each(|row| row.push(0.0));
                covariance.push((0..10 + k).map(|j| if j == 9 + k { d * d } else { 0.0 }).collect());
            }
            outcome(errors, covariance, found.motion.reliability.is_reliable(), milliseconds)
        } else {
            let found = match begun {
                Begun::Cold => estimate_motion(log, &self.known(noise)),
                Begun::AtTruth => estimate_motion_from(log, &self.known(noise), &self.truth()),
            };
            let Ok(found) = found else { return refused(12, clock) };
            let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
            let errors = self.errors(&found.start, 12);
            outcome(errors, first(&found, 12), found.reliability.is_reliable(), milliseconds)
        }
    }

    /// Other motions of a known body that an exact log leaves open under noise.
    pub(crate) fn others(&self, log: &SensorLog, noise: SensorNoise) -> Vec<Other> {
        if self.unknown {
            return Vec::new();
        }
        let found = estimate_motion(log, &self.known(noise)).map(|found| found.others).unwrap_or_default();
        found
            .iter()
            .map(|other| Other { errors: self.errors(&other.start, 12), corrections: other.corrections })
            .collect()
    }

    fn known(&self, noise: SensorNoise) -> KnownBody {
        let scene = self.scene;
        KnownBody { mass: *scene.mass(), gravity: scene.gravity(), palm_inertias: None, noise: level(noise) }
    }

    fn truth(&self) -> StartState {
        let now = self.now;
        StartState {
            p_WCm: now.touch.p_WCm,
            v_WCm: now.rates.v_WCm,
            L_WO: now.R_WO * (self.scene.mass().inertia() * (now.R_WO.inverse() * now.w_WO)),
            R_WO: now.R_WO,
        }
    }

    /// Errors of the first `count` numbers of the state at the start.
    fn errors(&self, start: &StartState, count: usize) -> Vec<f64> {
        let truth = self.truth();
        let nearest = start.R_WO * nearest_turn(self.scene.mass(), start.R_WO, truth.R_WO);
        let turn = nearest * truth.R_WO.inverse();
        let parts = [
            start.p_WCm - truth.p_WCm,
            start.v_WCm - truth.v_WCm,
            start.L_WO - truth.L_WO,
            DVec3::new(turn.x, turn.y, turn.z) * 2.0 * turn.w.signum(),
        ];
        (0..count).map(|i| parts[i / 3][i % 3]).collect()
    }
}

fn level(noise: SensorNoise) -> Option<NoiseLevel> {
    Some(NoiseLevel { contact: noise.contact, force: noise.force })
}

/// Covariance of the first `count` numbers of the state at the start.
fn first(found: &MotionEstimate, count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|i| (0..count).map(|j| found.covariance[(i, j)]).collect()).collect()
}

/// No estimate is a warning too.
fn refused(count: usize, clock: ThreadTime) -> Estimated {
    let infinite = vec![f64::INFINITY; count];
    let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
    let covariance = vec![vec![0.0; count]; count];
    Estimated { errors: infinite.clone(), deviations: infinite, covariance, reliable: false, milliseconds }
}

fn outcome(errors: Vec<f64>, covariance: Vec<Vec<f64>>, reliable: bool, milliseconds: f64) -> Estimated {
    let deviations = (0..errors.len()).map(|i| covariance[i][i].max(0.0).sqrt()).collect();
    Estimated { errors, deviations, covariance, reliable, milliseconds }
}
