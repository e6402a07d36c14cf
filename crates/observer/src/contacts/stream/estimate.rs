use super::modes::StreamModes;
use crate::contacts::options::{ContactEstimateError, ContactOptions};
use glam::DMat3;
use nalgebra::SMatrix;
use object_dynamics::{BodyState, MOST_PALMS, RepeatedReading};
use thiserror::Error;

/// What a stream must know beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamOptions {
    /// Noise, gravity, friction, and the body where it is known. Joint errors are for whole logs; score tests take a stream half as long as its motion;
    /// modes take as many solutions more as palms stick, on the other thread.
    pub contacts: ContactOptions,
    /// Samples a second, about.
    pub sample_rate: f64,
}

impl StreamOptions {
    pub(super) fn check(&self) -> Result<(), StreamError> {
        self.contacts.check()?;
        let value = self.sample_rate;
        let fine = value > 0.0 && value.is_finite();
        let wrong = StreamError::Option { what: "sample rate", value, needed: "positive and finite" };
        if fine { Ok(()) } else { Err(wrong) }
    }
}

/// The motion at a sample, with the confidence that the data so far allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamEstimate {
    /// s.
    pub t: f64,
    /// The motion; none before one was found. Axes of an unknown body are those of the world where it was found, those of a known one its own,
    /// up to half turns about principal axes, which leave no trace.
    pub motion: Option<StreamMotion>,
    /// How it stands.
    pub stage: StreamStage,
    /// Palms that are touched at this sample.
    pub touching: [bool; MOST_PALMS],
    /// How probable the contact modes are; none before there was a motion, and unless [`ContactOptions::mode_odds`] asks for it.
    pub modes: Option<StreamModes>,
}

/// A motion, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamMotion {
    /// The motion.
    pub state: BodyState,
    /// Covariance of centre of mass (m), velocity (m/s), angular velocity (rad/s) and orientation (rotation vector, rad), three each, world
    /// axes.
    pub covariance: SMatrix<f64, 12, 12>,
    /// The body.
    pub body: StreamBody,
    /// Squared corrections of all readings of the latest window, in their deviations, over the number of conditions: about 1 when all is as stated.
    pub misfit: f64,
    /// Time of the latest window's end, s: from there the motion follows from forces alone.
    pub corrected: f64,
}

/// Mass and inertia: as stated, or as estimated from the latest window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamBody {
    /// kg.
    pub mass: f64,
    /// Its standard deviation, kg; zero where it was stated.
    pub mass_deviation: f64,
    /// Inertia tensor about the centre of mass, kg m^2, body axes.
    pub inertia: DMat3,
    /// Covariance of its entries xx, yy, zz, xy, xz, yz, (kg m^2)^2; zero where it was stated.
    pub inertia_covariance: [[f64; 6]; 6],
}

/// How a stream's estimate stands.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum StreamStage {
    /// Too few data for any motion.
    Gathering,
    /// Motions were looked for, and none explains the data or is known well enough.
    Searching {
        /// How often.
        rounds: usize,
    },
    /// The motion is followed; its covariance holds.
    Tracking,
    /// The data of the latest window contradict the motion by more than noise: a wrong constant, as a force sensor's gain, or a wrong motion.
    Contradicted,
}

/// Why a stream cannot start, or cannot use a sample.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StreamError {
    /// An option is not a usable number.
    #[error("{what} is {value}; it must be {needed}")]
    Option {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
        /// What it has to be.
        needed: &'static str,
    },
    /// A setting of the estimate.
    #[error(transparent)]
    Estimate(#[from] ContactEstimateError),
    /// Time stands still, runs backwards, or is no number.
    #[error("t is {t} s after {previous} s; times must be finite and increase")]
    Time {
        /// As given, s.
        t: f64,
        /// Of the sample before; not finite for the first one.
        previous: f64,
    },
    /// A reading is no number.
    #[error("{what} of palm {palm} at t = {t} s is {value}; it must be finite, or absent without contact")]
    Reading {
        /// Which.
        what: &'static str,
        /// Palm from 1.
        palm: usize,
        /// s.
        t: f64,
        /// As given.
        value: f64,
    },
    /// A sample has not one reading of each palm.
    #[error("{found} palms at t = {t} s; the stream has {expected}")]
    Palms {
        /// How many readings.
        found: usize,
        /// Palms of the stream.
        expected: usize,
        /// s.
        t: f64,
    },
    /// A palm's axes at a sample.
    #[error("palm {palm} at t = {t} s: {source}")]
    Frame {
        /// From 1.
        palm: usize,
        /// s.
        t: f64,
        /// What is wrong with them.
        source: contact_kinematics::PalmError,
    },
    /// A palm has neither a force nor a torque that tells it.
    #[error(
        "palm {palm} at t = {t} s has no force, and no torque with a moment of inertia and a lever to take one from; of an ellipsoid `recon reconstruct --without-forces` needs none"
    )]
    NoForce {
        /// From 1.
        palm: usize,
        /// s.
        t: f64,
    },
    /// A reading repeats, which its noise never lets it.
    #[error(
        "the {what} of palm {palm} at t = {t} s repeats for {run} samples in a row, which its noise never lets it: a sensor that is frozen, or at the end of its range"
    )]
    Stuck {
        /// Which.
        what: RepeatedReading,
        /// Palm from 1.
        palm: usize,
        /// s.
        t: f64,
        /// Samples in a row that repeat the one before.
        run: usize,
    },
    /// The system gives no thread to estimate in, or it is gone.
    #[error(
        "there is no thread to estimate the motion in: ask the system for one more; of an ellipsoid `recon reconstruct --without-forces` needs none"
    )]
    Thread,
}
