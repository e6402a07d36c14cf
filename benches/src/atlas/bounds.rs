//! Bounds on a shape, at a confidence of which chance alone breaks hardly any.

use super::judged::Ran;
use super::{Failure, Method, Way};
use crate::noisy_contacts::{Body, Case, Course, Levels, TrueNoise, WrongContacts, bounded, cleaned};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{CurvatureRadii, Direction};
use shape_bounds::curvature::SharpBounds;
use shape_bounds::generators::Source;
use std::f64::consts::{PI, TAU};

const CONFIDENCE: f64 = 0.9999;
/// Directions in which curved bounds are compared with the body.
const DIRECTIONS: usize = 300;
/// What rounding may take, sizes.
const ROUNDING: f64 = 1e-9;

pub(super) const STATED: Method = Method {
    name: "bounds",
    about: "hull and half-spaces of ellipsoids, eggs and rounded boxes at a confidence of 0.9999, as `recon bounds` makes them; right: the body lies between them",
    ways: {
        use Way::*;
        &[Sphere, Revolution, Noise, Unstated, Correlation, Outliers, Size, Contacts, Cone]
    },
    seeds: 30,
    every: 1,
    run: stated,
};

pub(super) const CURVED: Method = Method {
    name: "bounds, limits on curvature",
    about: "ellipsoids with their own limits on the radii of curvature, at a confidence of 0.9999, as `recon bounds` makes them; right: the support function lies between those of the bounds in 300 directions",
    ways: {
        use Way::*;
        &[Sphere, Revolution, Noise, Unstated, Size, Contacts, Cone, Limit]
    },
    seeds: 30,
    every: 1,
    run: curved,
};

/// What is touched.
struct Touched {
    body: Body,
    case: Case,
}

/// A body along a way, touched along three curves.
fn touched(way: Way, strength: f64, seed: u64, ellipsoid: bool) -> Result<Touched, Failure> {
    let mut s = Source::new(seed.wrapping_mul(7919) ^ 0xA71A);
    let size = if way == Way::Size { strength } else { 1.0 };
    let drawn = Body::random(seed, &mut s);
    let axes = match way {
        Way::Sphere => Some(DVec3::new(1.0, 1.0 + strength, 1.0 + 2.0 * strength)),
        Way::Revolution => Some(DVec3::new(1.0, 1.0 + strength, 2.0)),
        _ if ellipsoid => Some(DVec3::new(s.between(0.8, 2.0), s.between(0.8, 2.0), s.between(0.8, 2.0))),
        _ => None,
    };
    let body = match axes.map_or(drawn, Body::Ellipsoid) {
        Body::Ellipsoid(axes) => Body::Ellipsoid(axes * size),
        Body::Egg { axes, bulge } => Body::Egg { axes: axes * size, bulge: bulge * size },
        Body::RoundedBox { half, radius } => Body::RoundedBox { half: half * size, radius: radius * size },
    };
    let count = if way == Way::Contacts { strength as usize } else { 300 };
    let cone = if way == Way::Cone { strength / 180.0 } else { 1.0 };
    let level = if way == Way::Noise { strength } else { 1e-3 };
    let plain = TrueNoise { course: Course::Constant(1.0), correlation: 0.0, wrong: None };
    let noise = match way {
        Way::Unstated => TrueNoise { course: Course::Constant(strength), ..plain },
        Way::Correlation => TrueNoise { correlation: strength, ..plain },
        Way::Outliers => TrueNoise { wrong: Some(WrongContacts { share: strength, pairs: false }), ..plain },
        _ => plain,
    };
    let exact: Vec<_> = (0..3).map(|k| curve(&body, (count + 2 - k) / 3, cone, &mut s)).collect();
    let case = Case::measured(body, &exact, level, noise, &mut s)?;
    Ok(Touched { body, case })
}

/// Contacts along a closed curve, whose directions are drawn towards one of them.
fn curve(body: &Body, count: usize, cone: f64, s: &mut Source) -> Vec<(DVec3, DVec3)> {
    let (turn, phase): (DQuat, f64) = (s.rotation(), s.unit() * TAU);
    let contact = |k: usize| {
        let t = k as f64 / count as f64 * TAU;
        let along = (turn * DVec3::new(t.cos(), t.sin(), 0.6 * (2.0 * t + phase).sin())).normalize();
        let polar = along.z.clamp(-1.0, 1.0).acos().min(PI) * cone;
        let level = along.truncate().normalize_or(glam::DVec2::X) * polar.sin();
        body.contact(level.extend(polar.cos()))
    };
    (0..count).map(contact).collect()
}

fn stated(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let Touched { body, case } = touched(way, strength, seed, false)?;
    Ok(match bounded(&case, Levels::Stated, CONFIDENCE) {
        Err(error) => Ran::refused(&error),
        Ok(None) => Ran::Refused("noise that is alike".to_owned()),
        Ok(Some(found)) => {
            let nothing = found.bounds.lower.is_none() && found.bounds.upper.is_none();
            let doubt = if nothing {
                Some("nothing is certain".to_owned())
            } else {
                found.warned.then(|| "noise is not as stated".to_owned())
            };
            Ran::Found { off: if body.is_between(&found.bounds) { 0.0 } else { f64::INFINITY }, doubt }
        }
    })
}

fn curved(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let Touched { body, case } = touched(way, strength, seed, true)?;
    let Body::Ellipsoid(axes) = body else { return Err("no ellipsoid".into()) };
    let (shortest, longest) = (axes.min_element(), axes.max_element());
    let narrow = if way == Way::Limit { 1.0 + strength } else { 1.0 };
    let radii = CurvatureRadii {
        min: shortest * shortest / longest * narrow,
        max: longest * longest / shortest / narrow,
    };
    let (kept, warned) = match cleaned(&case, Levels::Stated, CONFIDENCE) {
        Err(error) => return Ok(Ran::refused(&error)),
        Ok(None) => return Ok(Ran::Refused("noise that is alike".to_owned())),
        Ok(Some(found)) => (found.kept, found.warned),
    };
    let bounds = match SharpBounds::from_noisy_curves(&kept, radii, CONFIDENCE) {
        Ok(bounds) => bounds,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let mut source = Source::new(seed);
    let rounding = ROUNDING * longest;
    let between = (0..DIRECTIONS).all(|_| {
        let n = source.direction();
        let (lower, upper) = bounds.support(Direction::new_unchecked(n));
        (lower - rounding..=upper + rounding).contains(&body.support(n))
    });
    let doubt = warned.then(|| "noise is not as stated".to_owned());
    Ok(Ran::Found { off: if between { 0.0 } else { f64::INFINITY }, doubt })
}
