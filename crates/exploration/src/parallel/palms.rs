//! What palms do and feel.

use super::hold::{Hold, Stop};
use observer::rolling::{RollingError, RollingReading};
use shape_bounds::ContactSample;
use shape_bounds::noise::ContactNoise;
use thiserror::Error;

/// What is felt at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeltBetween {
    /// Orientation and places on the pads.
    pub hold: Hold,
    /// Contacts on the upper and the lower palm, body axes, m.
    pub contacts: [ContactSample; 2],
    /// How far these may be off, with the pose that they were made in; none of exact ones.
    pub noise: Option<[ContactNoise; 2]>,
    /// How far the upper palm moved since the reading before, m.
    pub way: f64,
    /// Why it moved no farther; none where it did as it was told.
    pub stop: Option<Stop>,
}

/// Why nothing is felt.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ParallelPalmsError {
    /// A contact or an orientation that is not finite.
    #[error("the {palm} palm felt a contact that is not finite")]
    NotFinite {
        /// `upper` or `lower`.
        palm: &'static str,
    },
    /// A stroke that is none.
    #[error(
        "the palm is to move along {heading} rad until the body has turned by {turn} rad: both must be finite"
    )]
    Stroke {
        /// As asked for, rad.
        heading: f64,
        /// As asked for, rad.
        turn: f64,
    },
    /// No orientation was found in which friction holds the body.
    #[error(
        "the body tips over between the palms and is held nowhere: its friction, {friction}, is too little"
    )]
    NotHeld {
        /// Of the palms.
        friction: f64,
    },
    /// What was sensed gives no pose (any more).
    #[error(transparent)]
    Sensed(#[from] RollingError),
}

/// Two parallel palms that sense where they are and where they are touched, and nothing else.
pub trait SensedPalms {
    /// What is sensed now.
    ///
    /// # Errors
    /// [`ParallelPalmsError`].
    fn sense(&mut self) -> Result<RollingReading, ParallelPalmsError>;

    /// Moves the upper palm straight along `heading` (rad from world X) until the body has turned by `turn` rad or something stops it: all that was
    /// sensed on the way, and what stopped it.
    ///
    /// # Errors
    /// [`ParallelPalmsError`].
    fn stroke(
        &mut self,
        heading: f64,
        turn: f64,
    ) -> Result<(Vec<RollingReading>, Option<Stop>), ParallelPalmsError>;
}

/// Two parallel palms with a body between them, felt in its own axes.
pub trait ParallelPalms {
    /// What is felt now.
    ///
    /// # Errors
    /// [`ParallelPalmsError`].
    fn feel(&mut self) -> Result<FeltBetween, ParallelPalmsError>;

    /// Moves the upper palm straight along `heading` (rad from world X) until the body has turned by `turn` rad or something stops it, and feels.
    ///
    /// # Errors
    /// [`ParallelPalmsError`].
    fn roll(&mut self, heading: f64, turn: f64) -> Result<FeltBetween, ParallelPalmsError>;
}
