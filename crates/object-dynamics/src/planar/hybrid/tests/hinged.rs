//! Two frictionless lines through one hinge: the simulation in one coordinate, with its own loss of contact.

use super::*;
use crate::planar::{HarmonicPalms, PlanarStart, simulate_prescribed};
use contact_kinematics::MotionLaw;
use contact_kinematics::planar::{FourierBody, MotionPart};
use std::f64::consts::PI;

#[test]
fn two_lines_through_a_hinge_move_a_body_as_hinged_palms_do() {
    let shape = FourierBody::new(&[0.04, 0.003, 0.0045, 0.0006], &[0.0, -0.002, 0.001, -0.0008]).unwrap();
    let mass = PlanarMass::new(MASS, 2e-4).unwrap();
    let object = PlanarObject { shape: &shape, mass, gravity: G };
    let hinged = HarmonicPalms {
        centres: [0.4, 1.3],
        amplitudes: [0.25, 0.15],
        frequencies: [9.0, 7.0],
        phases: [0.3, 1.1],
    };
    let turn = |i: usize| MotionPart::Turn {
        pivot: DVec2::ZERO,
        law: MotionLaw::Sinusoid {
            mean: hinged.centres[i],
            amplitude: hinged.amplitudes[i],
            frequency: hinged.frequencies[i],
            phase: hinged.phases[i],
        },
    };
    // Palm 2 turns with palm 1 and against it; its line is seen from the other side.
    let (first, second) = (line(DVec2::ZERO, 0.0, 0.0), line(DVec2::ZERO, PI, 0.0));
    let moved = |palm: ScenePalm, parts| ScenePalm { motion: SurfaceMotion { parts, ..palm.motion }, ..palm };
    let palms = vec![moved(first, vec![turn(0)]), moved(second, vec![turn(1), turn(0)])];
    let scene = ContactScene::new(object, palms).unwrap();

    let start = PlanarStart { phi0: 0.2, omega0: 3.0 };
    let times = times(2.0, 400);
    let expected = simulate_prescribed(&object, &hinged, start, &times, 1e-13).unwrap();
    let first = expected.samples[0].truth;
    let body = BodyState { p_WCm: first.p_WCm, phi0: first.phi0, v_WCm: first.v_WCm, omega0: first.omega0 };
    let run = scene.simulate(&ContactStart { body, contacts: vec![0, 1] }, &times, 1e-13).unwrap();

    assert!(expected.samples.len() > 20);
    for (sample, s) in expected.samples.iter().zip(&run.instants) {
        let truth = sample.truth;
        assert!((s.body.p_WCm - truth.p_WCm).length() < 1e-11, "{}", s.t);
        assert!((s.body.phi0 - truth.phi0).abs() < 1e-10 && (s.body.omega0 - truth.omega0).abs() < 1e-9);
        let forces = sample.sample.forces.unwrap();
        assert!((0..2).all(|i| (s.forces[i].length() - forces[i]).abs() < 1e-9), "{}", s.t);
        assert!((s.palm_work - sample.work).abs() < 1e-11);
    }
    let lost = expected.lost.unwrap();
    let event = &run.events[0];
    assert_eq!((event.kind, event.palm), (ContactEventKind::Lifts, Some(lost.palm)));
    assert!((event.t - lost.t).abs() < 1e-10, "{} {}", event.t, lost.t);
}
