//! Splines and principal surfaces against theory: order, interpolation, tangent planes, bias, refusals.

use super::*;
use crate::planar;
use crate::planar::approximation::{PrincipalCurve, SplineCurve};
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use exact_hull::TriangleMesh;
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// The contact of a star-shaped body that the origin sees along `d`, from its distance and the gradient of that in space.
fn of_radius(d: DVec3, radius: f64, gradient: DVec3) -> ContactSample {
    let across = gradient - d * d.dot(gradient);
    ContactSample { point: d * radius, normal: Direction::new(d * radius - across).unwrap() }
}

/// A smooth convex body without symmetry.
fn egg(d: DVec3) -> ContactSample {
    let gradient = DVec3::new(0.2 * d.y, 0.2 * d.x, 0.3 * d.z * d.z);
    of_radius(d, 1.0 + 0.1 * d.z.powi(3) + 0.2 * d.x * d.y, gradient)
}

/// A body of revolution with a waist.
fn waisted(d: DVec3) -> ContactSample {
    of_radius(d, 0.65 + 0.7 * d.z * d.z, DVec3::Z * (1.4 * d.z))
}

/// Directions spread evenly.
fn even(count: usize) -> Vec<DVec3> {
    (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
            let (sin, cos) = (PI * (3.0 - 5f64.sqrt()) * i as f64).sin_cos();
            let across = (1.0 - z * z).sqrt();
            DVec3::new(across * cos, across * sin, z)
        })
        .collect()
}

fn touched(body: fn(DVec3) -> ContactSample, count: usize) -> Vec<ContactSample> {
    even(count).into_iter().map(body).collect()
}

/// Root mean square distance of the body's surface from the approximation.
fn error(surface: &SplineSurface, body: fn(DVec3) -> ContactSample) -> f64 {
    let truth = touched(body, 301);
    (truth.iter().map(|c| surface.distance(c.point).powi(2)).sum::<f64>() / 301.0).sqrt()
}

#[test]
fn the_error_falls_with_the_fourth_power_of_the_spacing() {
    let [coarse, fine] =
        [25, 100].map(|count| error(&SplineSurface::through(&touched(egg, count)).unwrap(), egg));
    // Half of the spacing.
    let order = (coarse / fine).log2();
    assert!(order > 3.7, "{order}: {coarse} {fine}");
}

/// The outline at `1 + 0.3 cos 2t + 0.1 sin 3t`.
fn outline(t: f64) -> planar::ContactSample {
    let radius = 1.0 + 0.3 * (2.0 * t).cos() + 0.1 * (3.0 * t).sin();
    let slope = -0.6 * (2.0 * t).sin() + 0.3 * (3.0 * t).cos();
    let out = DVec2::from_angle(t);
    let normal = exact_hull::planar::Direction::new(out * radius - out.perp() * slope).unwrap();
    planar::ContactSample { point: out * radius, normal }
}

#[test]
fn in_the_plane_as_well() {
    let error = |count: u32| {
        let contacts: Vec<_> = (0..count).map(|k| outline(TAU * f64::from(k) / f64::from(count))).collect();
        let curve = SplineCurve::through(&contacts).unwrap();
        let squares = (0..500).map(|k| curve.distance(outline(PI * f64::from(k) / 250.0).point).powi(2));
        (squares.sum::<f64>() / 500.0).sqrt()
    };
    let [coarse, fine] = [16, 64].map(error);
    let order = (coarse / fine).log2() / 2.0;
    assert!(order > 3.7, "{order}: {coarse} {fine}");
}

#[test]
fn contacts_and_their_tangent_planes_are_met() {
    for body in [egg, waisted] {
        let contacts = touched(body, 40);
        let surface = SplineSurface::through(&contacts).unwrap();
        assert!(surface.residual() < 1e-9, "{}", surface.residual());
        for c in &contacts {
            let from_centre = c.point - surface.centre();
            assert!(surface.point(from_centre).distance(c.point) < 1e-8);
            assert!((surface.normal(from_centre).get() - c.normal.get()).length() < 1e-6);
        }
    }
}

#[test]
fn the_surface_is_smooth_across_the_curves() {
    let surface = SplineSurface::through(&touched(egg, 60)).unwrap();
    for (k, d) in even(50).into_iter().enumerate() {
        // The normal is that of the surface, by differences of its points.
        let (a, b) = Direction::new(d).unwrap().tangent_basis();
        for along in [a, b] {
            let chord = surface.point(d + along * 1e-5) - surface.point(d - along * 1e-5);
            assert!(surface.normal(d).get().dot(chord.normalize()).abs() < 1e-7, "{k}");
        }
        // And its rate has no steps: twice continuously differentiable.
        let rate =
            |at: DVec3| (surface.normal(at + a * 1e-4).get() - surface.normal(at - a * 1e-4).get()) / 2e-4;
        assert!((rate(d + a * 1e-3) - rate(d - a * 1e-3)).length() < 0.1, "{k}");
    }
}

#[test]
fn a_waist_is_kept_and_the_mesh_is_closed() {
    let surface = SplineSurface::through(&touched(waisted, 100)).unwrap();
    assert!(surface.contains(DVec3::X * 0.6) && !surface.contains(DVec3::X * 0.7));
    // In the hull, but in the waist.
    assert!(!surface.contains(DVec3::new(0.75, 0.0, 0.0)));
    let mesh = surface.mesh(20);
    assert_eq!(mesh.triangles.len(), 8 * 400);
    // Each edge is left on one side and come back along on the other.
    let edges = |mesh: &TriangleMesh, back: bool| {
        let mut all: Vec<[u32; 2]> = mesh
            .triangles
            .iter()
            .flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]])
            .map(|[a, b]| if back { [b, a] } else { [a, b] })
            .collect();
        all.sort_unstable();
        all
    };
    assert_eq!(edges(&mesh, false), edges(&mesh, true));
    assert_eq!(mesh.vertices.len() + mesh.triangles.len() - 3 * mesh.triangles.len() / 2, 2);
    // 4 pi / 3 times the mean of (0.65 + 0.7 z^2)^3.
    let (a, b) = (0.65_f64, 0.7_f64);
    let truth = 4.0 * PI / 3.0 * (a.powi(3) + a * a * b + 3.0 * a * b * b / 5.0 + b.powi(3) / 7.0);
    assert!((mesh.moments().volume / truth - 1.0).abs() < 0.02, "{}", mesh.moments().volume / truth);
}

#[test]
fn a_turned_body_is_approximated_as_well() {
    // Lattices stand otherwise in a turned body: both err, by about as much.
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.7, -0.4, 1.1);
    let contacts = touched(egg, 60);
    let turned: Vec<ContactSample> = contacts
        .iter()
        .map(|c| ContactSample {
            point: turn * c.point,
            normal: Direction::new_unchecked(turn * c.normal.get()),
        })
        .collect();
    let own = SplineSurface::through(&contacts).unwrap();
    let other = SplineSurface::through(&turned).unwrap();
    let truth = touched(egg, 101);
    let most = truth.iter().map(|c| own.distance(c.point).abs()).fold(0.0, f64::max);
    for c in &truth {
        let difference = own.distance(c.point) - other.distance(turn * c.point);
        assert!(difference.abs() < 2.0 * most, "{difference} {most}");
    }
}

#[test]
fn the_principal_surface_lies_out_by_its_curvature() {
    let (noise, runs, count) = (0.2, crate::few_or_all(6, 12), 60);
    let (mut radius, mut bias) = (0.0, 0.0);
    for seed in 0..runs {
        let mut source = crate::generators::Source::new(seed);
        let points: Vec<DVec3> = even(count).into_iter().map(|d| d + source.normal3() * noise).collect();
        let found = PrincipalSurface::of(&points, Some(noise)).unwrap();
        let surface = found.surface();
        let distance = |d: &DVec3| (surface.point(*d) - surface.centre()).length();
        radius += even(40).iter().map(distance).sum::<f64>() / (40.0 * runs as f64);
        bias += found.bias() / runs as f64;
    }
    // The mean distance of normal noise about a point at distance 1 is 1 + noise^2; three standard errors of the mean.
    let error = 3.0 * noise / ((runs as usize * count) as f64).sqrt();
    assert!((radius - 1.0 - noise * noise).abs() < error && noise * noise > error, "{radius}");
    assert!((bias / (noise * noise) - 1.0).abs() < 0.2, "{bias}");
}

#[test]
fn the_principal_curve_of_a_circle_lies_out_by_half_of_the_variance() {
    let step = 0.1;
    let points: Vec<DVec2> = (0..24)
        .flat_map(|k| {
            let out = DVec2::from_angle(TAU * f64::from(k) / 24.0);
            [out * (1.0 + step), out * (1.0 - step), out + out.perp() * step, out - out.perp() * step]
        })
        .collect();
    let found = PrincipalCurve::of(&points, None).unwrap();
    let mean = (2.0 + 2.0 * (1.0 + step * step).sqrt()) / 4.0;
    for p in found.curve().outline(50) {
        assert!((p.length() - mean).abs() < 3e-4, "{} {mean}", p.length());
    }
    assert!((found.bias() - (mean - 1.0)).abs() < 0.1 * (mean - 1.0), "{}", found.bias());
}

#[test]
fn the_more_noise_the_fewer_parameters() {
    let mut source = crate::generators::Source::new(5);
    let mut of = |noise: f64| {
        let point = |k: u32| outline(TAU * f64::from(k) / 150.0).point;
        let points = (0..150).map(|k| point(k) + DVec2::new(source.normal(), source.normal()) * noise);
        let found = PrincipalCurve::of(&points.collect::<Vec<_>>(), None).unwrap();
        // The square of a deviation from so many points varies by the root of two over their number: 0.115, of which this is four.
        assert!((found.scatter().powi(2) / (noise * noise) - 1.0).abs() < 0.46, "{}", found.scatter());
        found.freedom()
    };
    let [little, much] = [1e-3, 0.1].map(&mut of);
    assert!(little > 1.5 * much, "{little} {much}");
}

#[test]
fn bad_input_is_named() {
    let mut contacts = touched(egg, 30);
    let found = SplineSurface::through(&contacts[..3]);
    assert!(matches!(found, Err(ApproximationError::TooFew { found: 3, least: 4 })));
    let mut points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
    assert!(matches!(PrincipalSurface::of(&points[..19], None), Err(ApproximationError::TooFew { .. })));
    for noise in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(PrincipalSurface::of(&points, Some(noise)), Err(ApproximationError::Noise(_))));
    }
    points[7].y = f64::NAN;
    assert!(matches!(PrincipalSurface::of(&points, None), Err(ApproximationError::NotFinite { index: 7 })));
    contacts[4].normal = -contacts[4].normal;
    let Err(ApproximationError::NotStarShaped { contacts: named }) = SplineSurface::through(&contacts) else {
        panic!("a contact from inside")
    };
    assert!(named.contains(&4), "{named:?}");
    contacts.iter_mut().for_each(|c| c.point.z = 0.25);
    let flat = SplineSurface::through(&contacts);
    assert!(matches!(flat, Err(ApproximationError::Flat { dimension: 2 })), "{flat:?}");
    let line: Vec<DVec2> = (0..20).map(|k| DVec2::splat(f64::from(k))).collect();
    assert!(matches!(PrincipalCurve::of(&line, None), Err(ApproximationError::Flat { dimension: 1 })));
}

#[test]
fn a_torus_is_refused() {
    let contacts: Vec<ContactSample> = (0..200)
        .map(|k| {
            let (around, across) = (TAU * f64::from(k) / 20.0, TAU * f64::from(k) * 0.382);
            let out = DVec3::new(around.cos(), around.sin(), 0.0);
            let normal = out * across.cos() + DVec3::Z * across.sin();
            ContactSample { point: out + normal * 0.3, normal: Direction::new_unchecked(normal) }
        })
        .collect();
    assert!(matches!(SplineSurface::through(&contacts), Err(ApproximationError::NotStarShaped { .. })));
}
