//! Limits that are a body's own radii: balls of which many coincide, or have no more than one point in common.

use super::*;
use crate::generators::Source;
use std::f64::consts::PI;

/// A body of which all is known.
struct Body {
    name: &'static str,
    volume: f64,
    contacts: fn(&mut Source) -> Vec<DVec3>,
    /// The contact's point for a normal.
    point: fn(DVec3) -> DVec3,
    limits: &'static [(f64, f64)],
}

fn all_around(s: &mut Source) -> Vec<DVec3> {
    (0..200).map(|_| s.direction()).collect()
}

fn on_one_side(s: &mut Source) -> Vec<DVec3> {
    let (axis, least) = (s.direction(), s.between(-0.1, 0.5));
    all_around(s).into_iter().filter(|n| n.dot(axis) > least).collect()
}

fn near_the_poles(s: &mut Source) -> Vec<DVec3> {
    all_around(s).into_iter().filter(|n| n.z.abs() > 0.5).collect()
}

const BODIES: [Body; 4] = [
    Body {
        name: "unit sphere",
        volume: 4.0 / 3.0 * PI,
        contacts: all_around,
        point: |n| n,
        limits: &[(0.0, 1.0), (0.5, 1.0), (1.0, 5.0), (1.0, 1000.0), (0.0, 1.0 + 1e-12), (0.9, 1.0 + 1e-9)],
    },
    Body {
        name: "unit sphere from one side",
        volume: 4.0 / 3.0 * PI,
        contacts: on_one_side,
        point: |n| n,
        limits: &[(0.0, 1.0), (0.5, 1.0), (1.0, 5.0)],
    },
    Body {
        name: "capsule on its caps",
        volume: PI / 6.0 + PI / 2.0,
        contacts: near_the_poles,
        point: |n| n * 0.5 + DVec3::Z * n.z.signum(),
        limits: &[(0.0, 1000.0), (0.5, 1000.0), (0.5, 50.0), (0.5, 5.0)],
    },
    Body {
        name: "two unit balls' common part",
        volume: PI * 5.0 / 12.0,
        contacts: near_the_poles,
        point: |n| n - DVec3::Z * (0.5 * n.z.signum()),
        limits: &[(0.0, 1.0), (0.0, 1.0 + 1e-10), (0.0, 1.5)],
    },
];

/// Bounds of every body, turned and moved, with points rounded by `noise` (m); `judge` gets the true support function too.
fn each(
    noise: f64,
    seeds: u64,
    judge: impl Fn(&str, &[ContactSample], CurvatureRadii, f64, &dyn Fn(DVec3) -> f64),
) {
    for (which, body) in BODIES.iter().enumerate() {
        for (min, max) in body.limits {
            for seed in 0..seeds {
                let mut s = Source::new(100 * seed + which as u64);
                let (turn, shift) = (s.rotation(), s.direction() * s.between(0.0, 3.0));
                let normals = (body.contacts)(&mut s);
                let contacts: Vec<ContactSample> = normals
                    .into_iter()
                    .map(|n| ContactSample {
                        point: turn * (body.point)(n) + shift + s.normal3() * noise,
                        normal: Direction::new(turn * n).unwrap(),
                    })
                    .collect();
                // The rim of the common part has normals of its own.
                let support = |n: DVec3| {
                    let own = turn.inverse() * n;
                    let rim = 0.75_f64.sqrt() * own.truncate().length();
                    let lens = which == 3 && own.z.abs() < 0.5;
                    (if lens { rim } else { own.dot((body.point)(own)) }) + n.dot(shift)
                };
                let name = format!("{} within {min} and {max}, seed {seed}", body.name);
                judge(&name, &contacts, CurvatureRadii { min: *min, max: *max }, body.volume, &support);
            }
        }
    }
}

#[test]
fn limits_that_are_the_bodys_own_radii_leave_bounds_around_the_body() {
    for noise in [0.0, 1e-13] {
        each(noise, 3, |name, contacts, radii, volume, truth| {
            let sharp = SharpBounds::from_contacts(contacts, radii).unwrap_or_else(|e| panic!("{name}: {e}"));
            let tight =
                CurvatureBounds::from_contacts(contacts, radii).unwrap_or_else(|e| panic!("{name}: {e}"));
            let (low, high) = (sharp.lower().volume(), sharp.upper().volume());
            // No body within the limits has the capsule's flat side: the lower bound bulges there.
            let bulge = if name.starts_with("capsule") { 0.6 / radii.max } else { 0.0 };
            assert!(
                low <= volume * (1.0 + 1e-11) + 5.0 * bulge && high >= volume * (1.0 - 1e-11),
                "{name}: {low} {volume} {high}"
            );
            assert!(
                high <= tight.upper().volume() * (1.0 + 1e-3),
                "{name}: {high} {}",
                tight.upper().volume()
            );
            let mut s = Source::new(9);
            for _ in 0..30 {
                let n = s.direction();
                let truth = truth(n);
                let n = Direction::new(n).unwrap();
                let ((e, f), (d, c)) = (sharp.support(n), tight.support(n));
                // Where the radius had to be made larger, by a ten-millionth of it.
                let room = 1e-11 + 2e-7 * radii.max;
                assert!(e <= truth + 1e-11 + bulge && truth <= f + 1e-11, "{name}: {e} {truth} {f}");
                assert!(
                    d <= e + room && f <= c + room && truth <= c + 1e-11,
                    "{name}: {d} {e} {truth} {f} {c}"
                );
            }
        });
    }
}

#[test]
fn a_sphere_known_to_be_one_is_bounded_to_rounding() {
    each(0.0, 4, |name, contacts, radii, volume, _| {
        if name.starts_with("unit sphere within") && radii.max < 2.0 {
            let sharp = SharpBounds::from_contacts(contacts, radii).unwrap();
            for found in [sharp.lower().volume(), sharp.upper().volume()] {
                assert!((found / volume - 1.0).abs() < 1e-6, "{name}: {found}");
            }
        }
    });
}

#[test]
fn meshes_within_the_bodys_own_radii_enclose_it() {
    each(0.0, 1, |name, contacts, radii, volume, truth| {
        let sharp = SharpBounds::from_contacts(contacts, radii).unwrap();
        let tolerance = 0.02;
        let polytopes = sharp.polytopes(tolerance).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (low, high) = (polytopes.lower_volume(), polytopes.upper_volume());
        let bulge = if name.starts_with("capsule") { 0.6 / radii.max } else { 0.0 };
        assert!(low <= volume + 5.0 * bulge && volume <= high, "{name}: {low} {volume} {high}");
        assert!(low <= sharp.lower().volume() && sharp.upper().volume() <= high, "{name}: {low} {high}");
        let mut s = Source::new(2);
        for _ in 0..100 {
            let n = s.direction();
            let (e, f) = polytopes.support(Direction::new(n).unwrap());
            assert!(e <= truth(n) + 1e-9 + bulge && truth(n) <= f + 1e-9, "{name}: {e} {} {f}", truth(n));
        }
    });
}
