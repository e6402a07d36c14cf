//! Concave bodies: volumes that converge, bounds of the hull, order of the interpolant.

use super::*;
use crate::bounds::ShapeBounds;
use crate::generators::{AXES, InputKind, Source, ellipsoid_contacts};
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use exact_hull::PointsError;
use exact_hull::delaunay::DelaunayError;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Contacts on a torus about z: radius of the circle `large`, of the tube `small`.
fn torus(count: usize, large: f64, small: f64, s: &mut Source) -> Vec<ContactSample> {
    (0..count)
        .map(|_| {
            let (around, across) = (s.between(0.0, TAU), s.between(0.0, TAU));
            let radial = DVec3::new(around.cos(), around.sin(), 0.0);
            let n = radial * across.cos() + DVec3::Z * across.sin();
            ContactSample { point: radial * large + n * small, normal: Direction::new(n).unwrap() }
        })
        .collect()
}

#[test]
fn the_alpha_shape_of_a_torus_has_its_hole_and_its_volume() {
    let mut s = Source::new(2);
    let truth = 2.0 * PI * PI * 0.09;
    let points: Vec<DVec3> = torus(3000, 1.0, 0.3, &mut s).iter().map(|c| c.point).collect();
    let shape = AlphaShape::of(&points).unwrap();
    // Spheres inside of the tube have its radius; those in the hole are larger than 0.35.
    let volume = shape.volume(0.34).unwrap();
    assert!((volume / truth - 1.0).abs() < 0.05, "{}", volume / truth);
    assert!(shape.volume(f64::INFINITY).unwrap() > 1.6 * truth);
    assert!(!shape.contains(0.34, DVec3::ZERO).unwrap() && shape.contains(0.34, DVec3::X).unwrap());
    assert!(shape.connecting_radius() < 0.34);
    // The mesh bounds the same volume.
    let mesh = shape.mesh(0.34).unwrap();
    let signed = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.vertices[i as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    assert!((mesh.triangles.iter().map(signed).sum::<f64>() - volume).abs() < 1e-12);
}

#[test]
fn half_spaces_of_a_torus_are_used_on_its_hull_only() {
    let mut s = Source::new(3);
    let contacts = torus(2000, 1.0, 0.3, &mut s);
    let (bounds, kept) = ShapeBounds::from_concave_contacts(&contacts).unwrap();
    assert!(!kept.is_empty() && kept.len() < contacts.len());
    // No contact of the inner half is on the hull. Of the outer half, some have a chord of the sample beyond them.
    for i in &kept {
        let p = contacts[*i].point;
        assert!(p.x.hypot(p.y) > 0.99, "{p}");
    }
    // h = 1 * sin(polar) + 0.3.
    for _ in 0..200 {
        let n = Direction::new(s.direction()).unwrap();
        let truth = n.get().truncate().length() + 0.3;
        let (lower, upper) = bounds.support(n);
        assert!(lower <= truth + 1e-12 && truth <= upper + 1e-12, "{lower} {truth} {upper}");
    }
    // All half-spaces together contradict each other.
    assert!(ShapeBounds::from_contacts(&contacts).is_err());
}

#[test]
fn on_convex_bodies_every_contact_is_kept() {
    let contacts = ellipsoid_contacts(300, 4);
    let (bounds, kept) = ShapeBounds::from_concave_contacts(&contacts).unwrap();
    assert_eq!(kept.len(), 300);
    assert_eq!(bounds, ShapeBounds::from_contacts(&contacts).unwrap());
}

/// Root mean square error of the surface along rays from the centre of the ellipsoid 2.5, 2, 1.
fn surface_error(contacts: &[ContactSample]) -> f64 {
    let surface = HermiteSurface::through(contacts).unwrap();
    let mut s = Source::new(7);
    let square: f64 = (0..60)
        .map(|_| {
            let d = s.direction();
            let truth = 1.0 / (d / AXES).length();
            (surface.along_ray(DVec3::ZERO, d, 4.0).unwrap() - truth).powi(2)
        })
        .sum();
    (square / 60.0).sqrt()
}

/// Contacts of the ellipsoid whose normals are spread evenly.
fn even(count: usize) -> Vec<ContactSample> {
    (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
            let (sin, cos) = (PI * (3.0 - 5f64.sqrt()) * i as f64).sin_cos();
            let across = (1.0 - z * z).sqrt();
            // Of the unit sphere, stretched.
            let p = DVec3::new(across * cos, across * sin, z);
            ContactSample { point: p * AXES, normal: Direction::new(p / AXES).unwrap() }
        })
        .collect()
}

#[test]
fn the_surface_interpolates_and_converges() {
    let contacts = even(40);
    let surface = HermiteSurface::through(&contacts).unwrap();
    for c in &contacts {
        let (value, gradient) = surface.value(c.point);
        assert!(value.abs() < 1e-11 && (gradient - c.normal.get()).length() < 1e-10);
    }
    // The gradient is the derivative of the value.
    let at = DVec3::new(1.0, 0.7, -0.4);
    for axis in DVec3::AXES {
        let slope = (surface.value(at + axis * 1e-5).0 - surface.value(at - axis * 1e-5).0) / 2e-5;
        assert!((slope - surface.value(at).1.dot(axis)).abs() < 1e-7);
    }
    // Spacing falls with the root of the number: half of it for four times as many.
    let (coarse, fine) = (surface_error(&even(40)), surface_error(&even(160)));
    let order = (coarse / fine).log2();
    assert!(order > 3.0, "{order}: {coarse} {fine}");
}

#[test]
fn bad_input_is_named() {
    let point = |i: usize| DVec3::new(i as f64, (i * i) as f64, 0.5);
    let flat: Vec<DVec3> = (0..8).map(point).collect();
    assert!(matches!(AlphaShape::of(&flat), Err(AlphaError::Points(DelaunayError::Flat { dimension: 2 }))));
    assert!(matches!(
        AlphaShape::of(&[]),
        Err(AlphaError::Points(DelaunayError::Points(PointsError::Empty)))
    ));
    let shape = AlphaShape::of(&InputKind::Sphere.points(20, 1)).unwrap();
    for alpha in [0.0, -1.0, f64::NAN] {
        assert!(matches!(shape.volume(alpha), Err(AlphaError::Alpha(_))));
    }
    let mut contacts = even(10);
    assert!(matches!(HermiteSurface::through(&contacts[..3]), Err(SurfaceError::Count { found: 3, .. })));
    contacts[4].point = contacts[2].point;
    assert!(matches!(
        HermiteSurface::through(&contacts),
        Err(SurfaceError::Coincident { first: 2, second: 4, .. })
    ));
    contacts[4].point.x = f64::INFINITY;
    assert!(matches!(HermiteSurface::through(&contacts), Err(SurfaceError::NotFinite { index: 4 })));
}

#[test]
fn the_size_of_the_points_does_not_matter() {
    let mut s = crate::generators::Source::new(3);
    let points: Vec<DVec3> = (0..60).map(|_| s.normal3()).collect();
    let own = AlphaShape::of(&points).unwrap();
    let expected = own.connecting_radius();
    // Powers of two, so that the scaled points are exact: 1e-110, 1e61, 1e150.
    for exponent in [-365, 203, 498] {
        let unit = 2.0_f64.powi(exponent);
        let scaled: Vec<DVec3> = points.iter().map(|p| *p * unit).collect();
        let shape = AlphaShape::of(&scaled).unwrap();
        assert!((shape.connecting_radius() / unit / expected - 1.0).abs() < 1e-9, "{exponent}");
        assert_eq!(
            shape.mesh(expected * unit * 1.001).unwrap().triangles,
            own.mesh(expected * 1.001).unwrap().triangles
        );
        let exact_hull::Hull::Solid(hull) = exact_hull::Hull::of(&scaled).unwrap() else { panic!("flat") };
        assert!(scaled.iter().all(|p| hull.contains(*p)), "{exponent}");
        assert!(!hull.contains(scaled[0] * 100.0) && !hull.contains(DVec3::splat(1e300)));
    }
    let wild = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z * 1e-200, DVec3::ONE];
    assert!(matches!(AlphaShape::of(&wild), Err(AlphaError::Points(_))));
}
