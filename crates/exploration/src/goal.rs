//! What is to be known of the shape.

use crate::heading::Heading;
use thiserror::Error;

/// How well a shape is to be known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal<H> {
    /// Volume (area in the plane) between the bounds over that of the upper one, at most this.
    Gap(f64),
    /// Hausdorff distance of the bounds at most this, in m.
    Hausdorff(f64),
    /// The width of the body in a direction, known to within this, in m.
    Width {
        /// The direction.
        along: H,
        /// How much the widths of the bounds may differ, in m.
        within: f64,
    },
}

/// Why a goal is none.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GoalError {
    /// Not a number, or infinite.
    #[error("goal {value}: it must be a finite number")]
    NotFinite {
        /// As given.
        value: f64,
    },
    /// Below zero.
    #[error(
        "goal {value}: the upper bound contains the lower one, so that no gap is below 0; ask for a positive one"
    )]
    Negative {
        /// As given.
        value: f64,
    },
    /// Zero.
    #[error(
        "goal 0: no number of touches closes the gap around a curved body, and rounding leaves one around a polytope; ask for \
         what you need, 1e-9 where the body is known to be a polytope"
    )]
    Zero,
}

impl<H: Heading> Goal<H> {
    /// The number that is to be reached.
    #[must_use]
    pub fn value(&self) -> f64 {
        match self {
            Self::Gap(value) | Self::Hausdorff(value) | Self::Width { within: value, .. } => *value,
        }
    }

    /// Whether it is a goal.
    ///
    /// # Errors
    /// [`GoalError`] for what is not above zero and finite.
    pub fn check(&self) -> Result<(), GoalError> {
        let value = self.value();
        if !value.is_finite() {
            Err(GoalError::NotFinite { value })
        } else if value < 0.0 {
            Err(GoalError::Negative { value })
        } else if value == 0.0 {
            Err(GoalError::Zero)
        } else {
            Ok(())
        }
    }

    /// Its kind in a word, as in files.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Gap(_) => "gap",
            Self::Hausdorff(_) => "hausdorff",
            Self::Width { .. } => "width",
        }
    }
}
