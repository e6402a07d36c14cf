//! What cannot be simulated is named, with the number that is wrong.

use super::*;
use crate::FrictionError;
use crate::integrate::IntegrationError;
use crate::planar::ContactSceneError;
use contact_kinematics::planar::{Ellipse, SurfaceError};

fn body() -> Ellipse {
    Ellipse::new(0.05, 0.04, DVec2::ZERO).unwrap()
}

fn build(palms: Vec<ScenePalm>, gravity: f64) -> Result<ContactScene<Ellipse>, ContactSceneError> {
    let mass = PlanarMass::new(MASS, 3e-4).unwrap();
    ContactScene::new(PlanarObject { shape: body(), mass, gravity }, palms)
}

fn floor() -> ScenePalm {
    line(DVec2::ZERO, 0.0, 0.3)
}

#[test]
fn bad_scenes_are_named() {
    let rough = |friction| build(vec![floor(), ScenePalm { friction, ..floor() }], G).unwrap_err();
    let source = FrictionError { value: -0.1 };
    assert_eq!(rough(-0.1), ContactSceneError::Friction { palm: 2, source });
    assert!(matches!(rough(f64::NAN), ContactSceneError::Friction { palm: 2, .. }));
    let cup = immobile(PalmSurface::Cup { radius: 0.06 }, DVec2::ZERO, 0.0, 0.3);
    // 0.05^2 / 0.04.
    let error = build(vec![cup], G).unwrap_err();
    let ContactSceneError::Surface { palm: 1, source } = error else { panic!("{error}") };
    let SurfaceError::CupTooSmall { radius: 0.06, largest } = source else { panic!("{source}") };
    assert!((largest - 0.0625).abs() < 1e-16);
    assert_eq!(build(vec![], G).unwrap_err(), ContactSceneError::PalmCount { found: 0 });
    assert_eq!(build(vec![floor(); 6], G).unwrap_err(), ContactSceneError::PalmCount { found: 6 });
    assert_eq!(build(vec![floor()], -1.0).unwrap_err(), ContactSceneError::Gravity { value: -1.0 });
    let lost = SurfacePose { p_WP: DVec2::new(f64::INFINITY, 0.0), angle: 0.0 };
    let palm = ScenePalm { motion: SurfaceMotion::immobile(lost), ..floor() };
    assert!(matches!(build(vec![palm], G), Err(ContactSceneError::Surface { palm: 1, .. })));
}

#[test]
fn bad_starts_are_named() {
    let scene = build(vec![floor()], G).unwrap();
    let start = |state, contacts: &[usize]| {
        let start = ContactStart { body: state, contacts: contacts.to_vec() };
        match scene.simulate(&start, &[0.0, 0.1], 1e-10) {
            Err(ContactSimulationError::Start(error)) => error,
            other => panic!("{other:?}"),
        }
    };
    assert!(matches!(
        start(at(0.0, 0.039), &[]),
        StartError::Penetration { palm: 1, gap } if (gap + 1e-3).abs() < 1e-15
    ));
    assert!(matches!(
        start(at(0.0, 0.041), &[0]),
        StartError::NotInContact { palm: 1, gap } if (gap - 1e-3).abs() < 1e-15
    ));
    let rising = BodyState { v_WCm: DVec2::new(0.3, 0.1), ..at(0.0, 0.04) };
    assert_eq!(start(rising, &[0]), StartError::NotAlong { palm: 1, rate: 0.1 });
    assert_eq!(start(at(0.0, 0.04), &[1]), StartError::NoPalm { palm: 2, count: 1 });
    assert_eq!(start(at(f64::NAN, 0.04), &[0]), StartError::NotFinite);
    assert_eq!(start(BodyState { omega0: f64::NAN, ..at(0.0, 0.04) }, &[]), StartError::NotFinite);
}

#[test]
fn palms_that_overlap_are_named() {
    let tip = |x, y| immobile(PalmSurface::Arc { radius: 0.02 }, DVec2::new(x, y), 0.0, 0.3);
    let cup = immobile(PalmSurface::Cup { radius: 0.2 }, DVec2::ZERO, 0.0, 0.3);
    let start = ContactStart { body: at(0.0, 0.05), contacts: vec![] };
    for (palms, expected) in [
        (vec![tip(0.1, 0.1), tip(0.13, 0.1)], 0.01),
        (vec![tip(0.1, 0.015), floor()], 0.005),
        (vec![cup, tip(0.0, -0.19)], 0.01),
    ] {
        let error = build(palms, G).unwrap().simulate(&start, &[0.0, 0.1], 1e-10).unwrap_err();
        let ContactSimulationError::PalmsOverlap { first: 1, second: 2, depth } = error else {
            panic!("{error}")
        };
        assert!((depth - expected).abs() < 1e-15, "{depth}");
    }
}

#[test]
fn palms_that_are_one_and_motion_too_fast_to_follow_are_named() {
    let cup = immobile(PalmSurface::Cup { radius: 0.2 }, DVec2::ZERO, 0.0, 0.3);
    let start = ContactStart { body: at(0.0, 0.05), contacts: vec![] };
    let along = line(DVec2::new(3.0, 0.0), std::f64::consts::TAU, 0.3);
    for (palms, kind) in [(vec![floor(), along], "line"), (vec![cup.clone(), cup], "cup")] {
        let error = build(palms, G).unwrap().simulate(&start, &[0.0, 0.1], 1e-10).unwrap_err();
        assert_eq!(error, ContactSimulationError::PalmsCoincide { first: 1, second: 2, kind });
    }
    let scene = build(vec![floor()], G).unwrap();
    let body = BodyState { omega0: 3e5, ..start.body };
    let error = scene.simulate(&ContactStart { body, ..start }, &[0.0, 10.0], 1e-10).unwrap_err();
    assert!(matches!(error, ContactSimulationError::TooSlow { spin, .. } if spin > 1e4), "{error}");
}

#[test]
fn a_body_is_placed_where_there_is_room() {
    let ceiling = |height: f64| line(DVec2::new(0.0, height), std::f64::consts::PI, 0.3);
    let guess = BodyState { phi0: 0.3, v_WCm: DVec2::new(0.2, 0.1), ..at(0.0, 0.05) };
    // Between 0.08 and 0.1 m it turns until it fits; below there is no room.
    let scene = build(vec![floor(), ceiling(0.09)], G).unwrap();
    let placed = scene.place(0.0, guess, &[0, 1]).unwrap();
    assert!(placed.v_WCm.y.abs() < 1e-2 && placed.phi0 != 0.3);
    let start = ContactStart { body: placed, contacts: vec![0, 1] };
    assert!(scene.simulate(&start, &[0.0, 1e-3], 1e-10).is_ok());
    for palms in [&[0, 1][..], &[0][..]] {
        let scene = build(vec![floor(), ceiling(0.07)], G).unwrap();
        let error = scene.place(0.0, guess, palms).unwrap_err();
        assert!(matches!(error, StartError::NoRoom { gap, .. } if gap < -4e-3), "{error}");
    }
}

#[test]
fn bad_times_and_tolerances_are_named() {
    let scene = build(vec![floor()], G).unwrap();
    let start = ContactStart { body: at(0.0, 0.04), contacts: vec![0] };
    for (times, index) in [(&[][..], 0), (&[0.0, 0.0][..], 1), (&[0.0, 0.1, f64::NAN][..], 2)] {
        let error = scene.simulate(&start, times, 1e-10).unwrap_err();
        assert!(matches!(error, ContactSimulationError::Times { index: i, .. } if i == index), "{error}");
    }
    let error = scene.simulate(&start, &[0.0, 1.0], 0.0).unwrap_err();
    assert!(
        matches!(error, ContactSimulationError::Integration(IntegrationError::Tolerance { .. })),
        "{error}"
    );
}
