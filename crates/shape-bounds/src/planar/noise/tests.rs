//! Coverage of the bounds under noise, and what they cost.

use super::*;
use crate::generators::Source;
use crate::planar::{BoundsError, ContactSample, Direction};
use contact_kinematics::planar::{Ellipse, RadiusFunction};
use glam::DVec2;
use std::f64::consts::TAU;

/// One curve of contacts all round the ellipse 2, 1, points off by `level` times 2 m per axis, normals by `level` rad.
fn curve(count: usize, level: f64, s: &mut Source) -> Vec<Vec<NoisyContact>> {
    let body = Ellipse::new(2.0, 1.0, DVec2::new(0.2, 0.1)).unwrap();
    let contact = |k: usize| {
        let angle = TAU * k as f64 / count as f64;
        let point = body.point(angle) + DVec2::new(s.normal(), s.normal()) * (2.0 * level);
        let contact = ContactSample { point, normal: Direction::from_angle(angle + s.normal() * level) };
        NoisyContact { contact, noise: ContactNoise::isotropic(2.0 * level, level) }
    };
    vec![(0..count).map(contact).collect()]
}

#[test]
fn the_body_lies_between_the_bounds_and_the_gap_stays_small() {
    let body = Ellipse::new(2.0, 1.0, DVec2::new(0.2, 0.1)).unwrap();
    let directions: Vec<f64> = (0..180).map(|k| TAU * f64::from(k) / 180.0).collect();
    let between = |bounds: &ShapeBounds| {
        directions.iter().all(|angle| {
            let (lower, upper) = bounds.support(Direction::from_angle(*angle));
            lower <= body.jet(*angle).r + 1e-9 && body.jet(*angle).r <= upper + 1e-9
        })
    };
    let (mut sound, mut plain, runs) = (0, 0, 200);
    let mut gaps = Vec::new();
    for seed in 0..runs {
        let mut s = Source::new(seed);
        let curves = curve(60, 1e-3, &mut s);
        let bounds = ShapeBounds::from_noisy_curves(&curves, 0.95).unwrap();
        sound += u32::from(between(&bounds));
        gaps.push(bounds.upper_area() - bounds.lower_area());
        let contacts: Vec<_> = curves[0].iter().map(|c| c.contact).collect();
        plain += u32::from(ShapeBounds::from_contacts(&contacts).is_ok_and(|b| between(&b)));
    }
    // At 95 % the number of failures in 200 runs is above 20 with a probability of 1e-3.
    assert!(sound >= 180, "{sound}");
    assert!(plain < 20, "{plain}");
    gaps.sort_by(f64::total_cmp);
    let size = 2.0 * std::f64::consts::PI;
    assert!(gaps[gaps.len() / 2] < 0.06 * size, "{}", gaps[gaps.len() / 2] / size);
}

#[test]
fn without_noise_the_bounds_are_those_of_exact_contacts() {
    let curves = curve(60, 0.0, &mut Source::new(1));
    let bounds = ShapeBounds::from_noisy_curves(&curves, 0.99).unwrap();
    let contacts: Vec<_> = curves[0].iter().map(|c| c.contact).collect();
    let exact = ShapeBounds::from_contacts(&contacts).unwrap();
    assert!((bounds.upper_area() - exact.upper_area()).abs() < 1e-9);
    assert!((bounds.lower_area() - exact.lower_area()).abs() < 1e-9);
}

#[test]
fn bad_noise_and_hopeless_noise_are_named() {
    let good = curve(40, 1e-3, &mut Source::new(2));
    assert_eq!(ShapeBounds::from_noisy_curves(&good, 1.0), Err(NoiseError::Confidence(1.0)));
    let mut bad = good.clone();
    bad[0][7].noise.normal = -0.1;
    assert!(matches!(
        ShapeBounds::from_noisy_curves(&bad, 0.95),
        Err(NoiseError::Noise { curve: 0, index: 7, name: "normal", .. })
    ));
    let few = vec![good[0][..2].to_vec()];
    assert!(matches!(
        ShapeBounds::from_noisy_curves(&few, 0.95),
        Err(NoiseError::Bounds(BoundsError::TooFew { found: 2, .. }))
    ));
    let wild = curve(40, 0.5, &mut Source::new(3));
    assert!(ShapeBounds::from_noisy_curves(&wild, 0.95).is_err());
}
