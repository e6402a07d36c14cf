//! Seeded contacts, and the kinds of points on which hull algorithms are known to fail.

pub use crate::features::simulated::{Touched, TouchedBody, Touching};
pub use exact_hull::generators::{AXES, InputKind, Source, ellipsoid_support};

use crate::sample::ContactSample;
use contact_kinematics::Direction;
use exact_hull::generators::{curve_normals, ellipsoid_point};
use glam::DVec3;

/// Contacts on three smooth closed curves on the ellipsoid with semi-axes [`AXES`].
#[must_use]
pub fn curve_contacts(count: usize, seed: u64) -> Vec<ContactSample> {
    curve_normals(count, &mut Source::new(seed)).into_iter().map(ellipsoid_contact).collect()
}

/// Contacts all over the ellipsoid with semi-axes [`AXES`], normals uniform.
#[must_use]
pub fn ellipsoid_contacts(count: usize, seed: u64) -> Vec<ContactSample> {
    let mut s = Source::new(seed);
    (0..count).map(|_| ellipsoid_contact(s.direction())).collect()
}

/// Contacts of [`curve_contacts`], one list for each curve, measured with normal noise: points with standard deviation
/// `point_sd` per axis (m), normals with `normal_sd` about each tangent axis (rad).
#[must_use]
pub fn noisy_curves(count: usize, point_sd: f64, normal_sd: f64, seed: u64) -> Vec<Vec<ContactSample>> {
    let mut s = Source::new(seed ^ 0xA01E);
    let mut curves = vec![Vec::new(); 3];
    for (i, c) in curve_contacts(count, seed).into_iter().enumerate() {
        let (a, b) = c.normal.tangent_basis();
        let normal = c.normal.get() + (a * s.normal() + b * s.normal()) * normal_sd;
        curves[i % 3].push(ContactSample {
            point: c.point + s.normal3() * point_sd,
            normal: Direction::new_unchecked(normal.normalize()),
        });
    }
    curves
}

/// Normals scattered over the sphere.
pub fn scattered_normals(count: usize, s: &mut Source) -> Vec<DVec3> {
    (0..count).map(|_| s.direction()).collect()
}

/// Normals along three closed curves, as three palms trace them.
pub fn traced_normals(count: usize, s: &mut Source) -> Vec<DVec3> {
    let turns = [s.rotation(), s.rotation(), s.rotation()];
    (0..count)
        .map(|i| {
            let t = (i / 3) as f64 / count.div_ceil(3) as f64 * std::f64::consts::TAU;
            turns[i % 3] * DVec3::new(t.cos(), t.sin(), 0.6 * (2.0 * t).sin()).normalize()
        })
        .collect()
}

fn ellipsoid_contact(n: DVec3) -> ContactSample {
    ContactSample { point: ellipsoid_point(n), normal: Direction::new_unchecked(n) }
}
