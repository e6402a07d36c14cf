use super::ellipsoid::outer;
use super::{CurvatureRadii, ShapeError, SupportFunction, SupportJet};
use crate::Direction;
use glam::{DMat3, DVec3};

/// Most corners that are taken: all triples of them are looked at for sides.
const MOST_CORNERS: usize = 48;
/// Corners this near to a plane, as a share of the size, lie on it.
const ON_PLANE: f64 = 1e-9;

/// A convex polytope whose edges and corners have a radius, and whose sides bulge by next to nothing: smooth, and as close to
/// the polytope as is wanted.
///
/// `h(u) = (sum max(0, u . v_i)^p)^(1/p) + r |u|` over the corners `v_i`: Firey's `p`-sum (1962) of the segments from the
/// origin, plus a ball. It is convex, lies around the polytope, and reaches beyond it by the factor `m^(1/p)` at most where `m` corners
/// share a side. Over a turn of about `1/p` rad the contact crosses a side; elsewhere it stays within a corner's ball. The
/// polytope itself is the limit `p -> inf, r -> 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedPolytope {
    corners: Vec<DVec3>,
    rounding: f64,
    sharpness: f64,
    radii: CurvatureRadii,
}

impl RoundedPolytope {
    /// From corners (m, body axes; the origin must be inside), the radius of the rounding (m) and the power `p`, at least 2.
    ///
    /// # Errors
    /// [`ShapeError`] for corners that are not finite or too many, corners that do not enclose the origin, and lengths that are none.
    pub fn new(corners: Vec<DVec3>, rounding: f64, sharpness: f64) -> Result<Self, ShapeError> {
        if !(rounding >= 0.0 && rounding.is_finite()) {
            return Err(ShapeError::Length { what: "rounding", value: rounding });
        }
        if !(2.0..=1e6).contains(&sharpness) {
            return Err(ShapeError::Sharpness { value: sharpness });
        }
        for (index, corner) in corners.iter().enumerate() {
            if let Some(value) = corner.to_array().into_iter().find(|x| !x.is_finite()) {
                return Err(ShapeError::Coefficient { index, value });
            }
        }
        if corners.len() > MOST_CORNERS {
            return Err(ShapeError::CornerCount { found: corners.len(), limit: MOST_CORNERS });
        }
        let inside = inscribed(&corners);
        if inside <= 0.0 {
            return Err(ShapeError::OriginOutside { corners: corners.len() });
        }
        // The Hessian is (p - 1) / h times a covariance of weights (x_i / h)^(p - 2) at most, of which none is above 1.
        let spread: f64 = corners.iter().map(|v| v.length_squared()).sum();
        let radii = CurvatureRadii { min: rounding, max: rounding + (sharpness - 1.0) * spread / inside };
        Ok(Self { corners, rounding, sharpness, radii })
    }

    /// A box about the origin with these half edges, m.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn cuboid(half_edges: DVec3, rounding: f64, sharpness: f64) -> Result<Self, ShapeError> {
        let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
        let corner = |k: u32| half_edges * DVec3::new(sign(k & 1), sign(k & 2), sign(k & 4));
        Self::new((0..8).map(corner).collect(), rounding, sharpness)
    }

    /// Corners of the polytope without its rounding, body axes, m.
    #[must_use]
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// Radius of the ball that is added, m.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        self.rounding
    }
}

impl SupportFunction for RoundedPolytope {
    fn jet(&self, n: Direction) -> SupportJet {
        let (n, p) = (n.get(), self.sharpness);
        let largest = self.corners.iter().map(|v| n.dot(*v)).fold(0.0, f64::max);
        // Powers of heights over the largest one, which is positive as the origin is inside.
        let weight = |v: &DVec3| (n.dot(*v).max(0.0) / largest).powf(p);
        let sum: f64 = self.corners.iter().map(weight).sum();
        let value = largest * sum.powf(1.0 / p);
        let (mut point, mut square) = (DVec3::ZERO, DMat3::ZERO);
        for v in &self.corners {
            let share = weight(v) / sum;
            if share > 0.0 {
                let scaled = *v * (value / n.dot(*v));
                point += share * scaled;
                square += outer(scaled, scaled) * share;
            }
        }
        let across = DMat3::IDENTITY - outer(n, n);
        SupportJet {
            value: value + self.rounding,
            point: point + self.rounding * n,
            hessian: (square - outer(point, point)) * ((p - 1.0) / value) + across * self.rounding,
        }
    }

    fn curvature_radii(&self) -> CurvatureRadii {
        self.radii
    }
}

/// Distance of the nearest side from the origin, m; zero or less where the origin is not inside of a solid.
fn inscribed(corners: &[DVec3]) -> f64 {
    let size = corners.iter().map(|v| v.length()).fold(0.0, f64::max);
    let mut nearest = f64::INFINITY;
    for (i, a) in corners.iter().enumerate() {
        for (j, b) in corners.iter().enumerate().skip(i + 1) {
            for c in &corners[j + 1..] {
                let Ok(n) = Direction::new((*b - *a).cross(*c - *a)) else { continue };
                let heights = || corners.iter().map(|v| n.get().dot(*v - *a));
                let slack = ON_PLANE * size;
                if heights().all(|h| h <= slack) {
                    nearest = nearest.min(n.get().dot(*a));
                }
                if heights().all(|h| h >= -slack) {
                    nearest = nearest.min(-n.get().dot(*a));
                }
            }
        }
    }
    // Without any side there is no solid.
    if nearest.is_finite() && nearest > ON_PLANE * size { nearest } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(rounding: f64, sharpness: f64) -> RoundedPolytope {
        RoundedPolytope::cuboid(DVec3::ONE, rounding, sharpness).unwrap()
    }

    #[test]
    fn it_lies_around_the_polytope_by_what_is_said() {
        for p in [20.0, 300.0, 1e5] {
            let body = cube(0.0, p);
            let over = body.value(Direction::Z) - 1.0;
            // Four corners share a side.
            assert!((over - (4.0_f64.powf(1.0 / p) - 1.0)).abs() < 1e-12, "{p}: {over}");
            let n = Direction::new(DVec3::new(1.0, 0.7, 0.4)).unwrap();
            assert!((body.point(n) - DVec3::ONE).length() < 2.0 * 0.4_f64.powf(0.1 * p.min(200.0)), "{p}");
        }
    }

    #[test]
    fn a_contact_stays_at_a_corner_and_crosses_a_side() {
        let body = cube(0.0, 1e4);
        let at = |x: f64, y: f64| body.point(Direction::new(DVec3::new(x, y, 1.0)).unwrap());
        assert!((at(0.2, 0.3) - at(0.6, 0.1)).length() < 1e-12);
        assert!((at(2e-3, 0.3) - at(-2e-3, 0.3)).length() > 1.99);
    }

    #[test]
    fn what_is_no_solid_about_the_origin_is_named() {
        let of = |corners: &[DVec3]| RoundedPolytope::new(corners.to_vec(), 0.1, 50.0);
        let flat = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y];
        assert_eq!(of(&flat), Err(ShapeError::OriginOutside { corners: 4 }));
        let aside: Vec<DVec3> = cube(0.1, 50.0).corners().iter().map(|v| *v + 2.0 * DVec3::X).collect();
        assert_eq!(of(&aside), Err(ShapeError::OriginOutside { corners: 8 }));
        assert!(matches!(of(&[DVec3::NAN; 4]), Err(ShapeError::Coefficient { index: 0, .. })));
        assert!(matches!(of(&[DVec3::X; 60]), Err(ShapeError::CornerCount { found: 60, .. })));
        assert!(matches!(RoundedPolytope::cuboid(DVec3::ONE, -1.0, 50.0), Err(ShapeError::Length { .. })));
        assert!(matches!(RoundedPolytope::cuboid(DVec3::ONE, 0.1, 1.0), Err(ShapeError::Sharpness { .. })));
    }
}
