//! Surfaces of palms of any pose and motion, and the one contact of a smooth convex body with each.

mod contact;
mod error;
mod forward;
mod motion;
mod nearest;
mod pose;
mod pressure;
mod rates;
mod table;

pub use contact::{BodyPlace, SurfaceContact};
pub use error::{ContactError, FASTEST_PALM, FASTEST_TURN, SurfaceError};
pub use motion::{MotionPart, SurfaceMotion};
pub use nearest::SurfacePoint;
pub use pose::{SurfacePose, SurfaceState};
pub use pressure::{Pressed, PressureError, TaxelArray};
pub use rates::SurfaceRates;
pub use table::PoseTable;

use crate::CurvatureRadii;

/// The shape of a palm in its own frame `P`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PalmSurface {
    /// The plane `z = 0`; the object is on the side `z > 0`.
    Plane,
    /// A ball about the origin, such as a fingertip; the object is outside of it.
    Sphere {
        /// Radius in m.
        radius: f64,
    },
    /// A hollow sphere about the origin; the object is inside of it (paper, section 9).
    Cup {
        /// Radius in m.
        radius: f64,
    },
    /// An endless cylinder about the x axis; the object is outside of it.
    Cylinder {
        /// Radius in m.
        radius: f64,
    },
}

impl PalmSurface {
    /// Checks the radius, and that a body of these curvature radii can touch the palm in one point alone.
    ///
    /// # Errors
    /// [`SurfaceError::Radius`]; [`SurfaceError::CupTooSmall`] unless a cup is hollower than the body is flat.
    pub fn check(&self, body: CurvatureRadii) -> Result<(), SurfaceError> {
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

    /// The radius in m, of all but the plane.
    #[must_use]
    pub fn radius(&self) -> Option<f64> {
        match *self {
            Self::Plane => None,
            Self::Sphere { radius } | Self::Cup { radius } | Self::Cylinder { radius } => Some(radius),
        }
    }

    /// Curvatures of the palm inflated by `gap` (m), along its axis and across it, 1/m: positive where it bulges towards the
    /// object. They are the same in all directions but on a cylinder.
    #[must_use]
    pub fn curvatures(&self, gap: f64) -> [f64; 2] {
        match *self {
            Self::Plane => [0.0; 2],
            Self::Sphere { radius } => [1.0 / (radius + gap); 2],
            Self::Cup { radius } => [1.0 / (gap - radius); 2],
            Self::Cylinder { radius } => [0.0, 1.0 / (radius + gap)],
        }
    }

    /// Name of the kind, as it stands in files: `flat`, `sphere`, `cup` or `cylinder`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Plane => "flat",
            Self::Sphere { .. } => "sphere",
            Self::Cup { .. } => "cup",
            Self::Cylinder { .. } => "cylinder",
        }
    }
}
