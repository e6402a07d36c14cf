//! What can go wrong in a planar simulation or with a planar log.

use crate::SeriesError;
use crate::integrate::IntegrationError;
use crate::series::MOST_READING;
use contact_kinematics::planar::PalmPairError;
use thiserror::Error;

/// Why a planar simulation cannot go on.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PlanarSimulationError {
    /// The palms close or flatten their wedge, or the step size collapses.
    #[error(transparent)]
    Integration(#[from] IntegrationError<PalmPairError>),
    /// Sample times do not increase, or one is not a number.
    #[error("sample {index} is at {time} s; times must be finite and increase")]
    Times {
        /// Index from 0.
        index: usize,
        /// As given, s.
        time: f64,
    },
    /// No sample time was given.
    #[error("no sample times were given; at least one is needed")]
    NoTimes,
    /// A palm inertia is not positive.
    #[error("inertia of palm {palm} is {value} kg m^2; it must be positive and finite")]
    PalmInertia {
        /// 1 or 2.
        palm: usize,
        /// As given, kg m^2.
        value: f64,
    },
}

/// Why samples are not a planar log.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PlanarLogError {
    /// Too few samples, out of order, or with truth of another length.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// A normal contact force pulls.
    #[error("force of palm {palm} at sample {sample} is {value} N; a palm cannot pull")]
    NegativeForce {
        /// 1 or 2.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// As given, N.
        value: f64,
    },
    /// A reading is not a number.
    #[error("{what} of sample {sample} is {value}; it must be finite")]
    NotFinite {
        /// Which reading.
        what: &'static str,
        /// Index from 0.
        sample: usize,
        /// As given.
        value: f64,
    },
    /// A reading is larger than any.
    #[error(
        "{what} of sample {sample} is {value:.3e}; {MOST_READING:e} is the most that is taken; check its unit"
    )]
    TooLarge {
        /// Which reading.
        what: &'static str,
        /// Index from 0.
        sample: usize,
        /// As given.
        value: f64,
    },
    /// The wedge is closed or flat.
    #[error("sample {sample}: {source}")]
    Palms {
        /// Index from 0.
        sample: usize,
        /// Why.
        source: PalmPairError,
    },
}
