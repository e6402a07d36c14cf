//! Points with the power of two that keeps exact predicates exact.

use crate::PointsError;
use crate::predicates::above;
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use std::ops::Deref;

/// Sizes of coordinates, as powers of two, within which a predicate is exact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExactRange {
    largest: i32,
    smallest: i32,
}

impl ExactRange {
    /// Of orientations: coordinates of at most 2^330 keep a product of three differences below 2^1000, and those of at least
    /// 2^-300 have last bits of 2^-352, whose product of three, 2^-1056, is above the smallest subnormal, 2^-1074.
    pub(crate) const ORIENTATION: Self = Self { largest: 330, smallest: -300 };
    /// Of spheres through four points, a product of five: 2^980, and last bits of 2^-212, whose product is 2^-1060.
    pub(crate) const SPHERE: Self = Self { largest: 196, smallest: -160 };
    /// Of turns in the plane: products of two differences of coordinates up to 2^480 are finite, and with last bits of at
    /// least 2^-532 exact.
    pub(crate) const TURN: Self = Self { largest: 480, smallest: -480 };

    /// The power of two that brings coordinates of these sizes into the range, 1 for all ordinary data; `None` where none does.
    fn power(self, Sizes { smallest, largest }: Sizes) -> Option<f64> {
        if largest == 0.0 || (largest <= power(self.largest) && smallest >= power(self.smallest)) {
            return Some(1.0);
        }
        // No more than 2^1000, which is still a finite factor for sets of subnormal size.
        let exponent = (self.largest - 1 - exponent_of(largest)).min(1000);
        (exponent_of(smallest) + exponent >= self.smallest).then(|| power(exponent))
    }
}

/// The smallest size of a coordinate that is not zero, and the largest.
#[derive(Clone, Copy)]
struct Sizes {
    smallest: f64,
    largest: f64,
}

impl Sizes {
    const NONE: Self = Self { smallest: f64::INFINITY, largest: 0.0 };

    #[inline]
    fn take(&mut self, coordinates: impl IntoIterator<Item = f64>) {
        for c in coordinates {
            self.largest = self.largest.max(c.abs());
            if c != 0.0 && c.abs() < self.smallest {
                self.smallest = c.abs();
            }
        }
    }
}

/// Points in space (a slice or a `Vec`), and the power of two by which they are multiplied before a predicate sees them: 1 for all ordinary data.
///
/// Multiplying by a power of two is exact, so signs are those of the points as given. All that is decided of points in this
/// crate is decided of these.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledPoints<P> {
    points: P,
    scale: f64,
}

impl<P: Deref<Target = [DVec3]>> ScaledPoints<P> {
    /// For the orientation of four points.
    ///
    /// # Errors
    /// [`PointsError::NotFinite`], and [`PointsError::DynamicRange`] for coordinates whose sizes differ by more than 2^630.
    pub fn for_planes(points: P) -> Result<Self, PointsError> {
        Self::within(points, ExactRange::ORIENTATION)
    }

    /// For the sphere through four points and a fifth.
    ///
    /// # Errors
    /// [`PointsError::NotFinite`], and [`PointsError::DynamicRange`] for coordinates whose sizes differ by more than 2^356.
    pub fn for_spheres(points: P) -> Result<Self, PointsError> {
        Self::within(points, ExactRange::SPHERE)
    }

    fn within(points: P, range: ExactRange) -> Result<Self, PointsError> {
        let mut sizes = Sizes::NONE;
        for (index, p) in points.iter().enumerate() {
            if !p.is_finite() {
                return Err(PointsError::NotFinite { index, point: *p });
            }
            sizes.take(p.to_array());
        }
        let Sizes { smallest, largest } = sizes;
        match range.power(sizes) {
            Some(scale) => Ok(Self { points, scale }),
            None => Err(PointsError::DynamicRange { smallest, largest }),
        }
    }

    /// The points as given, in m.
    #[must_use]
    #[inline]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The power of two.
    #[must_use]
    #[inline]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// All points times the power of two, in the range of the predicate.
    #[must_use]
    pub fn scaled(&self) -> Cow<'_, [DVec3]> {
        if self.scale == 1.0 {
            return Cow::Borrowed(&self.points);
        }
        self.points.iter().map(|p| *p * self.scale).collect()
    }

    /// Positive where `p`, of a size like that of the points, is strictly outside of the plane through three of them
    /// (anticlockwise from outside), zero on it; exact.
    #[must_use]
    #[inline]
    pub fn above(&self, triangle: [u32; 3], p: DVec3) -> f64 {
        let [a, b, c] = triangle.map(|k| self.points[k as usize] * self.scale);
        above(a, b, c, p * self.scale)
    }
}

impl ScaledPoints<Vec<DVec3>> {
    /// The points of which `points` are the multiple by `scale`, a power of two.
    pub(crate) fn from_multiple(mut points: Vec<DVec3>, scale: f64) -> Self {
        if scale != 1.0 {
            points.iter_mut().for_each(|p| *p /= scale);
        }
        Self { points, scale }
    }
}

/// Whether a predicate of planes is exact for this point beside others of which the same holds.
pub(crate) fn is_exact_unscaled(p: DVec3) -> bool {
    let mut sizes = Sizes::NONE;
    sizes.take(p.to_array());
    ExactRange::ORIENTATION.power(sizes) == Some(1.0)
}

/// Why points in the plane have no power of two.
pub(crate) enum PlaneRange {
    NotFinite(usize),
    TooWide { smallest: f64, largest: f64 },
}

/// The power of two by which points in the plane are multiplied for exact turns; 1 for all ordinary data.
pub(crate) fn scale_in_plane(points: &[DVec2]) -> Result<f64, PlaneRange> {
    let mut sizes = Sizes::NONE;
    for (index, p) in points.iter().enumerate() {
        if !p.is_finite() {
            return Err(PlaneRange::NotFinite(index));
        }
        sizes.take(p.to_array());
    }
    let Sizes { smallest, largest } = sizes;
    ExactRange::TURN.power(sizes).ok_or(PlaneRange::TooWide { smallest, largest })
}

fn power(exponent: i32) -> f64 {
    2.0_f64.powi(exponent)
}

fn exponent_of(x: f64) -> i32 {
    // Exact enough: an error of one at a power of two only moves the limits by a factor of two.
    x.log2().floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_data_are_left_alone_and_extreme_data_are_brought_into_range() {
        let scale_of = |points: &[DVec3]| ScaledPoints::for_planes(points).map(|scaled| scaled.scale());
        assert_eq!(scale_of(&[DVec3::new(1e8, -3e-8, 0.0)]), Ok(1.0));
        for extreme in [1e-300, 1e-200, 1e200, 1e300] {
            let scale = scale_of(&[DVec3::splat(extreme), DVec3::splat(extreme * 1e-3)]).unwrap();
            let scaled = extreme * scale;
            let ExactRange { largest, smallest } = ExactRange::ORIENTATION;
            assert!(scaled <= power(largest) && scaled * 1e-3 >= power(smallest), "{extreme}");
            assert_eq!(scaled / scale, extreme);
        }
        let too_wide = scale_of(&[DVec3::new(1e150, 1e-150, 0.0)]);
        assert_eq!(too_wide, Err(PointsError::DynamicRange { smallest: 1e-150, largest: 1e150 }));
    }

    #[test]
    fn signs_of_extreme_points_are_those_of_ordinary_ones() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for exponent in [-1000, -400, 0, 400, 1000] {
            let grown = |p: DVec3| p * power(exponent);
            let scaled = ScaledPoints::for_planes(corners.map(grown).to_vec()).unwrap();
            assert!(scaled.above([0, 1, 2], grown(DVec3::new(0.3, 0.3, 1e-12))) > 0.0, "{exponent}");
            assert!(scaled.above([0, 1, 2], grown(DVec3::new(0.3, 0.3, -1e-12))) < 0.0, "{exponent}");
            assert_eq!(scaled.above([0, 1, 2], grown(DVec3::new(0.3, 7.0, 0.0))), 0.0, "{exponent}");
        }
    }
}
