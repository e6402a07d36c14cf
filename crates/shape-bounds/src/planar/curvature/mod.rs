//! Bounds tightened by limits on the radius of curvature, and by palms that are arcs.
//!
//! Where no radius of curvature is below `rho_min`, a disc of that radius rolls freely inside of the outline; where none is
//! above `rho_max`, the body rolls freely inside of a disc of that radius (Blaschke). A concave circular palm that touches
//! the body is such a disc without any limit on curvature.

mod discs;
mod envelope;
mod error;
mod interior;
mod rounded;

pub use discs::{Disc, DiscIntersection, Side};
pub use error::CurvatureError;
pub use rounded::RoundedHull;

use super::ContactSample;
use super::distance::nearest_around;
use contact_kinematics::planar::RadiusBounds;
use exact_hull::planar::Direction;
#[cfg(test)]
use exact_hull::planar::HalfPlane;
use exact_hull::planar::Ring;
use glam::DVec2;

/// Smallest turning between points of an outline that is drawn, in rad.
const FINEST: f64 = 1e-3;
/// By how much contacts may contradict the limits before it is an error, relative to their size: rounding.
const ROUNDING: f64 = 1e-12;

/// Lower and upper bound of a convex outline whose radius of curvature is limited.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureBounds {
    lower: RoundedHull,
    upper: DiscIntersection,
}

impl CurvatureBounds {
    /// Bounds from contacts without noise on a body whose radius of curvature lies within `radii`.
    ///
    /// # Errors
    /// [`CurvatureError`] for limits that are not `0 <= min <= max < infinity`, values that are not finite, and contacts
    /// that contradict the limits (a pair of which the one lies outside of the other's outer disc, or in whose plane the
    /// other's inner disc does not fit, is named).
    pub fn from_contacts(contacts: &[ContactSample], radii: RadiusBounds) -> Result<Self, CurvatureError> {
        if !(0.0 <= radii.min && radii.min <= radii.max && radii.max.is_finite()) {
            return Err(CurvatureError::Radii { min: radii.min, max: radii.max });
        }
        let centre = |c: &ContactSample, r: f64| c.point - c.normal.get() * r;
        let inner: Vec<DVec2> = contacts.iter().map(|c| centre(c, radii.min)).collect();
        let lower = RoundedHull::of(&inner, radii.min)?;
        let size = contacts.iter().map(|c| c.point.abs().max_element()).fold(radii.max, f64::max);
        let rounding = ROUNDING * size;
        check_round(contacts, radii.min, &lower, rounding)?;
        let outer: Vec<Disc> =
            contacts.iter().map(|c| Disc { centre: centre(c, radii.max), radius: radii.max }).collect();
        let upper = DiscIntersection::of(&outer, &[]).map_err(|error| too_flat(contacts, &outer, error))?;
        let excess = contacts.iter().enumerate().map(|(sample, c)| (sample, upper.excess(c.point)));
        match excess.max_by(|a, b| a.1.0.total_cmp(&b.1.0)) {
            Some((sample, (excess, other))) if excess > rounding => {
                Err(CurvatureError::TooFlat { sample, other, excess, radius: radii.max })
            }
            _ => Ok(Self { lower, upper }),
        }
    }

    /// The hull of the inner discs: in the body.
    #[must_use]
    pub fn lower(&self) -> &RoundedHull {
        &self.lower
    }

    /// The intersection of the outer discs: around the body.
    #[must_use]
    pub fn upper(&self) -> &DiscIntersection {
        &self.upper
    }

    /// How far the upper bound stands out of the lower one at most, m: their Hausdorff distance, or more than that by no more than arcs of a thousandth of a turn rise
    /// above their chords.
    #[must_use]
    pub fn largest_gap(&self) -> f64 {
        let outer = self.upper.outline(FINEST);
        let nearest = nearest_around(self.lower.corners(), &outer);
        let gaps = outer.iter().zip(nearest).map(|(outer, core)| outer.distance(core) - self.lower.radius());
        gaps.fold(0.0, f64::max)
    }

    /// Support functions `(lower, upper)` in direction `n`, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> (f64, f64) {
        (self.lower.support(n), self.upper.support(n))
    }
}

/// Whether every inner disc is within every half-plane; the pair that is the furthest from it.
fn check_round(
    contacts: &[ContactSample],
    radius: f64,
    lower: &RoundedHull,
    rounding: f64,
) -> Result<(), CurvatureError> {
    let (ring, sources) = (Ring::new(lower.corners()), lower.core().corners());
    let farthest = contacts.iter().enumerate().map(|(sample, c)| {
        let corner = ring.farthest(c.normal.get());
        (sample, sources[corner], c.normal.get().dot(lower.corners()[corner] - c.point) + radius)
    });
    match farthest.max_by(|a, b| a.2.total_cmp(&b.2)) {
        Some((sample, other, excess)) if excess > rounding => {
            Err(CurvatureError::TooRound { sample, other, excess, radius })
        }
        _ => Ok(()),
    }
}

/// Of outer discs that have nothing in common, one with the contact that is the furthest outside of it: contacts inside of all
/// would be in common.
fn too_flat(contacts: &[ContactSample], outer: &[Disc], error: CurvatureError) -> CurvatureError {
    let CurvatureError::Empty { conflict, .. } = &error else { return error };
    let beyond = |sample: usize, other: usize| {
        contacts[sample].point.distance(outer[other].centre) - outer[other].radius
    };
    let pairs = conflict.iter().flat_map(|other| (0..contacts.len()).map(|sample| (sample, *other)));
    match pairs.max_by(|a, b| beyond(a.0, a.1).total_cmp(&beyond(b.0, b.1))) {
        Some((sample, other)) => {
            let (excess, radius) = (beyond(sample, other), outer[other].radius);
            CurvatureError::TooFlat { sample, other, excess, radius }
        }
        None => error,
    }
}

/// Unit vectors from the angle `from` over `angle` (rad), both ends included, evenly and at most `step` apart.
fn arc(from: f64, angle: f64, step: f64) -> impl Iterator<Item = DVec2> {
    let parts = (angle / step.max(FINEST)).ceil().max(1.0) as u32;
    (0..=parts).map(move |k| DVec2::from_angle(from + angle * f64::from(k) / f64::from(parts)))
}

/// Where tangents at the places of [`arc`] meet, from the centre of a circle of radius 1.
fn around_arc(from: f64, angle: f64, step: f64) -> impl Iterator<Item = DVec2> {
    // Tangents half a turn apart do not meet.
    let parts = (angle / step.clamp(FINEST, 1.0)).ceil().max(1.0);
    let half = 0.5 * angle / parts;
    (0..parts as u32).map(move |k| DVec2::from_angle(from + half * f64::from(2 * k + 1)) / half.cos())
}

#[cfg(test)]
mod tests {
    use super::*;
    use exact_hull::planar::ConvexPolygon;

    /// Area of a drawn outline; its error falls with the square of the step.
    fn drawn(points: Vec<DVec2>) -> f64 {
        ConvexPolygon::new(points).area()
    }

    #[test]
    fn outlines_run_once_round_and_are_as_large_as_their_bounds() {
        let step = 1e-2;
        let turn = |k: u32| DVec2::from_angle(f64::from(k));
        let centres: Vec<DVec2> = (0..7).map(|k| turn(k) * DVec2::new(2.0, 1.0)).collect();
        for count in [1, 2, 3, 7] {
            let hull = RoundedHull::of(&centres[..count], 0.5).unwrap();
            let area = drawn(hull.outline(step));
            assert!((0.0..step * step).contains(&(hull.area() - area)), "{count}: {area} {}", hull.area());
        }
        let discs: Vec<Disc> = (0..7).map(|k| Disc { centre: turn(k) * 0.4, radius: 1.5 }).collect();
        let cut = HalfPlane { point: DVec2::X * 0.7, normal: Direction::from_angle(0.1), margin: 0.0 };
        for planes in [&[][..], &[cut]] {
            let bound = DiscIntersection::of(&discs, planes).unwrap();
            let around = bound.outline(step);
            // Outside, or on it but for rounding.
            let most = around.iter().map(|p| bound.excess(*p).0).fold(f64::INFINITY, f64::min);
            assert!(most > -1e-14, "{most:e}");
            let area = drawn(around);
            assert!((0.0..step * step).contains(&(area - bound.area())), "{area} {}", bound.area());
        }
    }

    /// Against the support functions in many directions: no less than these, and hardly more.
    #[test]
    fn the_largest_gap_is_not_below_that_of_any_direction() {
        for (flat, count) in [(1.0, 5), (0.2, 40), (0.02, 60)] {
            let contact = |k: i32| {
                let normal = Direction::from_angle(f64::from(k) * 2.4);
                let n = normal.get();
                let axes = DVec2::new(1.0, flat);
                ContactSample { point: axes * axes * n / (axes * n).length(), normal }
            };
            let contacts: Vec<ContactSample> = (0..count).map(contact).collect();
            let radii = RadiusBounds { min: 0.5 * flat * flat, max: 2.0 / flat };
            let bounds = CurvatureBounds::from_contacts(&contacts, radii).unwrap();
            let of = |k: u32| {
                let (lower, upper) = bounds.support(Direction::from_angle(f64::from(k) * 1e-4));
                upper - lower
            };
            let largest = (0..62832).map(of).fold(0.0, f64::max);
            let told = bounds.largest_gap();
            assert!(largest - 1e-12 <= told && told <= 1.001 * largest + 1e-6, "{flat}: {told} {largest}");
        }
    }

    #[test]
    fn a_disc_whose_radius_is_both_limits_is_its_own_bounds() {
        for (radius, count, offset) in [(1.0, 7, 0.0), (0.037, 1000, 1e3), (123.4, 5000, 1e3)] {
            let contact = |k: i32| {
                let normal = Direction::from_angle(f64::from(k) * 2.4);
                ContactSample { point: normal.get() * radius + DVec2::X * offset, normal }
            };
            let contacts: Vec<ContactSample> = (0..count).map(contact).collect();
            let bounds =
                CurvatureBounds::from_contacts(&contacts, RadiusBounds { min: radius, max: radius }).unwrap();
            let area = std::f64::consts::PI * radius * radius;
            // Points are rounded to a unit of their largest coordinate.
            let rounding = 8.0 * f64::EPSILON * (offset + radius) * radius;
            for found in [bounds.lower().area(), bounds.upper().area()] {
                assert!((found - area).abs() <= rounding, "{radius}: {found} {area}");
            }
        }
    }
}
