//! Estimates from one log, beside the truth.

use cpu_time::ThreadTime;
use glam::DVec3;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{ContactLog, Instant as Now, SensorLog, SensorNoise, ThreePalmScene};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon::observer::rigid::nearest_turn;

/// What conditions are off by beside noise, as a share of the natural speed.
const FLOOR: f64 = 3e-5;

/// Errors and deviations of one estimate, and whether it is relied on.
pub(crate) struct Estimated {
    pub(crate) errors: Vec<f64>,
    pub(crate) deviations: Vec<f64>,
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
}

/// What a log is of, and what is known of that.
pub(crate) struct Experiment<'a, S> {
    pub(crate) scene: &'a ThreePalmScene<S>,
    /// The truth at the first sample.
    pub(crate) now: &'a Now,
    /// Whether mass and inertia are unknown.
    pub(crate) unknown: bool,
    /// Natural speed, m/s.
    pub(crate) speed: f64,
}

impl<S: SupportFunction> Experiment<'_, S> {
    /// Estimates from a log of such a noise, and compares with the truth.
    pub(crate) fn estimate(&self, log: &SensorLog, noise: SensorNoise) -> Estimated {
        let clock = ThreadTime::now();
        let mass = *self.scene.mass();
        let noise = ContactNoiseLevel {
            contact: noise.contact,
            force_fixed: noise.force,
            force_share: 0.0,
            impulse: None,
            floor: FLOOR * self.speed,
        };
        let options = ContactOptions {
            friction: Some(0.0),
            body: (!self.unknown).then_some(mass),
            ..ContactOptions::new(noise, self.scene.gravity().length())
        };
        let found =
            ContactLog::try_from(log).ok().and_then(|log| estimate_contacts(&log, None, &options).ok());
        let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
        let Some(found) = found else { return refused(if self.unknown { 13 } else { 12 }, milliseconds) };
        let (errors, deviations) = self.compared(&found);
        let reliable = found.reliability.is_reliable() && found.relied_on[0];
        Estimated { errors, deviations, reliable, milliseconds }
    }

    /// Errors and deviations of the state at the start, then of the axes, or of mass and principal moments.
    fn compared(&self, found: &ContactEstimate) -> (Vec<f64>, Vec<f64>) {
        let (state, now, mass) = (found.states[0], self.now, self.scene.mass());
        let parts = [state.p_WCm - now.touch.p_WCm, state.v_WCm - now.rates.v_WCm, state.w_WO - now.w_WO];
        let mut errors: Vec<f64> = parts.iter().flat_map(DVec3::to_array).collect();
        let mut deviations: Vec<f64> = found.deviations[0][..3].iter().flat_map(DVec3::to_array).collect();
        if let Some(axes) = found.axes_deviations {
            let same = nearest_turn(mass, state.R_WO, now.R_WO);
            let turn = (state.R_WO * same) * now.R_WO.inverse();
            errors.extend((turn.xyz() * (2.0 * turn.w.signum())).to_array());
            deviations.extend(axes.to_array());
        } else {
            errors.push(found.mass - mass.mass());
            deviations.push(found.mass * found.mass_deviation);
            // Moments of what was found about the true principal axes: to first order its own.
            let axes = now.R_WO * mass.principal().axes;
            for (axis, moment) in DVec3::AXES.into_iter().zip(mass.principal().moments.to_array()) {
                let axis = axes * axis;
                errors.push(axis.dot(found.inertia * axis) - moment);
                deviations.push(found.moment_deviation(axis));
            }
        }
        (errors, deviations)
    }
}

/// No estimate is a warning too.
fn refused(count: usize, milliseconds: f64) -> Estimated {
    let infinite = vec![f64::INFINITY; count];
    Estimated { errors: infinite.clone(), deviations: infinite, reliable: false, milliseconds }
}
