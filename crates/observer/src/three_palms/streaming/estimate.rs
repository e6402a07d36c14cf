use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::momentum::MotionState;
use crate::three_palms::track::TrackError;
use glam::{DMat3, DVec3};
use nalgebra::SMatrix;
use object_dynamics::MassProperties;
use thiserror::Error;

/// Blocks a second: as many as the motion needs, whatever the sensors' rate.
const BLOCKS_PER_SECOND: f64 = 50.0;
/// What a stream must know beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamOptions {
    /// Mass and inertia, where they are known; else they are estimated along.
    pub mass: Option<MassProperties>,
    /// Acceleration of free fall, world, m/s^2.
    pub gravity: DVec3,
    /// Moments of inertia of the palms about their axes, kg m^2: needed only for torques of moving palms.
    pub palm_inertias: Option<[f64; 3]>,
    /// Noise of a sample: what the estimate's confidence and its test of innovations rest on.
    pub noise: NoiseLevel,
    /// Samples a second, about.
    pub sample_rate: f64,
}

impl StreamOptions {
    /// Samples in a block: odd, so that its node is its mean time.
    pub(super) fn stride(&self) -> Result<usize, StreamError> {
        let positive = |what, value: f64| {
            let fine = value > 0.0 && value.is_finite();
            if fine {
                Ok(())
            } else {
                Err(StreamError::Option { what, value, needed: "positive and finite" })
            }
        };
        positive("sample rate", self.sample_rate)?;
        positive("noise of contact positions", self.noise.contact)?;
        positive("noise of forces", self.noise.force)?;
        if !self.gravity.is_finite() {
            let value = self.gravity.length();
            return Err(StreamError::Option { what: "gravity", value, needed: "finite" });
        }
        Ok((self.sample_rate / BLOCKS_PER_SECOND / 2.0) as usize * 2 + 1)
    }
}

/// The motion at a sample, with the confidence that the data so far allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamEstimate {
    /// The motion. While [`StreamStage::Gathering`] or [`StreamStage::Searching`] it is that of a body at rest.
    pub motion: MotionState,
    /// Covariance of centre of mass (m), velocity (m/s), angular momentum (kg m^2/s) and orientation (rotation vector,
    /// world axes, rad), three each; while no motion is found, that of knowing nothing but the sizes.
    pub covariance: SMatrix<f64, 12, 12>,
    /// Mass and inertia where they are estimated; none before a motion is found.
    pub body: Option<StreamBody>,
    /// How it stands.
    pub stage: StreamStage,
    /// Mean squared innovation of the latest hundred contact conditions over what is expected: about one when all is as
    /// stated. NaN while no motion is found.
    pub innovation: f64,
    /// Palms that are without contact at this sample.
    pub lost: [bool; 3],
}

/// Mass and inertia as estimated so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamBody {
    /// kg.
    pub mass: f64,
    /// Its standard deviation, kg.
    pub mass_deviation: f64,
    /// Inertia tensor about the centre of mass, kg m^2, in body axes: those that were the world's at the first sample
    /// of the search.
    pub inertia: DMat3,
    /// Standard deviations of its entries, kg m^2.
    pub inertia_deviation: DMat3,
}

/// How a stream's estimate stands.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum StreamStage {
    /// Too few data for any motion.
    Gathering,
    /// Motions are tried, and none has explained the data so far.
    Searching {
        /// Families of starts that were tried.
        rounds: usize,
    },
    /// The motion is followed; its covariance holds.
    Tracking,
    /// The data contradict the motion by more than noise: a wrong constant, as a force sensor's gain, or a wrong motion.
    Contradicted,
}

/// Why a stream cannot start, or cannot use a sample.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
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
    /// A sample cannot be used.
    #[error("{0}")]
    Sample(#[source] TrackError),
}
