use super::*;
use crate::generators::{AXES, ellipsoid_support, noisy_curves};
use crate::halfspaces::Intersection;

/// Bounds of one simulated noisy run, at noise relative to the ellipsoid's largest semi-axis.
fn run(count: usize, level: f64, confidence: f64, seed: u64) -> Result<ShapeBounds, NoiseError> {
    let (point, normal) = (level * AXES.x, level);
    let curves: Vec<Vec<NoisyContact>> = noisy_curves(count, point, normal, seed)
        .into_iter()
        .map(|curve| {
            let noise = ContactNoise::isotropic(point, normal);
            curve.into_iter().map(|contact| NoisyContact { contact, noise }).collect()
        })
        .collect();
    ShapeBounds::from_noisy_curves(&curves, confidence)
}

/// Whether the true ellipsoid lies between the bounds; exact for it, but for rounding.
fn holds(bounds: &ShapeBounds) -> bool {
    let inside = bounds.lower().solid().unwrap().vertices().iter().all(|v| (*v / AXES).length() <= 1.0);
    let Intersection::Bounded(upper) = bounds.upper() else { return false };
    let around = upper
        .face_half_spaces()
        .iter()
        .all(|h| ellipsoid_support(h.normal.get()) <= h.normal.get().dot(h.point) + h.margin);
    inside && around
}

#[test]
fn bounds_hold_under_noise_where_plain_ones_fail() {
    let mut plain_failures = 0;
    for seed in 0..30 {
        let bounds = run(300, 1e-3, 0.95, seed).unwrap();
        assert!(holds(&bounds), "seed {seed}");
        let plain: Vec<_> = noisy_curves(300, 2.5e-3, 1e-3, seed).concat();
        let plain = ShapeBounds::from_contacts(&plain).unwrap();
        plain_failures += usize::from(!holds(&plain));
    }
    assert_eq!(plain_failures, 30);
}

#[test]
fn without_noise_the_bounds_are_the_plain_ones() {
    let noisy = run(150, 0.0, 0.99, 3).unwrap();
    let plain = ShapeBounds::from_contacts(&noisy_curves(150, 0.0, 0.0, 3).concat()).unwrap();
    assert!((noisy.upper_volume() / plain.upper_volume() - 1.0).abs() < 1e-12);
    assert!((noisy.lower_volume() / plain.lower_volume() - 1.0).abs() < 1e-12);
}

#[test]
fn averages_tighten_the_bounds() {
    // The same contacts without their order along the curve: each stands alone in its curve.
    let noise = ContactNoise::isotropic(2.5e-3, 1e-3);
    let ordered: Vec<Vec<NoisyContact>> = noisy_curves(600, 2.5e-3, 1e-3, 1)
        .into_iter()
        .map(|curve| curve.into_iter().map(|contact| NoisyContact { contact, noise }).collect())
        .collect();
    let single: Vec<Vec<NoisyContact>> = ordered.iter().flatten().map(|c| vec![*c]).collect();
    let gap = |curves: &[Vec<NoisyContact>]| {
        let bounds = ShapeBounds::from_noisy_curves(curves, 0.95).unwrap();
        bounds.upper_volume() - bounds.lower_volume()
    };
    let clean = ShapeBounds::from_contacts(&noisy_curves(600, 0.0, 0.0, 1).concat()).unwrap();
    let clean = clean.upper_volume() - clean.lower_volume();
    let (with, without) = (gap(&ordered) - clean, gap(&single) - clean);
    assert!(0.0 < with && with < 0.8 * without, "{with} {without}");
}

#[test]
fn more_noise_gives_wider_bounds_and_too_much_gives_an_error() {
    let gap = |level| run(300, level, 0.95, 5).map(|b| b.upper_volume() - b.lower_volume()).unwrap();
    let gaps = [0.0, 1e-4, 1e-3, 1e-2].map(gap);
    assert!(gaps.windows(2).all(|w| w[0] < w[1]), "{gaps:?}");
    assert!(matches!(
        run(300, 0.5, 0.95, 5),
        Err(NoiseError::NoLowerBound | NoiseError::NoUpperBound { .. })
    ));
}

#[test]
fn impossible_noise_and_confidence_are_named() {
    assert_eq!(run(30, 0.0, 1.0, 1), Err(NoiseError::Confidence(1.0)));
    let mut curves: Vec<Vec<NoisyContact>> = vec![
        noisy_curves(30, 0.0, 0.0, 1)
            .concat()
            .into_iter()
            .map(|contact| NoisyContact { contact, noise: ContactNoise::isotropic(1e-3, 1e-3) })
            .collect(),
    ];
    curves[0][4].noise.normal = -1.0;
    let error = ShapeBounds::from_noisy_curves(&curves, 0.9).unwrap_err();
    assert!(matches!(error, NoiseError::Noise { curve: 0, index: 4, name: "normal", .. }));
    curves[0][4].noise = ContactNoise::isotropic(1e-3, 1e-3);
    curves[0][5].noise.point.x_axis.y = 1.0;
    let error = ShapeBounds::from_noisy_curves(&curves, 0.9).unwrap_err();
    assert!(matches!(error, NoiseError::Noise { curve: 0, index: 5, name: "point", .. }));
}
