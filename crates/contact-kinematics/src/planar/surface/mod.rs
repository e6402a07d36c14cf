//! Surfaces of palms of any pose and motion, and the one contact of a smooth convex body with each.

mod contact;
mod error;
mod forward;
mod motion;
mod pose;
mod rates;

#[cfg(test)]
mod tests;

pub use contact::{BodyPlace, SurfaceContact};
pub use error::{ContactError, SurfaceError};
pub use motion::{MotionPart, SurfaceMotion};
pub use pose::{SurfacePose, SurfaceState};
pub use rates::SurfaceRates;

use super::radius::RadiusBounds;

/// The shape of a palm in its own frame `P`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PalmSurface {
    /// The line `y = 0`; the object is on the side `y > 0`.
    Line,
    /// A disc about the origin, such as a fingertip; the object is outside of it.
    Arc {
        /// Radius in m.
        radius: f64,
    },
    /// A hollow circle about the origin; the object is inside of it.
    Cup {
        /// Radius in m.
        radius: f64,
    },
}

impl PalmSurface {
    /// Checks the radius, and that a body of these curvature radii can touch the palm in one point alone.
    ///
    /// # Errors
    /// [`SurfaceError::Radius`]; [`SurfaceError::CupTooSmall`] unless a cup is hollower than the body is flat.
    pub fn check(&self, body: RadiusBounds) -> Result<(), SurfaceError> {
        let Some(radius) = self.radius() else { return Ok(()) };
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(SurfaceError::Radius { radius });
        }
        match self {
            Self::Cup { .. } if radius <= body.max => {
                Err(SurfaceError::CupTooSmall { radius, largest: body.max })
            }
            _ => Ok(()),
        }
    }

    /// The radius in m, of all but the line.
    #[must_use]
    pub fn radius(&self) -> Option<f64> {
        match *self {
            Self::Line => None,
            Self::Arc { radius } | Self::Cup { radius } => Some(radius),
        }
    }
}
