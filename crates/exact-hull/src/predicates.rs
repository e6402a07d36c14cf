//! Exact signs of orientation determinants: the one place where geometry is decided.
//!
//! The arithmetic is Shewchuk's adaptive expansion arithmetic ("Adaptive precision floating-point arithmetic and
//! fast robust geometric predicates", 1997), from the `robust` crate. It is exact as long as no intermediate
//! product under- or overflows, which [`crate::ScaledPoints`] sees to.

use glam::{DVec2, DVec3};
use robust::{Coord, Coord3D};

/// Unit roundoff of `f64`, 2^-53.
pub const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

fn coord3(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}

/// Positive when `p` is strictly on the outer side of the plane through `a`, `b`, `c` (which are seen in
/// anticlockwise order from that side), negative when strictly on the inner side, zero when on the plane.
///
/// Only the sign is exact; the size approximates six times the volume of the tetrahedron.
#[inline]
pub fn above(a: DVec3, b: DVec3, c: DVec3, p: DVec3) -> f64 {
    -robust::orient3d(coord3(a), coord3(b), coord3(c), coord3(p))
}

/// Positive when `a`, `b`, `c` turn left, negative when right, zero when they are collinear.
#[inline]
pub fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    robust::orient2d(Coord { x: a.x, y: a.y }, Coord { x: b.x, y: b.y }, Coord { x: c.x, y: c.y })
}

/// `p` without its coordinate `axis`, such that a right-handed turn about `+axis` stays anticlockwise.
#[inline]
pub fn drop_axis(p: DVec3, axis: usize) -> DVec2 {
    match axis {
        0 => DVec2::new(p.y, p.z),
        1 => DVec2::new(p.z, p.x),
        _ => DVec2::new(p.x, p.y),
    }
}

/// The axis along which the triangle `a`, `b`, `c` projects to one of non-zero area, and the sign of that area;
/// `None` when the three points are exactly collinear.
///
/// Of the axes that qualify, the one with the largest area is chosen.
pub fn projection_axis(a: DVec3, b: DVec3, c: DVec3) -> Option<(usize, f64)> {
    (0..3)
        .map(|axis| (axis, turn(drop_axis(a, axis), drop_axis(b, axis), drop_axis(c, axis))))
        .filter(|(_, area)| *area != 0.0)
        .max_by(|x, y| x.1.abs().total_cmp(&y.1.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn above_is_outside_of_an_anticlockwise_triangle() {
        let (a, b, c) = (DVec3::ZERO, DVec3::X, DVec3::Y);
        assert!(above(a, b, c, DVec3::Z) > 0.0);
        assert!(above(a, b, c, -DVec3::Z) < 0.0);
        assert!(above(a, b, c, DVec3::new(0.3, 7.0, 0.0)) == 0.0);
    }

    #[test]
    fn a_displacement_of_one_ulp_is_seen() {
        // Where rounded arithmetic gives noise: a plane through (1, 1, 1)-like points far from the origin.
        let a = DVec3::new(1e8 + 1.0, 1e8, 1e8);
        let b = DVec3::new(1e8, 1e8 + 1.0, 1e8);
        let c = DVec3::new(1e8, 1e8, 1e8 + 1.0);
        let third = DVec3::new(1e8 - 1.0, 1e8 + 1.0, 1e8 + 1.0);
        assert_eq!(above(a, b, c, third), 0.0);
        assert!(above(a, b, c, DVec3::new(third.x.next_up(), third.y, third.z)) > 0.0);
        assert!(above(a, b, c, DVec3::new(third.x.next_down(), third.y, third.z)) < 0.0);
    }

    #[test]
    fn projections_keep_orientation_and_collinearity_is_exact() {
        let (axis, area) = projection_axis(DVec3::ZERO, DVec3::Z, DVec3::X).unwrap();
        assert!(axis == 1 && area > 0.0);
        let d = DVec3::new(0.1, 0.7, -0.3);
        assert!(projection_axis(d, d * 2.0, d * 4.0).is_none());
    }
}
