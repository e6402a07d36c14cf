//! What the palms can do.

use thiserror::Error;

/// Limits of two parallel palms, and what is known of the body's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelWorkspace {
    /// Coefficient of friction of both palms.
    pub friction: f64,
    /// Palms stop where the tangential force is this share of what friction holds, in (0, 1].
    pub share: f64,
    /// Radius of the pads, m: contacts stay within it.
    pub pad: f64,
    /// Mean width of the body in m, roughly: it turns ways into angles, and bodies are drawn so large where little is known. No proof rests on it.
    pub size: f64,
}

/// Why limits are none.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ParallelWorkspaceError {
    /// A number that is none or has the wrong sign.
    #[error("{what} is {value}; it must be positive and finite")]
    Positive {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// A share that is none.
    #[error("the share of friction at which palms stop is {value}; it must be above 0 and at most 1")]
    Share {
        /// As given.
        value: f64,
    },
}

impl ParallelWorkspace {
    /// Pads three times as wide as a body of mean width `size` (m), with this friction, that stop at nine tenths of it.
    #[must_use]
    pub fn for_size(size: f64, friction: f64) -> Self {
        Self { friction, share: 0.9, pad: 1.5 * size, size }
    }

    /// Whether these are limits.
    ///
    /// # Errors
    /// [`ParallelWorkspaceError`] names the first that is none.
    pub fn check(&self) -> Result<(), ParallelWorkspaceError> {
        let numbers = [
            ("the coefficient of friction", self.friction),
            ("the radius of the pads", self.pad),
            ("the size of the body", self.size),
        ];
        for (what, value) in numbers {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ParallelWorkspaceError::Positive { what, value });
            }
        }
        if !(self.share > 0.0 && self.share <= 1.0) {
            return Err(ParallelWorkspaceError::Share { value: self.share });
        }
        Ok(())
    }

    /// The largest ratio of tangential to normal force at which palms go on.
    #[must_use]
    pub fn most_shear(&self) -> f64 {
        self.share * self.friction
    }
}
