use crate::sample::NORMAL_TOLERANCE;
use exact_hull::planar::{Direction, DirectionError, HalfPlane};
use glam::DVec2;
use thiserror::Error;

/// Why a point and a normal are not a contact.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactError {
    /// A coordinate of the point is NaN or infinite.
    #[error("contact {index}: point ({}, {}) has a coordinate that is not finite", point.x, point.y)]
    Point {
        /// Which contact.
        index: usize,
        /// The point as given.
        point: DVec2,
    },
    /// The normal is not a unit vector.
    #[error("contact {index}: outward normal: {reason}")]
    Normal {
        /// Which contact.
        index: usize,
        /// What is wrong with it.
        reason: DirectionError,
    },
}

/// One contact: a point of the outline and the outward normal there, both in the body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSample {
    /// Contact point in m.
    pub point: DVec2,
    /// Outward unit normal of the body.
    pub normal: Direction,
}

impl ContactSample {
    /// Contacts from points (m) and outward unit normals in the body's frame, as read from a file.
    ///
    /// # Errors
    /// [`ContactError`] names the first contact that is not finite or whose normal is further from unit length than
    /// [`NORMAL_TOLERANCE`].
    pub fn from_raw(raw: impl IntoIterator<Item = (DVec2, DVec2)>) -> Result<Vec<Self>, ContactError> {
        raw.into_iter()
            .enumerate()
            .map(|(index, (point, normal))| {
                if !point.is_finite() {
                    return Err(ContactError::Point { index, point });
                }
                let normal = Direction::from_unit(normal, NORMAL_TOLERANCE)
                    .map_err(|reason| ContactError::Normal { index, reason })?;
                Ok(Self { point, normal })
            })
            .collect()
    }

    /// The half-plane that contains a convex body with this contact.
    #[must_use]
    pub fn half_plane(&self) -> HalfPlane {
        HalfPlane { point: self.point, normal: self.normal, margin: 0.0 }
    }
}
