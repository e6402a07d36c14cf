use super::BodyState;
use crate::integrate::IntegrationError;
use crate::planar::contacts::{Jammed, ModeError};
use contact_kinematics::planar::ContactError;
use thiserror::Error;

/// Why a simulation with contacts cannot start or go on. Palms are numbered from 1.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ContactSimulationError {
    /// Sample times are missing, do not increase, or one is not a number.
    #[error(
        "sample {index} is at {time} s; there must be one at least, and times must be finite and increase"
    )]
    Times {
        /// Index from 0.
        index: usize,
        /// As given, s; NaN where none was given.
        time: f64,
    },
    /// The start cannot be used.
    #[error("start: {0}")]
    Start(#[from] StartError),
    /// A contact cannot be computed.
    #[error("at t = {t} s, {source}")]
    Contact {
        /// Time in s.
        t: f64,
        /// Which, and why.
        source: FieldError,
    },
    /// The laws of contact and friction give no answer, or two.
    #[error("at t = {t} s, with the object at {state:?}: {source}")]
    Modes {
        /// Time in s.
        t: f64,
        /// State there.
        state: BodyState,
        /// Why.
        source: ModeError,
    },
    /// The integrator cannot go on.
    #[error(transparent)]
    Integration(#[from] IntegrationError<FieldError>),
    /// Contacts come and go without end.
    #[error("contacts changed {changes} times up to t = {t} s without the motion going on")]
    Stalled {
        /// Time in s.
        t: f64,
        /// Changes within the last natural time.
        changes: usize,
    },
}

/// Why accelerations cannot be told.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum FieldError {
    /// A contact cannot be computed.
    #[error("palm {palm}: {source}")]
    Contact {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: ContactError,
    },
    /// The contacts are jammed.
    #[error(transparent)]
    Jammed(#[from] Jammed),
}

/// Why a state is no start. Palms are numbered from 1.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum StartError {
    /// A number is not finite.
    #[error("the object's position, orientation or velocity is not finite")]
    NotFinite,
    /// A palm that is asked to touch is not there.
    #[error("scene has no palm {palm}; it has {count}")]
    NoPalm {
        /// As asked for.
        palm: usize,
        /// Number of palms.
        count: usize,
    },
    /// The object is inside of a palm.
    #[error(
        "object and palm {palm} penetrate: their gap is {gap:.3e} m; move the object, or place it on the palms first"
    )]
    Penetration {
        /// Palm number.
        palm: usize,
        /// Gap, m.
        gap: f64,
    },
    /// The object does not touch a palm that it is said to touch.
    #[error(
        "object does not touch palm {palm} as asked: their gap is {gap:.3e} m; place it on the palms first"
    )]
    OutOfContact {
        /// Palm number.
        palm: usize,
        /// Gap, m.
        gap: f64,
    },
    /// The velocity takes the object off or into a palm that it is said to touch.
    #[error(
        "the gap to palm {palm} changes at {rate:.3e} m/s; in contact it must not: place the object on the palms first"
    )]
    NotAlong {
        /// Palm number.
        palm: usize,
        /// Rate of the gap, m/s.
        rate: f64,
    },
    /// The palms leave no room.
    #[error(
        "palms leave no room for the object: touching those asked for it is still {gap:.3e} m off palm {palm}"
    )]
    NoRoom {
        /// Palm number.
        palm: usize,
        /// Gap that is left, m.
        gap: f64,
    },
}
