use super::cases;
use crate::predicates::{drop_axis, turn};
use crate::strategies::{exact_isometry, points, shuffled};
use crate::{Hull, HullCertificate, IncrementalHull, PointsError};
use glam::DVec3;
use proptest::prelude::*;

/// Whether two hulls are one set of points, to the last bit: those with a volume hold each other's corners, the others have the same ones.
fn is_same(a: &Hull, of_a: &[DVec3], b: &Hull, of_b: &[DVec3]) -> bool {
    if let (Hull::Solid(a), Hull::Solid(b)) = (a, b) {
        return a.vertices().iter().all(|v| b.contains(*v)) && b.vertices().iter().all(|v| a.contains(*v));
    }
    let places = |hull: &Hull, points: &[DVec3]| {
        // Adding zero makes one value of both zeros.
        let corners =
            hull.corner_points(points).into_iter().map(|p| (p + DVec3::ZERO).to_array().map(f64::to_bits));
        let mut corners: Vec<_> = corners.collect();
        corners.sort_unstable();
        corners
    };
    a.dimension() == b.dimension() && places(a, of_a) == places(b, of_b)
}

fn holds(hull: &Hull, points: &[DVec3]) -> bool {
    hull.solid().is_none_or(|solid| HullCertificate::of(&solid.mesh(), points).is_ok_and(|c| c.holds()))
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn order_and_repetition_of_points_do_not_matter(points in points(1..40), seed in any::<u64>(), again in 0_usize..20) {
        let hull = Hull::of(&points)?;
        let mut others = shuffled(&points, seed);
        others.extend_from_within(..again.min(points.len()));
        let others = shuffled(&others, seed + 1);
        let other = Hull::of(&others)?;
        prop_assert!(holds(&other, &others));
        prop_assert!(is_same(&hull, &points, &other, &others));
    }

    #[test]
    fn turned_points_have_the_turned_hull(points in points(1..40), turn in exact_isometry()) {
        let turned: Vec<DVec3> = points.iter().map(|p| turn * *p).collect();
        let (hull, other) = (Hull::of(&points)?, Hull::of(&turned)?);
        prop_assert!(holds(&other, &turned));
        let back: Vec<DVec3> = other.corner_points(&turned).iter().map(|p| turn.transpose() * *p).collect();
        prop_assert!(is_same(&hull, &points, &Hull::of(&back)?, &back));
    }

    #[test]
    fn grown_points_have_the_grown_hull(points in points(1..40), exponent in -400..400_i32) {
        let factor = 2_f64.powi(exponent);
        let grown: Vec<DVec3> = points.iter().map(|p| *p * factor).collect();
        let (hull, other) = (Hull::of(&points)?, Hull::of(&grown)?);
        let back: Vec<DVec3> = other.corner_points(&grown).iter().map(|p| *p / factor).collect();
        prop_assert!(is_same(&hull, &points, &Hull::of(&back)?, &back));
        prop_assert!(holds(&other, &grown));
    }

    #[test]
    fn the_hull_of_a_hull_is_itself(points in points(1..40)) {
        let hull = Hull::of(&points)?;
        let corners = hull.corner_points(&points);
        prop_assert!(is_same(&hull, &points, &Hull::of(&corners)?, &corners));
    }

    #[test]
    fn a_flat_hull_turns_one_way_at_each_of_its_corners(mut points in points(1..40)) {
        points.iter_mut().for_each(|p| p.z = 0.7);
        let hull = Hull::of(&points)?;
        prop_assert!(hull.dimension() < 3);
        if let Hull::Polygon(corners) = &hull {
            let at = |k: usize| drop_axis(points[corners[k % corners.len()]], 2);
            let turns: Vec<f64> = (0..corners.len()).map(|k| turn(at(k), at(k + 1), at(k + 2))).collect();
            prop_assert!(turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0), "{turns:?}");
        }
    }

    #[test]
    fn a_point_more_never_takes_from_a_hull(points in points(2..40)) {
        let all = Hull::of(&points)?;
        let before = Hull::of(&points[..points.len() - 1])?;
        prop_assert!(before.dimension() <= all.dimension());
        if let Hull::Solid(all) = &all {
            prop_assert!(before.corner_points(&points).iter().all(|p| all.contains(*p)));
        }
    }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn point_by_point_is_all_at_once_at_every_prefix(
        mut points in points(1..24), flat in 0_usize..12, far in 0_usize..3,
    ) {
        // The first ones in a plane; the last ones far beyond what came before, in the planes of its facets but for rounding.
        let height = points[0].z;
        points.iter_mut().take(flat).for_each(|p| p.z = height);
        let (start, along) = (points[0], points[points.len() / 2] - points[0]);
        points.iter_mut().rev().take(far).enumerate().for_each(|(k, p)| *p = start + along * 1e5_f64.powi(1 + k as i32));
        let mut growing = IncrementalHull::new();
        for (k, p) in points.iter().enumerate() {
            growing.insert(*p)?;
            let (hull, all) = (growing.hull()?, Hull::of(&points[..=k])?);
            prop_assert!(holds(&hull, &points[..=k]), "{k}");
            prop_assert!(is_same(&hull, &points, &all, &points), "{k}");
        }
    }

    #[test]
    fn coordinates_are_taken_up_to_their_limit_and_no_further(largest in -700..1000_i32, tall in any::<bool>()) {
        // A simplex with an edge of the largest size and corners that differ by the least.
        let simplex = |range: i32| {
            let (far, near) = (2_f64.powi(largest), 2_f64.powi(largest - range));
            let [x, y, z] = if tall { [near, near, far] } else { [far, far, near] };
            vec![DVec3::ZERO, DVec3::X * x, DVec3::Y * y, DVec3::Z * z, DVec3::new(x, y, z) / 2.0]
        };
        // Of sizes to a factor of two, since half of a corner is a corner.
        let at_limit = simplex(628.min(largest + 1021));
        let hull = Hull::of(&at_limit)?;
        prop_assert_eq!(hull.dimension(), 3);
        prop_assert!(holds(&hull, &at_limit));
        if largest > -390 {
            let beyond = Hull::of(&simplex(631));
            prop_assert!(matches!(beyond, Err(PointsError::DynamicRange { .. })), "{beyond:?}");
        }
    }
}

#[test]
fn one_point_beyond_the_range_is_refused_and_changes_nothing() {
    for (exponent, taken) in [(330, true), (331, false), (-300, true), (-301, false)] {
        let mut growing = IncrementalHull::new();
        growing.insert(DVec3::ONE).unwrap();
        let result = growing.insert(DVec3::new(2_f64.powi(exponent), 1.0, 0.0));
        assert_eq!(result.is_ok(), taken, "{exponent}");
        assert_eq!(growing.points().len(), 1 + usize::from(taken));
        assert!(growing.insert(DVec3::X).is_ok());
    }
}
