//! What a contact does: the vocabulary that plane and space share.

use thiserror::Error;

/// What a contact does at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ContactMode {
    /// The body does not touch the palm, or leaves it.
    Off,
    /// It slides: the friction is at its limit, against the slip.
    Slide,
    /// It sticks and rolls: the friction is what keeps the slip at zero.
    Stick,
}

impl ContactMode {
    /// All of them, in the order of their numbers in logs: 0 off, 1 slide, 2 stick.
    pub const ALL: [Self; 3] = [Self::Off, Self::Slide, Self::Stick];

    /// Its number in logs.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Self::Off => 0,
            Self::Slide => 1,
            Self::Stick => 2,
        }
    }

    /// Its letter in words about mode sets: `O`, `S` or `R` (rolling).
    #[must_use]
    pub fn letter(self) -> char {
        match self {
            Self::Off => 'O',
            Self::Slide => 'S',
            Self::Stick => 'R',
        }
    }
}

/// Largest coefficient of friction: a cone within 0.6 degrees of the tangent plane. Rubber on rubber reaches 2.
pub const MOST_FRICTION: f64 = 100.0;

/// Why a coefficient of friction cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("coefficient of friction is {value}; it must be from 0 to {MOST_FRICTION}")]
pub struct FrictionError {
    /// As given.
    pub value: f64,
}

/// A coefficient of Coulomb friction, at least zero and at most [`MOST_FRICTION`].
///
/// # Errors
/// [`FrictionError`].
pub fn check_friction(value: f64) -> Result<f64, FrictionError> {
    if (0.0..=MOST_FRICTION).contains(&value) { Ok(value) } else { Err(FrictionError { value }) }
}
