use glam::DVec3;
use thiserror::Error;

/// A unit vector, so that a normal that was not normalised cannot reach a formula that needs one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Direction(DVec3);

/// Why a vector is not a direction.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DirectionError {
    /// A component is NaN or infinite.
    #[error("direction ({0}, {1}, {2}) has a component that is not finite", vector.x, vector.y, vector.z)]
    NotFinite {
        /// The vector as given.
        vector: DVec3,
    },
    /// The vector has no direction.
    #[error("vector has length {length}; it must be above zero")]
    Zero {
        /// The length as computed.
        length: f64,
    },
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
    /// World or body X axis.
    pub const X: Self = Self(DVec3::X);
    /// World or body Y axis.
    pub const Y: Self = Self(DVec3::Y);
    /// World or body Z axis.
    pub const Z: Self = Self(DVec3::Z);

    /// The direction of `vector`, of any length above zero.
    ///
    /// # Errors
    /// [`DirectionError::NotFinite`] and [`DirectionError::Zero`].
    pub fn new(vector: DVec3) -> Result<Self, DirectionError> {
        if !vector.is_finite() {
            return Err(DirectionError::NotFinite { vector });
        }
        // Scaling first keeps the square from under- or overflowing.
        let scale = vector.abs().max_element();
        if scale == 0.0 {
            return Err(DirectionError::Zero { length: 0.0 });
        }
        let scaled = vector / scale;
        let unit = scaled / scaled.length();
        if unit.is_finite() { Ok(Self(unit)) } else { Err(DirectionError::Zero { length: scale }) }
    }

    /// The direction of `vector`, which must be of unit length to within `tolerance`: for data that claim to be unit.
    ///
    /// # Errors
    /// [`DirectionError::NotUnit`] when the length departs from 1 by more than `tolerance`, and those of [`Self::new`].
    pub fn from_unit(vector: DVec3, tolerance: f64) -> Result<Self, DirectionError> {
        let direction = Self::new(vector)?;
        let length = vector.length();
        if (length - 1.0).abs() > tolerance {
            return Err(DirectionError::NotUnit { length, tolerance });
        }
        Ok(direction)
    }

    /// Takes a vector that is of unit length by construction, such as a rotated direction.
    #[must_use]
    #[inline]
    pub fn new_unchecked(unit: DVec3) -> Self {
        debug_assert!((unit.length() - 1.0).abs() < 1e-6, "not a unit vector: {unit}");
        Self(unit)
    }

    /// The unit vector.
    #[must_use]
    #[inline]
    pub fn get(self) -> DVec3 {
        self.0
    }

    /// Two unit vectors `(a, b)` that make `(a, b, self)` a right-handed orthonormal triple.
    ///
    /// Continuous except at one point; use it where any tangent basis serves.
    #[must_use]
    pub fn tangent_basis(self) -> (DVec3, DVec3) {
        let a = self.0.any_orthonormal_vector();
        (a, self.0.cross(a))
    }
}

impl std::ops::Neg for Direction {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn extreme_lengths_keep_their_direction() {
        for scale in [1e-300, 1e-150, 1.0, 1e150, 1e300] {
            let direction = Direction::new(DVec3::new(3.0, 0.0, 4.0) * scale).unwrap();
            assert!((direction.get() - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-15);
        }
    }

    #[test]
    fn bad_vectors_are_named() {
        assert!(matches!(Direction::new(DVec3::ZERO), Err(DirectionError::Zero { .. })));
        assert!(matches!(Direction::new(DVec3::NAN), Err(DirectionError::NotFinite { .. })));
        assert!(matches!(Direction::from_unit(DVec3::X * 1.1, 1e-3), Err(DirectionError::NotUnit { .. })));
    }

    proptest! {
        #[test]
        fn tangent_basis_is_right_handed(x in -1.0..1.0f64, y in -1.0..1.0f64, z in -1.0..1.0f64) {
            prop_assume!(DVec3::new(x, y, z).length() > 1e-3);
            let n = Direction::new(DVec3::new(x, y, z)).unwrap();
            let (a, b) = n.tangent_basis();
            prop_assert!((a.cross(b) - n.get()).length() < 1e-14);
            prop_assert!(a.dot(b).abs() < 1e-15 && a.dot(n.get()).abs() < 1e-15);
        }
    }
}
