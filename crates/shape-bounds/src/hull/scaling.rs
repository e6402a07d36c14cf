//! Powers of two that keep the exact predicates exact.

use super::PointsError;
use glam::DVec3;

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
}

/// The power of two by which `points` are multiplied for a predicate; 1 for all ordinary data.
///
/// Multiplying by a power of two is exact, so signs are those of the points as given.
pub(crate) fn exact_scale(points: &[DVec3], range: ExactRange) -> Result<f64, PointsError> {
    let mut largest = 0.0_f64;
    let mut smallest = f64::INFINITY;
    for (index, p) in points.iter().enumerate() {
        if !p.is_finite() {
            return Err(PointsError::NotFinite { index, point: *p });
        }
        let size = p.abs();
        largest = largest.max(size.max_element());
        for c in size.to_array() {
            if c > 0.0 && c < smallest {
                smallest = c;
            }
        }
    }
    if largest == 0.0 || (largest <= power(range.largest) && smallest >= power(range.smallest)) {
        return Ok(1.0);
    }
    // No more than 2^1000, which is still a finite factor for sets of subnormal size.
    let exponent = (range.largest - 1 - exponent_of(largest)).min(1000);
    if exponent_of(smallest) + exponent < range.smallest {
        return Err(PointsError::DynamicRange { smallest, largest });
    }
    Ok(power(exponent))
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
        assert_eq!(exact_scale(&[DVec3::new(1e8, -3e-8, 0.0)], ExactRange::ORIENTATION), Ok(1.0));
        for extreme in [1e-300, 1e-200, 1e200, 1e300] {
            let scale =
                exact_scale(&[DVec3::splat(extreme), DVec3::splat(extreme * 1e-3)], ExactRange::ORIENTATION)
                    .unwrap();
            let scaled = extreme * scale;
            assert!(
                scaled <= power(ExactRange::ORIENTATION.largest)
                    && scaled * 1e-3 >= power(ExactRange::ORIENTATION.smallest),
                "{extreme}"
            );
            assert_eq!(scaled / scale, extreme);
        }
        assert!(matches!(
            exact_scale(&[DVec3::new(1e150, 1e-150, 0.0)], ExactRange::ORIENTATION),
            Err(PointsError::DynamicRange { .. })
        ));
    }
}
