//! Polytopes around and inside of a convex body that is known by its support points: meshes of stated tolerance, and a
//! volume between certified limits.

use crate::bounds::{BoundsError, ShapeBounds};
use crate::sample::HalfSpace;
use contact_kinematics::Direction;
use glam::DVec3;
use thiserror::Error;

/// Support points at most: meshes of some hundred thousand triangles.
const MOST: usize = 50_000;
/// Rounding of a support point, in units of rounding of the largest coordinate: what the planes are moved out by.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// New directions closer than this share of a radian to another of the same round are left out.
const CLOSE: f64 = 0.3;

/// Why a body has no enclosure.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EnclosureError {
    /// A tolerance that is none.
    #[error("tolerance {0} m: it must be above zero and finite")]
    Tolerance(f64),
    /// The tolerance takes too many support points.
    #[error(
        "a tolerance of {tolerance} m takes more than {points} support points; with these it is {reached:e} m"
    )]
    TooFine {
        /// As asked for, m.
        tolerance: f64,
        /// As reached, m.
        reached: f64,
        /// Support points that were used.
        points: usize,
    },
    /// The support points have no bounds.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
}

/// The hull of support points of a convex body and the intersection of its half-spaces there, no further than `tolerance` (m)
/// from each other: the lower bound is inside of the body, the upper one around it, both to within the tolerance.
///
/// `support` gives the body's farthest point along a direction. Directions are added where the gap is largest, so that
/// flat parts take few.
pub(crate) fn enclose(
    tolerance: f64,
    mut support: impl FnMut(Direction) -> DVec3,
) -> Result<ShapeBounds, EnclosureError> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(EnclosureError::Tolerance(tolerance));
    }
    let mut directions = first_directions();
    let (mut points, mut half_spaces) = (Vec::new(), Vec::new());
    loop {
        for normal in directions.drain(..) {
            let point = support(normal);
            points.push(point);
            half_spaces.push(HalfSpace { point, normal, margin: ROUNDING * point.abs().max_element() });
        }
        let bounds = ShapeBounds::from_parts(&points, &half_spaces)?;
        let mut gaps = bounds.gaps();
        gaps.retain(|gap| gap.distance > tolerance);
        gaps.sort_unstable_by(|a, b| b.distance.total_cmp(&a.distance));
        let Some(worst) = gaps.first() else { return Ok(bounds) };
        if points.len() >= MOST {
            return Err(EnclosureError::TooFine { tolerance, reached: worst.distance, points: points.len() });
        }
        // Corners of the outer polytope lie by threes around what is missing; one direction serves all near it.
        let spacing = CLOSE * (worst.distance / size(&points)).sqrt();
        let mut taken = Spaced::new(spacing);
        directions.extend(gaps.iter().map(|gap| gap.direction).filter(|d| taken.take(d.get())));
        directions.truncate(MOST - points.len());
    }
}

fn size(points: &[DVec3]) -> f64 {
    points.iter().map(|p| p.distance(points[0])).fold(f64::MIN_POSITIVE, f64::max)
}

/// Normals of the faces, corners and edges of a cube.
fn first_directions() -> Vec<Direction> {
    let mut directions = Vec::new();
    for x in -1..=1 {
        for y in -1..=1 {
            for z in -1..=1 {
                directions.extend(Direction::new(DVec3::new(f64::from(x), f64::from(y), f64::from(z))));
            }
        }
    }
    directions
}

/// Unit vectors no closer to each other than a distance, found by cells of a grid.
struct Spaced {
    spacing: f64,
    cells: std::collections::HashSet<[i64; 3]>,
}

impl Spaced {
    fn new(spacing: f64) -> Self {
        Self { spacing, cells: std::collections::HashSet::new() }
    }

    fn take(&mut self, d: DVec3) -> bool {
        let cell = (d / self.spacing).to_array().map(|x| x.round() as i64);
        self.cells.insert(cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curvature::{CurvatureBounds, SharpBounds};
    use crate::generators::{AXES, curve_contacts, ellipsoid_support};
    use contact_kinematics::CurvatureRadii;

    fn ellipsoid_point(n: Direction) -> DVec3 {
        AXES * AXES * n.get() / ellipsoid_support(n.get())
    }

    #[test]
    fn an_ellipsoid_lies_between_its_polytopes_within_the_tolerance() {
        let volume = 4.0 / 3.0 * std::f64::consts::PI * AXES.element_product();
        let mut errors = Vec::new();
        for tolerance in [0.1, 0.01, 0.001] {
            let made = enclose(tolerance, ellipsoid_point).unwrap();
            assert!(made.largest_gap().unwrap().distance <= tolerance);
            assert!(made.lower_volume() < volume && volume < made.upper_volume());
            errors.push((
                made.upper_volume() - made.lower_volume(),
                made.upper().bounded().unwrap().face_count(),
            ));
        }
        // Polytopes of n facets approximate a smooth body to O(1 / n).
        for pair in errors.windows(2) {
            let (gain, cost) = (pair[0].0 / pair[1].0, pair[1].1 as f64 / pair[0].1 as f64);
            assert!(gain > 0.5 * cost, "{errors:?}");
        }
    }

    #[test]
    fn curved_bounds_have_volumes_between_those_of_their_meshes() {
        let radii = CurvatureRadii { min: 0.38, max: 6.5 };
        let contacts = curve_contacts(60, 1);
        let plain = CurvatureBounds::from_contacts(&contacts, radii).unwrap();
        let sharp = SharpBounds::from_contacts(&contacts, radii).unwrap();
        let tolerance = 0.05;
        for (name, made, volume) in [
            ("(d)", plain.lower().enclosure(tolerance), plain.lower().volume()),
            ("(c)", plain.upper().enclosure(tolerance), plain.upper().volume()),
            ("sharp lower", sharp.lower().enclosure(tolerance), sharp.lower().volume()),
            ("sharp upper", sharp.upper().enclosure(tolerance), sharp.upper().volume()),
        ] {
            let made = made.unwrap();
            assert!(made.largest_gap().unwrap().distance <= tolerance);
            let (lower, upper) = (made.lower_volume(), made.upper_volume());
            assert!(lower <= volume && volume <= upper, "{name}: {lower} {volume} {upper}");
            // The largest of them has an area of 46 m^2.
            assert!(upper - lower < tolerance * 46.0, "{name}: {lower} {upper}");
        }
    }

    #[test]
    fn impossible_tolerances_are_refused() {
        for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(enclose(tolerance, ellipsoid_point), Err(EnclosureError::Tolerance(_))));
        }
    }
}
