//! Estimates from one log, beside the truth.

use cpu_time::ThreadTime;
use glam::DVec3;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{Instant as Now, SensorLog, SensorNoise, ThreePalmScene};
use recon::observer::{
    KnownBody, MotionEstimate, NoiseLevel, UnknownBody, equivalent_orientations, estimate_body,
    estimate_motion,
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

/// Estimates from a log and compares with the truth.
pub(crate) fn estimate<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    noise: SensorNoise,
    unknown: bool,
    now: &Now,
) -> Estimated {
    let noise = Some(NoiseLevel { contact: noise.contact, force: noise.force });
    let clock = ThreadTime::now();
    if unknown {
        let known = UnknownBody { gravity: scene.gravity(), palm_inertias: None, noise };
        let Ok(found) = estimate_body(log, &known) else { return refused(13, clock) };
        let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
        let (mut errors, mut covariance) = motion_errors(scene, &found.motion, now, 9);
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
        let known = KnownBody { mass: *scene.mass(), gravity: scene.gravity(), palm_inertias: None, noise };
        let Ok(found) = estimate_motion(log, &known) else { return refused(12, clock) };
        let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
        let (errors, covariance) = motion_errors(scene, &found, now, 12);
        outcome(errors, covariance, found.reliability.is_reliable(), milliseconds)
    }
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

/// Errors of the first `count` numbers of the state at the start, with their covariance.
fn motion_errors<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    found: &MotionEstimate,
    now: &Now,
    count: usize,
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let L = now.R_WO * (scene.mass().inertia() * (now.R_WO.inverse() * now.w_WO));
    let turns =
        equivalent_orientations(scene.mass()).map(|turn| (found.start.R_WO * turn) * now.R_WO.inverse());
    let turn = turns.into_iter().fold(turns[0], |best, t| if t.w.abs() > best.w.abs() { t } else { best });
    let parts = [
        found.start.p_WCm - now.touch.p_WCm,
        found.start.v_WCm - now.rates.v_WCm,
        found.start.L_WO - L,
        DVec3::new(turn.x, turn.y, turn.z) * 2.0 * turn.w.signum(),
    ];
    let errors = (0..count).map(|i| parts[i / 3][i % 3]).collect();
    let row = |i: usize| (0..count).map(|j| found.covariance[(i, j)]).collect();
    (errors, (0..count).map(row).collect())
}
