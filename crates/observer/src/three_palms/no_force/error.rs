use crate::three_palms::track::TrackError;
use contact_kinematics::PalmError;
use glam::DVec3;
use thiserror::Error;

/// Why a log without forces gives no estimate.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum NoForceError {
    /// The log cannot be used.
    #[error("{0}")]
    Log(#[source] TrackError),
    /// The palms do not hold a body.
    #[error("palms at t = {t} s: {source}")]
    Palms {
        /// Time in s.
        t: f64,
        /// Why.
        source: PalmError,
    },
    /// Without gravity, or with one that is not a number, nothing gives the motion a time scale.
    #[error("gravity is ({}, {}, {}) m/s^2; it must be finite and not zero", gravity.x, gravity.y, gravity.z)]
    Gravity {
        /// As given.
        gravity: DVec3,
    },
    /// The noise is not a usable number.
    #[error("noise of the contact positions is {value} m; it must be positive and finite")]
    Noise {
        /// As given, m.
        value: f64,
    },
    /// The log spans less than the motion needs to show itself.
    #[error(
        "the log spans {seconds} s of contact; at least {needed:.2} s are needed for a body of this size"
    )]
    TooShort {
        /// Time in contact, s.
        seconds: f64,
        /// What it takes, s.
        needed: f64,
    },
    /// No ellipsoid in any motion fits.
    #[error(
        "no ellipsoid fits the log: the best leaves {residual:.1e} m where noise leaves {noise:.1e} m; the object may \
         be no ellipsoid, or the search did not find its motion"
    )]
    NoFit {
        /// Root mean square of the residuals of the best fit, m; not finite where there is none.
        residual: f64,
        /// Noise of the block means, m.
        noise: f64,
    },
    /// The fit was still on its way when its iterations ran out, so its shape and motion are no minimum.
    #[error(
        "the fit did not settle in {iterations} iterations ({residual:.1e} m are left where noise leaves {noise:.1e} m): the \
         log, or what moves in it, determines too little; a longer log, or palms that move, may"
    )]
    NotSettled {
        /// Iterations of the last fit.
        iterations: usize,
        /// Root mean square of the residuals where it was, m.
        residual: f64,
        /// Noise of the block means, m.
        noise: f64,
    },
    /// The data leave a direction of the unknowns open.
    #[error(
        "the log does not determine the unknowns: {words} has a standard deviation of {deviation:.1e} of its natural \
         size"
    )]
    NotDetermined {
        /// The direction in words.
        words: String,
        /// Its standard deviation in natural sizes; infinite where the data say nothing of it.
        deviation: f64,
    },
}
