//! The same in the plane.

use glam::DVec2;
use thiserror::Error;

/// A unit vector in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction(DVec2);

/// Why a vector is not a direction.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DirectionError {
    /// A component is NaN or infinite.
    #[error("direction ({0}, {1}) has a component that is not finite", vector.x, vector.y)]
    NotFinite {
        /// The vector as given.
        vector: DVec2,
    },
    /// The vector has no direction.
    #[error("vector has length zero")]
    Zero,
    /// The vector is further from unit length than stated.
    #[error("vector has length {length}, further from 1 than {tolerance}; normalise it or mend its units")]
    NotUnit {
        /// The length as computed.
        length: f64,
        /// The largest departure from 1 that is taken for rounding.
        tolerance: f64,
    },
}

impl Direction {
    /// The direction of `vector`, of any length above zero.
    ///
    /// # Errors
    /// [`DirectionError::NotFinite`] and [`DirectionError::Zero`].
    pub fn new(vector: DVec2) -> Result<Self, DirectionError> {
        if !vector.is_finite() {
            return Err(DirectionError::NotFinite { vector });
        }
        // Scaling first keeps the square from under- or overflowing.
        let scaled = vector / vector.abs().max_element();
        if scaled.is_finite() { Ok(Self(scaled / scaled.length())) } else { Err(DirectionError::Zero) }
    }

    /// The direction of `vector`, which must be of unit length to within `tolerance`.
    ///
    /// # Errors
    /// [`DirectionError::NotUnit`] when the length departs from 1 by more than `tolerance`, and those of [`Self::new`].
    pub fn from_unit(vector: DVec2, tolerance: f64) -> Result<Self, DirectionError> {
        let direction = Self::new(vector)?;
        let length = vector.length();
        if (length - 1.0).abs() > tolerance {
            return Err(DirectionError::NotUnit { length, tolerance });
        }
        Ok(direction)
    }

    /// At `angle` (rad) from the x axis, counter-clockwise.
    #[must_use]
    #[inline]
    pub fn from_angle(angle: f64) -> Self {
        Self(DVec2::from_angle(angle))
    }

    /// The unit vector.
    #[must_use]
    #[inline]
    pub fn get(self) -> DVec2 {
        self.0
    }

    /// Angle from the x axis in rad, in (-pi, pi].
    #[must_use]
    pub fn angle(self) -> f64 {
        self.0.to_angle()
    }
}

impl std::ops::Neg for Direction {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
