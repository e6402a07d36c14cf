use exact_hull::{Direction, DirectionError, HalfSpace};
use glam::DVec3;
use thiserror::Error;

/// How far the length of a normal may depart from 1 and still be taken for a rounded unit vector: six printed digits.
pub const NORMAL_TOLERANCE: f64 = 2e-6;

/// Why a point and a normal are not a contact.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactError {
    /// A coordinate of the point is NaN or infinite.
    #[error("contact {index}: point ({}, {}, {}) has a coordinate that is not finite", point.x, point.y, point.z)]
    Point {
        /// Which contact.
        index: usize,
        /// The point as given.
        point: DVec3,
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

/// One contact: a point of the body's surface and the outward normal there, both in the body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSample {
    /// Contact point, the paper's `beta`, in m.
    pub point: DVec3,
    /// Outward unit normal of the body.
    pub normal: Direction,
}

impl ContactSample {
    /// Contacts from points (m) and outward unit normals in the body's frame, as read from a file.
    ///
    /// # Errors
    /// [`ContactError`] names the first contact that is not finite or whose normal is further from unit length than
    /// [`NORMAL_TOLERANCE`].
    pub fn from_raw(raw: impl IntoIterator<Item = (DVec3, DVec3)>) -> Result<Vec<Self>, ContactError> {
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

    /// The half-space that contains a convex body with this contact (paper, section 8).
    #[must_use]
    pub fn half_space(&self) -> HalfSpace {
        HalfSpace { point: self.point, normal: self.normal, margin: 0.0 }
    }
}
