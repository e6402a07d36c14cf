//! parry3d as an independent witness: its hull on inputs that it handles, its volumes, its point queries.
#![cfg(feature = "parry")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test panics to fail")]

use glam::DVec3;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::Shape;
use shape_bounds::{ContactSample, Hull, ShapeBounds, SolidHull};

/// Points on an ellipsoid, well apart from each other: Fibonacci's spiral.
fn contacts(count: u32) -> Vec<ContactSample> {
    let axes = DVec3::new(2.5, 2.0, 1.0);
    let turn = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let one = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
        let (sin, cos) = (turn * f64::from(k)).sin_cos();
        let n = DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
        let scaled = axes * axes * n;
        (scaled / (axes * n).length(), n)
    };
    ContactSample::from_raw((0..count).map(one)).unwrap()
}

fn solid(hull: &Hull) -> &SolidHull {
    hull.solid().unwrap()
}

#[test]
fn hulls_agree_where_parrys_is_right() {
    for count in [8, 50, 500] {
        let points: Vec<DVec3> = contacts(count).iter().map(|c| c.point).collect();
        let ours = Hull::of(&points).unwrap();
        let (vertices, triangles) = parry3d_f64::transformation::try_convex_hull(&points).unwrap();
        let theirs = shape_bounds::TriangleMesh { vertices, triangles };
        let (a, b) = (solid(&ours).volume(), theirs.moments().volume);
        assert!((a - b).abs() < 1e-10 * a, "{count}: {a} {b}");
    }
}

#[test]
fn volumes_and_point_queries_agree() {
    let bounds = ShapeBounds::from_contacts(&contacts(200)).unwrap();
    let lower = solid(bounds.lower()).mesh();
    let shape = lower.to_parry_convex().unwrap();
    let mass = shape.mass_properties(1.0).mass();
    assert!((mass - bounds.lower_volume()).abs() < 1e-9 * mass, "{mass} {}", bounds.lower_volume());
    let upper = bounds.upper().bounded().unwrap().mesh();
    let upper_shape = upper.to_parry_convex().unwrap();
    assert!(upper.to_parry().is_ok());
    for contact in contacts(37) {
        // The lower bound lies inside of the ellipsoid and the upper around it.
        assert!(upper_shape.contains_local_point(contact.point * (1.0 - 1e-9)));
        assert!(!shape.contains_local_point(contact.point * (1.0 + 1e-9)));
    }
}
