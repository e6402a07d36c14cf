use super::simulated::{Touched, TouchedBody, Touching};
use super::*;
use crate::noise::{CertainBounds, ContactNoise};
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use glam::{DQuat, DVec3};
use proptest::prelude::*;

const HOW: [Touching; 3] = [Touching::Palm, Touching::Palm, Touching::Fingertip(0.0)];

fn cube() -> TouchedBody {
    TouchedBody::cuboid(DVec3::splat(0.5), 0.0)
}

fn found(curves: &[Vec<NoisyContact>]) -> Features {
    Features::find(curves, &FeatureOptions::default()).unwrap()
}

/// Contacts by what they are (rows) and what they are told to be, the last one open.
fn confusion(touched: &Touched, features: &Features) -> [[usize; 5]; 4] {
    let mut counts = [[0; 5]; 4];
    let of = features.run_of_each(touched.curves.len());
    for (kind, run) in touched.kinds.iter().flatten().zip(of.iter().flatten()) {
        counts[*kind as usize][features.runs[*run].kind.map_or(4, |told| told as usize)] += 1;
    }
    counts
}

fn moved(curves: &[Vec<NoisyContact>], turn: DQuat, scale: f64, shift: DVec3) -> Vec<Vec<NoisyContact>> {
    let one = |c: &NoisyContact| NoisyContact {
        contact: ContactSample {
            point: turn * c.contact.point * scale + shift,
            normal: Direction::new_unchecked((turn * c.contact.normal.get()).normalize()),
        },
        noise: ContactNoise { point: c.noise.point * (scale * scale), ..c.noise },
    };
    curves.iter().map(|curve| curve.iter().map(one).collect()).collect()
}

#[test]
fn corners_and_faces_of_a_cube_and_a_wedge_are_told() {
    for (body, corners) in [(cube(), 8), (TouchedBody::wedge(1.2, 0.8, 0.5), 6)] {
        let touched = body.touched(&HOW, 150, 1e-3, 5);
        let features = found(&touched.curves);
        let told = confusion(&touched, &features);
        let all: usize = told.iter().flatten().sum();
        let right: usize = (0..4).map(|k| told[k][k]).sum();
        assert!(right as f64 > 0.95 * all as f64, "{told:?}");
        assert!((corners - 1..=corners).contains(&features.corners.len()), "{}", features.corners.len());
        assert!(features.corners.iter().all(|c| body.outside(c.point).abs() < 1e-3));
    }
}

/// A run alone tells its face worse than all runs on it do, and where it ends likewise.
#[test]
fn faces_end_where_rounded_edges_begin() {
    let mut told = [0; 5];
    let body = TouchedBody::cuboid(DVec3::new(0.5, 0.4, 0.45), 0.12);
    for seed in 0..8 {
        let touched = body.touched(&HOW, 200, 1e-2, seed);
        let of_faces = confusion(&touched, &found(&touched.curves))[FeatureKind::Face as usize];
        told = std::array::from_fn(|k| told[k] + of_faces[k]);
    }
    let all: usize = told.iter().sum();
    assert!((told[FeatureKind::Smooth as usize] as f64) < 0.045 * all as f64, "{told:?}");
}

#[test]
fn a_smooth_body_has_none() {
    for (seed, noise) in [(1, 1e-3), (2, 1e-2), (3, 0.0)] {
        let touched = TouchedBody::Ellipsoid(DVec3::new(1.0, 0.8, 0.5)).touched(&HOW, 120, noise, seed);
        assert!(found(&touched.curves).is_smooth(), "{seed}");
    }
}

/// A corner with a radius, turned about in two directions; noise of 1 % of the size.
fn rounded_corner(radius: f64, seed: u64) -> Vec<Vec<NoisyContact>> {
    let mut source = crate::generators::Source::new(seed);
    let noise = 1e-2;
    let mut curve = Vec::new();
    for k in 0..100 {
        let t = f64::from(k) * 0.12;
        let n = DVec3::new(0.4 * t.sin(), 0.4 * (1.3 * t).cos(), 1.0).normalize();
        let turned = (n + source.normal3().reject_from_normalized(n) * noise).normalize();
        let contact = ContactSample {
            point: DVec3::Z + radius * n + source.normal3() * noise,
            normal: Direction::new_unchecked(turned),
        };
        curve.push(NoisyContact { contact, noise: ContactNoise::isotropic(noise, noise) });
    }
    // The size is that of the body: another place of it.
    let far = ContactSample { point: -DVec3::Z, normal: Direction::new_unchecked(-DVec3::Z) };
    vec![curve, vec![NoisyContact { contact: far, noise: ContactNoise::isotropic(noise, noise) }]]
}

#[test]
fn a_rounding_near_what_noise_leaves_is_open_and_not_told_wrong() {
    let told = |radius: f64| {
        let kind = |seed| found(&rounded_corner(radius, seed)).runs[0].kind;
        let kinds: Vec<_> = (0..20).map(kind).collect();
        [Some(FeatureKind::Corner), Some(FeatureKind::Smooth), None]
            .map(|of| kinds.iter().filter(|k| **k == of).count())
    };
    // A radius is told to 1e-2 / (0.4 sqrt(100 / 2)), 0.0035 of the size, in each direction.
    let (sharp, round) = (told(0.0), told(0.05));
    assert!(sharp[0] >= 17 && sharp[1] == 0, "{sharp:?}");
    assert!(round[1] == 20, "{round:?}");
    let between = told(0.0106);
    assert!(between[0] <= 12, "{between:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]
    #[test]
    fn what_is_told_does_not_depend_on_axes_and_units(
        x in -1.0..1.0f64, y in -1.0..1.0f64, angle in 0.0..6.0f64, scale in -3.0..3.0f64, seed in 0..50u64,
    ) {
        let touched = cube().touched(&HOW[1..], 60, 1e-2, seed);
        let turn = DQuat::from_axis_angle(DVec3::new(x, y, 1.0).normalize(), angle);
        let other = moved(&touched.curves, turn, 10f64.powf(scale), DVec3::new(y, x, angle));
        let (a, b) = (found(&touched.curves), found(&other));
        let kinds = |of: &Features| of.runs.iter().map(|run| (run.first, run.count, run.kind)).collect::<Vec<_>>();
        prop_assert_eq!(kinds(&a), kinds(&b));
    }

    #[test]
    fn the_order_of_curves_does_not_matter(seed in 0..50u64) {
        let touched = cube().touched(&HOW[1..], 60, 1e-3, seed);
        let turned: Vec<_> = touched.curves.iter().rev().cloned().collect();
        let (a, b) = (found(&touched.curves), found(&turned));
        let told = |of: &Features, kind| of.contacts(kind);
        for kind in FeatureKind::ALL.map(Some) {
            // Groups grow in another order: at most a run goes elsewhere.
            prop_assert!(told(&a, kind).abs_diff(told(&b, kind)) <= 6, "{:?}", kind);
        }
    }
}

#[test]
fn a_corner_touched_again_is_the_same_one_and_faces_make_the_cube() {
    // Two palms that come to all eight corners.
    let of = |seed| found(&cube().touched(&[Touching::Palm; 2], 150, 1e-3, seed).curves);
    let features = (0..20).map(of).find(|features| features.corners.len() == 8).unwrap();
    assert!(features.corners.iter().any(|corner| corner.runs.len() > 1));
    assert!(features.faces.is_empty());
    let made = features.polyhedron().unwrap();
    assert!((made.volume - 1.0).abs() < 0.01, "{}", made.volume);
}

#[test]
fn bounds_hold_and_faces_make_the_upper_one_tighter() {
    let touched = cube().touched(&HOW, 200, 1e-2, 5);
    let plain = CertainBounds::from_noisy_curves(&touched.curves, 0.95).unwrap();
    let with = CertainBounds::from_features(&touched.curves, &FeatureOptions::default(), 0.95).unwrap();
    for bounds in [&plain, &with] {
        let lower = bounds.lower.as_ref().and_then(|lower| lower.solid()).unwrap();
        assert!(lower.vertices().iter().all(|v| cube().outside(*v) <= 0.0));
        let faces = bounds.upper.as_ref().unwrap().face_half_spaces();
        assert!(faces.iter().all(|h| {
            let n = h.normal.get();
            cube().support(n) <= n.dot(h.point) + h.margin
        }));
    }
    assert!(with.upper.unwrap().volume() < plain.upper.unwrap().volume());
}

#[test]
fn curves_are_cut_at_what_is_not_smooth_and_joined_again() {
    let touched = cube().touched(&HOW, 80, 1e-3, 5);
    let features = found(&touched.curves);
    let pieces = Pieces::of(&touched.curves, &features);
    assert!(pieces.curves.len() > touched.curves.len());
    assert_eq!(pieces.joined(pieces.curves.clone()), touched.curves);
}

#[test]
fn bad_input_is_named_and_nothing_gives_nothing() {
    let options = FeatureOptions { odds: 1.0 };
    assert_eq!(Features::find(&[], &options), Err(NoiseError::Odds(1.0)));
    assert_eq!(Features::find(&[], &FeatureOptions::default()), Ok(Features::default()));
    let mut touched = cube().touched(&HOW, 3, 1e-3, 1);
    // Hardly any contacts: no panic.
    let _ = found(&touched.curves);
    let _ = found(&[touched.curves[0][..1].to_vec(), vec![]]);
    touched.curves[0][1].contact.point.x = f64::NAN;
    assert!(matches!(
        Features::find(&touched.curves, &FeatureOptions::default()),
        Err(NoiseError::NotFinite { curve: 0, index: 1, .. })
    ));
}
