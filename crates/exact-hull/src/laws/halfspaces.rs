use super::cases;
use crate::generators::Source;
use crate::strategies::{exact_isometry, shuffled, tangents};
use crate::{Direction, HalfSpace, Hull, IncrementalIntersection, Intersection, Polyhedron};
use glam::DVec3;
use proptest::prelude::*;

/// Two computations of one support value or volume of a body of the tests' size, 2.5 m, as different roundings leave it: planes are moved out by 8
/// units of rounding of it in each, or 16 by the incremental form, and a volume changes by its area, below 25 m^2, times that.
const ROUNDED: f64 = 25.0 * 3.0 * 16.0 * 2.5 * f64::EPSILON;

fn bounded(half_spaces: &[HalfSpace]) -> Option<Polyhedron> {
    match Intersection::of(half_spaces) {
        Ok(Intersection::Bounded(polyhedron)) => Some(polyhedron),
        _ => None,
    }
}

/// Bodies that reach no farther than ten times the ellipsoid that they touch: corners far away are rounded at their own size.
fn compact(half_spaces: &[HalfSpace]) -> Option<Polyhedron> {
    bounded(half_spaces).filter(|body| body.vertices().iter().all(|v| v.length() < 25.0))
}

/// Whether two bodies are one, but for rounding at the size of their farthest corner.
fn is_same(a: &Polyhedron, b: &Polyhedron) -> bool {
    let size = a.vertices().iter().map(|v| v.length() / 2.5).fold(1.0, f64::max);
    let within = |inner: &Polyhedron, outer: &Polyhedron| {
        inner.vertices().iter().all(|v| outer.excess(*v) <= ROUNDED * size)
    };
    within(a, b) && within(b, a) && (a.volume() - b.volume()).abs() <= ROUNDED * size.powi(3)
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn order_repetition_and_turns_of_planes_do_not_matter(spaces in tangents(8..40), turn in exact_isometry(), seed in any::<u64>()) {
        let Some(body) = compact(&spaces) else { return Ok(()) };
        let mut others = shuffled(&spaces, seed);
        others.extend_from_within(..3);
        let moved = |h: &HalfSpace| HalfSpace {
            point: turn * h.point,
            normal: Direction::new_unchecked(turn * h.normal.get()),
            margin: h.margin,
        };
        let others: Vec<HalfSpace> = others.iter().map(moved).collect();
        let other = bounded(&others);
        prop_assert!(other.is_some());
        let back = other.map(|body| body.vertices().iter().map(|v| turn.transpose() * *v).collect::<Vec<_>>());
        let size = body.vertices().iter().map(|v| v.length() / 2.5).fold(1.0, f64::max);
        for v in back.unwrap_or_default() {
            prop_assert!(body.excess(v) <= ROUNDED * size, "{}", body.excess(v));
        }
    }

    #[test]
    fn grown_planes_have_the_grown_body_to_the_last_bit(spaces in tangents(8..40), exponent in -60..60_i32) {
        let Some(body) = bounded(&spaces) else { return Ok(()) };
        let factor = 2_f64.powi(exponent);
        let grown: Vec<HalfSpace> = spaces.iter().map(|h| HalfSpace { point: h.point * factor, ..*h }).collect();
        let Some(grown) = bounded(&grown) else { return Err(TestCaseError::fail("open or refused")) };
        prop_assert_eq!(grown.volume(), body.volume() * factor.powi(3));
        prop_assert!(grown.vertices().iter().zip(body.vertices()).all(|(a, b)| *a == *b * factor));
    }

    #[test]
    fn a_plane_more_never_widens(spaces in tangents(8..40)) {
        let (Some(before), Some(all)) = (compact(&spaces[..spaces.len() - 1]), compact(&spaces)) else { return Ok(()) };
        prop_assert!(all.volume() <= before.volume() + ROUNDED * 1e3);
        prop_assert!(all.vertices().iter().all(|v| before.excess(*v) <= 10.0 * ROUNDED));
    }

    #[test]
    fn what_touches_the_planes_is_inside_exactly(spaces in tangents(8..60)) {
        let Some(body) = bounded(&spaces) else { return Ok(()) };
        // Not by rounded distances from planes, but by exact signs against the rounded corners.
        let Hull::Solid(hull) = Hull::of(body.vertices())? else { return Err(TestCaseError::fail("flat")) };
        prop_assert!(spaces.iter().all(|h| hull.contains(h.point)));
    }

    #[test]
    fn the_polar_of_the_polar_is_the_body(seed in any::<u64>(), count in 20..60_usize) {
        let mut s = Source::new(seed);
        let points: Vec<DVec3> = (0..count).map(|_| s.direction() * s.between(0.6, 1.0)).collect();
        let Hull::Solid(hull) = Hull::of(&points)? else { return Ok(()) };
        // The origin is so deep inside that neither duality magnifies rounding by more than 25.
        if hull.excess(DVec3::ZERO) > -0.2 {
            return Ok(());
        }
        let Some(polar) = polar_of(hull.vertices()) else { return Err(TestCaseError::fail("the polar is open")) };
        let Some(back) = polar_of(polar.vertices()) else { return Err(TestCaseError::fail("its polar is open")) };
        // 8 units of rounding of at most 5 m, twice, times 25.
        let tolerance = 2.0 * 25.0 * 8.0 * 5.0 * f64::EPSILON;
        prop_assert!(points.iter().all(|p| back.excess(*p) <= tolerance));
        for v in back.vertices() {
            prop_assert!(hull.excess(*v) <= tolerance, "{}", hull.excess(*v));
        }
    }
}

/// The body `{ y : v . y <= 1 }` of all `v`.
fn polar_of(vertices: &[DVec3]) -> Option<Polyhedron> {
    let plane = |v: &DVec3| {
        let normal = Direction::new(*v).ok()?;
        Some(HalfSpace { point: *v / v.length_squared(), normal, margin: 0.0 })
    };
    bounded(&vertices.iter().filter_map(plane).collect::<Vec<_>>())
}

proptest! {
    #![proptest_config(cases(12))]

    #[test]
    fn plane_by_plane_is_all_at_once_at_every_prefix(spaces in tangents(4..32)) {
        let mut growing = IncrementalIntersection::new();
        for (k, h) in spaces.iter().enumerate() {
            growing.insert(*h)?;
            let (one, all) = (growing.intersection()?, Intersection::of(&spaces[..=k])?);
            prop_assert_eq!(one.bounded().is_some(), all.bounded().is_some(), "{}", k);
            if let (Intersection::Bounded(one), Intersection::Bounded(all)) = (one, all)
                && all.vertices().iter().all(|v| v.length() < 25.0)
            {
                prop_assert!(is_same(&one, &all), "{}: {} {}", k, one.volume(), all.volume());
            }
        }
    }
}
