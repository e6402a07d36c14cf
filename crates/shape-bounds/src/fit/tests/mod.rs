//! What theory says of fits: derivatives, exact recovery, consistent covariances, rates of choice, and typed refusals.

mod choice;
mod recovery;
mod refusal;
mod statistics;

use super::family::{EllipsoidModel, HarmonicModel, Model, SphereModel, SuperquadricModel};
use super::levenberg::Problem;
use super::*;
use crate::generators::{Source, scattered_normals as scattered, traced_normals as curves};
use crate::noise::ContactNoise;
use crate::sample::ContactSample;
use contact_kinematics::{Direction, PolynomialSupport, Sphere, SupportFunction, Translated};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::DVector;

/// Contacts at `normals` of a body, points off by `point` (m per axis) and normals by `angle` (rad per tangent axis), with
/// that noise stated.
pub(super) fn measured(
    body: &dyn SupportFunction,
    normals: impl IntoIterator<Item = DVec3>,
    point: f64,
    angle: f64,
    s: &mut Source,
) -> Vec<NoisyContact> {
    normals
        .into_iter()
        .map(|n| {
            let n = Direction::new(n).unwrap();
            let (a, b) = n.tangent_basis();
            let turned = n.get() + (a * s.normal() + b * s.normal()) * angle;
            let contact = ContactSample {
                point: body.point(n) + s.normal3() * point,
                normal: Direction::new(turned).unwrap(),
            };
            NoisyContact { contact, noise: ContactNoise::isotropic(point, angle) }
        })
        .collect()
}

/// Exact contacts with a stated noise that is small against the body.
pub(super) fn exact(
    body: &dyn SupportFunction,
    normals: impl IntoIterator<Item = DVec3>,
) -> Vec<NoisyContact> {
    let mut contacts = measured(body, normals, 0.0, 0.0, &mut Source::new(0));
    contacts.iter_mut().for_each(|c| c.noise = ContactNoise::isotropic(1e-3, 1e-3));
    contacts
}

pub(super) fn random_ellipsoid(s: &mut Source) -> SkewEllipsoid {
    let turn = DMat3::from_quat(s.rotation());
    let squares = DVec3::new(s.between(0.5, 2.0), s.between(0.5, 2.0), s.between(0.5, 2.0)).powf(2.0);
    SkewEllipsoid::new(s.normal3(), turn * DMat3::from_diagonal(squares) * turn.transpose()).unwrap()
}

pub(super) fn superquadric_body(s: &mut Source) -> Superquadric {
    let axes = DVec3::new(1.0, 0.8, 1.4);
    Superquadric::new(s.normal3() * 0.2, axes, s.rotation(), [0.8, 1.25]).unwrap()
}

/// A harmonic body of degree 4 that is no ellipsoid.
pub(super) fn harmonic_body(s: &mut Source) -> PolynomialSupport {
    let mut rows = vec![vec![3.5], vec![0.1, -0.1, 0.05]];
    for l in 2..=4usize {
        rows.push((0..=2 * l).map(|_| s.normal() * 0.25 / (l * l) as f64).collect());
    }
    PolynomialSupport::from_harmonics(&rows).unwrap()
}

/// Largest difference of the support functions over a few directions.
pub(super) fn distance(a: &dyn SupportFunction, b: &dyn SupportFunction) -> f64 {
    let mut s = Source::new(99);
    (0..200)
        .map(|_| Direction::new(s.direction()).unwrap())
        .map(|n| (a.value(n) - b.value(n)).abs())
        .fold(0.0, f64::max)
}
