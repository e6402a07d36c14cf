//! parry3d as an independent witness: its hull on inputs that it handles, its volumes, its point queries.
#![cfg(feature = "parry")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test panics to fail")]

use exact_hull::{Direction, HalfSpace, Hull, Intersection, SolidHull};
use glam::DVec3;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Shape;

/// Half-spaces that touch an ellipsoid at points well apart from each other: Fibonacci's spiral.
fn tangents(count: u32) -> Vec<HalfSpace> {
    let axes = DVec3::new(2.5, 2.0, 1.0);
    let turn = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let one = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
        let (sin, cos) = (turn * f64::from(k)).sin_cos();
        let n = DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
        let point = axes * axes * n / (axes * n).length();
        HalfSpace { point, normal: Direction::new(n).unwrap(), margin: 0.0 }
    };
    (0..count).map(one).collect()
}

fn points(tangents: &[HalfSpace]) -> Vec<DVec3> {
    tangents.iter().map(|h| h.point).collect()
}

fn solid(hull: &Hull) -> &SolidHull {
    hull.solid().unwrap()
}

#[test]
fn hulls_agree_where_parrys_is_right() {
    for count in [8, 50, 500] {
        let points = points(&tangents(count));
        let ours = Hull::of(&points).unwrap();
        let (vertices, triangles) = parry3d_f64::transformation::try_convex_hull(&points).unwrap();
        let theirs = exact_hull::TriangleMesh { vertices, triangles };
        let (a, b) = (solid(&ours).volume(), theirs.moments().volume);
        assert!((a - b).abs() < 1e-10 * a, "{count}: {a} {b}");
    }
}

#[test]
fn volumes_and_point_queries_agree() {
    let inner = Hull::of(&points(&tangents(200))).unwrap();
    let lower = solid(&inner).mesh();
    let shape = lower.to_parry_convex().unwrap();
    let mass = shape.mass_properties(1.0).mass();
    let volume = solid(&inner).volume();
    assert!((mass - volume).abs() < 1e-9 * mass, "{mass} {volume}");
    let upper = Intersection::of(&tangents(200)).unwrap().bounded().unwrap().mesh();
    let upper_shape = upper.to_parry_convex().unwrap();
    assert!(upper.to_parry().is_ok());
    for tangent in tangents(37) {
        // The hull lies inside of the ellipsoid and the intersection around it.
        assert!(upper_shape.contains_local_point(tangent.point * (1.0 - 1e-9)));
        assert!(!shape.contains_local_point(tangent.point * (1.0 + 1e-9)));
    }
}
