//! Constants of the sensors as unknowns beside the motion.

use super::estimate::{EstimateError, KnownBody, MotionEstimate, estimate_with_constants};
use super::state_space::{Constant, MOTION_STATES};
use super::track::Track;
use object_dynamics::SensorLog;

/// The constants, in the order of the states.
const CONSTANTS: [Constant; 13] = [
    Constant::ForceGain(0),
    Constant::ForceGain(1),
    Constant::ForceGain(2),
    Constant::ForceBias(0),
    Constant::ForceBias(1),
    Constant::ForceBias(2),
    Constant::ContactOffset(0, 0),
    Constant::ContactOffset(0, 1),
    Constant::ContactOffset(1, 0),
    Constant::ContactOffset(1, 1),
    Constant::ContactOffset(2, 0),
    Constant::ContactOffset(2, 1),
    Constant::ForceDelay,
];
const STATES: usize = MOTION_STATES + CONSTANTS.len();

/// Prior standard deviations of the sensors' constants; zero for what is known.
///
/// An offset of a palm along its normal is not among them: neither the contact condition nor the torque of a normal force
/// holds it. It moves the shape alone, by as much.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorPriors {
    /// Of the factor of each palm's force, about 1.
    pub force_gain: f64,
    /// Of the force to be added to each palm's, about 0, N.
    pub force_bias: f64,
    /// Of the lengths to be added to the sensor coordinates of each palm, about 0, m. On immobile palms a common shift of
    /// all contacts along the world's axes stays as unknown as this says.
    pub contact_offset: f64,
    /// Of the time by which forces are reported after the contacts, about 0, s. Small against the motion's natural time:
    /// it enters to first order.
    pub force_delay: f64,
}

impl SensorPriors {
    fn of(&self, constant: Constant) -> f64 {
        match constant {
            Constant::ForceGain(_) => self.force_gain,
            Constant::ForceBias(_) => self.force_bias,
            Constant::ContactOffset(..) => self.contact_offset,
            Constant::ForceDelay => self.force_delay,
            Constant::LogMass | Constant::Inertia(_) => 0.0,
        }
    }
}

/// A constant as found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorConstant {
    /// What it is.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// Motion and the sensors' constants.
#[derive(Clone, Debug)]
pub struct SensorEstimate {
    /// The motion.
    pub motion: MotionEstimate,
    /// Gains, biases, offsets (by palm), delay; what was known is among them as it was.
    pub constants: [SensorConstant; 13],
}

/// Estimates the motion of a known body together with constants of the sensors.
///
/// Sensors that are not perfect leave no log that noise explains, so the search for a start rests on a motion that is
/// nearly right: gains within some 10 %.
///
/// # Errors
/// As [`estimate_motion`](crate::estimate_motion).
pub fn estimate_motion_and_sensors(
    log: &SensorLog,
    known: &KnownBody,
    priors: &SensorPriors,
) -> Result<SensorEstimate, EstimateError> {
    let track = Track::new(log, known.mass.mass(), known.gravity, known.palm_inertias)
        .map_err(EstimateError::Track)?;
    let deviations = CONSTANTS.map(|constant| priors.of(constant));
    let (motion, refined) = estimate_with_constants::<STATES>(&track, known, &CONSTANTS, &deviations)?;
    let (first, covariance) = (&refined.solution.states[0], &refined.solution.covariances[0]);
    let constants = std::array::from_fn(|k| {
        let state = MOTION_STATES + k;
        SensorConstant {
            name: CONSTANTS[k].name(),
            value: first[state],
            deviation: covariance[(state, state)].max(0.0).sqrt(),
        }
    });
    Ok(SensorEstimate { motion, constants })
}
