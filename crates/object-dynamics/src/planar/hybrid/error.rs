use super::BodyState;
use crate::integrate::IntegrationError;
use crate::planar::contacts::{Jammed, ModeError};
use contact_kinematics::planar::ContactError;
use thiserror::Error;

/// Why a simulation with contacts cannot start or go on. Palms are numbered from 1.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
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
    /// Two endless palms are one and the same.
    #[error("palms {first} and {second} ({kind}) are one and the same at the start; leave one of them out")]
    PalmsCoincide {
        /// Palm number from 1.
        first: usize,
        /// Palm number from 1.
        second: usize,
        /// Their kind, as in files.
        kind: &'static str,
    },
    /// Two palms overlap each other.
    #[error("palms {first} and {second} overlap by {depth:.3e} m at the start; move them apart")]
    PalmsOverlap {
        /// Palm number from 1.
        first: usize,
        /// Palm number from 1.
        second: usize,
        /// How deep, m.
        depth: f64,
    },
    /// A contact could not be found.
    #[error("at t = {t} s: {source}")]
    Contact {
        /// Time in s.
        t: f64,
        /// Why.
        source: FieldError,
    },
    /// No contact modes, or more than one set, follow from rigid bodies with Coulomb friction.
    #[error("at t = {t} s: {source}")]
    Modes {
        /// Time in s.
        t: f64,
        /// The body there.
        body: BodyState,
        /// Why.
        source: ModeError,
    },
    /// The integrator cannot go on.
    #[error(transparent)]
    Integration(#[from] IntegrationError<FieldError>),
    /// Steps so small that the end is out of reach.
    #[error(
        "steps are down to {step:.1e} s at t = {t:.3e} s, where the object turns at {spin:.3e} rad/s and moves at {speed:.3e} m/s; slow down \
         object and palms, or allow a larger tolerance"
    )]
    TooSlow {
        /// Time reached, s.
        t: f64,
        /// Step, s.
        step: f64,
        /// Angular speed of the body there, rad/s.
        spin: f64,
        /// Speed of its centre of mass there, m/s.
        speed: f64,
    },
    /// Modes change without end in no time.
    #[error(
        "{count} mode changes within {span:.1e} s at t = {t} s: they pile up, and rigid contacts say no more"
    )]
    TooManyEvents {
        /// How many.
        count: usize,
        /// Within what time, s.
        span: f64,
        /// When, s.
        t: f64,
    },
}

/// Why a contact with a palm cannot be told.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("palm {palm}: {source}")]
pub struct PalmContactError {
    /// Palm number from 1.
    pub palm: usize,
    /// Why.
    pub source: ContactError,
}

/// Why accelerations cannot be told.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FieldError {
    /// A contact.
    #[error(transparent)]
    Contact(#[from] PalmContactError),
    /// The contacts are jammed.
    #[error(transparent)]
    Jammed(#[from] Jammed),
}

/// Why a state is no start. Palms are numbered from 1.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
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
    NotInContact {
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
