//! An ellipsoid fitted to contacts.

use super::judged::Ran;
use super::{DEVIATIONS, Failure, Method, Way};
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use shape_bounds::ContactSample;
use shape_bounds::fit::{FitOptions, ShapeFamily, ShapeFit, SkewEllipsoid};
use shape_bounds::generators::Source;
use shape_bounds::noise::{ContactNoise, NoisyContact};

/// Directions in which support functions are compared.
const DIRECTIONS: usize = 50;
/// What a fit to exact contacts may be off by, in sizes.
const EXACT: f64 = 1e-7;

pub(super) const METHOD: Method = Method {
    name: "fit of an ellipsoid",
    about: "an ellipsoid of any place and axes fitted to scattered contacts; right: the support function in 50 directions within five stated deviations",
    ways: {
        use Way::*;
        &[Sphere, Revolution, Noise, Unstated, Correlation, Outliers, Size, Contacts, Cone, Family]
    },
    seeds: 30,
    every: 1,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let mut s = Source::new(seed.wrapping_mul(6007) ^ 0xF17);
    let size = if way == Way::Size { strength } else { 1.0 };
    let axes = size
        * match way {
            Way::Sphere => DVec3::new(1.0, 1.0 + strength, 1.0 + 2.0 * strength),
            Way::Revolution => DVec3::new(1.0, 1.0 + strength, 2.0),
            _ => DVec3::new(s.between(0.5, 2.0), s.between(0.5, 2.0), s.between(0.5, 2.0)),
        };
    let turn = DMat3::from_quat(s.rotation());
    let matrix = turn * DMat3::from_diagonal(axes * axes) * turn.transpose();
    let body = SkewEllipsoid::new(s.normal3() * size, matrix)?;
    let bulge = if way == Way::Family { strength * size } else { 0.0 };
    let contacts = contacts(way, strength, (&body, bulge, size), &mut s)?;
    let fit = match ShapeFit::of(&contacts, ShapeFamily::Ellipsoid, &FitOptions::default()) {
        Ok(fit) => fit,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let exact = way == Way::Noise && strength == 0.0;
    let mut off = 0.0;
    for _ in 0..DIRECTIONS {
        let n = Direction::new(s.direction())?;
        let truth = body.value(n) + bulge * n.get().z.powi(3);
        let deviation = fit.support_deviation(n).max(if exact { EXACT * size } else { 0.0 });
        let own = (fit.value(n) - truth).abs() / deviation / DEVIATIONS;
        off = if own > off || own.is_nan() { own } else { off };
    }
    Ok(Ran::Found { off, doubt: None })
}

/// Measured contacts of a body with a bulge along its third axis: `h = h_0 + b n_z^3`.
fn contacts(
    way: Way,
    strength: f64,
    (body, bulge, size): (&SkewEllipsoid, f64, f64),
    s: &mut Source,
) -> Result<Vec<NoisyContact>, Failure> {
    let count = if way == Way::Contacts { strength as usize } else { 60 };
    let cone = if way == Way::Cone { strength / 180.0 } else { 1.0 };
    let level = if way == Way::Noise { strength } else { 1e-3 };
    let true_level = if way == Way::Unstated { level * strength } else { level };
    let correlation = if way == Way::Correlation { strength } else { 0.0 };
    let outliers = if way == Way::Outliers { strength } else { 0.0 };
    // Nothing is exact: what is stated of exact contacts is next to nothing.
    let stated = level.max(1e-12);
    let noise = ContactNoise::isotropic(stated * size, stated);
    let (mut held, fresh) = ([DVec3::ZERO; 2], (1.0 - correlation * correlation).sqrt());
    let mut all = Vec::with_capacity(count);
    for k in 0..count {
        let polar = s.direction().z.clamp(-1.0, 1.0).acos() * cone;
        let around = s.between(0.0, std::f64::consts::TAU);
        let d = DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos());
        let n = Direction::new(d)?;
        let lump = bulge * (DVec3::Z * 3.0 * d.z * d.z - d * 2.0 * d.z.powi(3));
        let share = if k == 0 { 1.0 } else { fresh };
        held = held.map(|h| h * correlation + s.normal3() * share);
        let (a, b) = n.tangent_basis();
        let wrong = if s.unit() < outliers { s.direction() * (0.2 * size) } else { DVec3::ZERO };
        let contact = ContactSample {
            point: body.point(n) + lump + held[0] * (true_level * size) + wrong,
            normal: Direction::new(d + (a * held[1].x + b * held[1].y) * true_level)?,
        };
        all.push(NoisyContact { contact, noise });
    }
    Ok(all)
}
