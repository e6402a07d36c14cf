//! Palms that move: their work, and what sticks to them.

use super::*;
use contact_kinematics::MotionLaw;
use contact_kinematics::planar::{Circle, Ellipse, MotionPart, RoundedPolygon};

fn moved(palm: ScenePalm, part: MotionPart) -> ScenePalm {
    let motion = SurfaceMotion { parts: vec![part], ..palm.motion };
    ScenePalm { motion, ..palm }
}

#[test]
fn a_belt_takes_a_disc_along() {
    let (radius, mu, belt) = (0.05, 0.3, 0.8);
    let law = MotionLaw::Steady { start: 0.0, rate: belt };
    let palm = moved(line(DVec2::ZERO, 0.0, mu), MotionPart::Shift { direction: 0.0, law });
    let scene = scene(Circle::new(radius, DVec2::ZERO).unwrap(), 0.5 * MASS * radius * radius, vec![palm]);
    let start = ContactStart { body: at(0.0, radius), contacts: vec![0] };
    let run = scene.simulate(&start, &times(1.0, 20), 1e-12).unwrap();
    // The slip falls at 3 mu g; the disc rolls at a third of the belt's speed.
    let until = belt / (3.0 * mu * G);
    assert!((run.events[0].t - until).abs() < 1e-12 && run.events.len() == 1, "{:?}", run.events);
    let last = run.instants.last().unwrap();
    assert!((last.body.v_WCm.x - belt / 3.0).abs() < 1e-12);
    assert!((last.palm_work - mu * MASS * G * belt * until).abs() < 1e-12, "{}", last.palm_work);
    assert!((last.friction_work + 0.5 * mu * MASS * G * belt * until).abs() < 1e-12);
    // In the log the impulse of the weight and the forces is the momentum, and the contact lies below the centre.
    let log = run.log(&scene).unwrap();
    for (sample, truth) in log.samples().iter().zip(log.truth().unwrap()) {
        let [palm] = sample.palms[..] else { panic!("{sample:?}") };
        assert!((palm.p_WC.unwrap() - truth.p_WCm + DVec2::new(0.0, radius)).length() < 1e-12);
        assert!((palm.pose.p_WP.x - belt * sample.t).abs() < 1e-15);
        let weight = DVec2::new(0.0, MASS * G * sample.t);
        assert!((palm.impulse.unwrap() - MASS * truth.v_WCm - weight).length() < 1e-12);
        let along = if sample.t < until { mu * MASS * G } else { 0.0 };
        assert!((palm.force - DVec2::new(along, MASS * G)).length() < 1e-12);
    }
    check_run(&scene, &run);
}

#[test]
fn a_frictionless_wedge_that_swings_keeps_its_energy_balance_for_ten_seconds() {
    let swing = |amplitude, frequency| MotionLaw::Sinusoid { mean: 0.0, amplitude, frequency, phase: 0.0 };
    let palms = [(-0.7, swing(0.05, 7.0)), (0.6, swing(0.1, 5.0))].map(|(angle, law)| {
        moved(line(DVec2::ZERO, angle, 0.0), MotionPart::Turn { pivot: DVec2::ZERO, law })
    });
    let scene = scene(Ellipse::new(0.05, 0.042, DVec2::new(0.002, 0.0)).unwrap(), 3e-4, palms.to_vec());
    let state = scene.place(0.0, BodyState { phi0: 0.5, ..at(0.0, 0.06) }, &[0, 1]).unwrap();
    let run = scene
        .simulate(&ContactStart { body: state, contacts: vec![0, 1] }, &times(10.0, 200), 1e-12)
        .unwrap();
    assert!(
        run.instants.iter().any(|s| s.palm_work.abs() > 1e-3) && run.events.is_empty(),
        "{:?}",
        run.events
    );
    check_run(&scene, &run);
}

/// A body at rest in a wedge; its palms turn about the hinge by `heights` from 0.1 s on, within a second.
fn wedge(heights: [f64; 2], mu: f64) -> (ContactScene<Ellipse>, ContactStart) {
    let palms = [(-0.6, heights[0]), (0.5, heights[1])].map(|(angle, height)| {
        let law = MotionLaw::Ramp { height, start: 0.1, duration: 1.0 };
        moved(line(DVec2::ZERO, angle, mu), MotionPart::Turn { pivot: DVec2::ZERO, law })
    });
    let scene = scene(Ellipse::new(0.05, 0.045, DVec2::ZERO).unwrap(), 3e-4, palms.to_vec());
    let state = scene.place(0.0, BodyState { phi0: 0.2, ..at(0.0, 0.06) }, &[0, 1]).unwrap();
    (scene, ContactStart { body: state, contacts: vec![0, 1] })
}

#[test]
fn a_wedge_that_turns_carries_its_body_until_no_squeeze_holds_it() {
    let (scene, start) = wedge([1.1, 1.1], 0.5);
    let run = scene.simulate(&start, &times(1.2, 120), 1e-11).unwrap();
    assert_eq!(run.instants[0].modes, [ContactMode::Stick; 2]);
    assert_eq!(run.events[0].kind, ContactEventKind::SqueezeEnds, "{:?}", run.events);
    let carried = run.instants.iter().filter(|s| s.t < run.events[0].t);
    let in_palm = |s: &ContactInstant| s.palms[0].to_palm(s.body.p_WCm);
    let mut count = 0;
    for s in carried {
        assert!((in_palm(s) - in_palm(&run.instants[0])).length() < 1e-12, "{}", s.t);
        count += 1;
    }
    assert!(count > 40, "{count}");
    check_run(&scene, &run);
}

#[test]
fn palms_that_part_end_the_sticking_at_once() {
    let (scene, start) = wedge([0.4, 0.0], 0.5);
    let run = scene.simulate(&start, &times(1.2, 60), 1e-11).unwrap();
    let event = &run.events[0];
    // The ramp's acceleration reaches 1e-9 of gravity a little after its begin.
    assert!(event.kind == ContactEventKind::SqueezeEnds && (0.1..0.101).contains(&event.t), "{event:?}");
    check_run(&scene, &run);
}

#[test]
fn a_spinning_rounded_square_leaves_the_floor_where_an_edge_ends() {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec2::new(x, y) * 0.035);
    let (rounding, bulge) = (0.005, 0.6);
    let shape = RoundedPolygon::new(&corners, rounding, bulge).unwrap();
    let scene = scene(&shape, 4e-4, vec![line(DVec2::ZERO, 0.0, 0.0)]);
    for spin in 40..60 {
        let guess = BodyState { omega0: f64::from(spin), ..at(0.0, 0.05) };
        let body = scene.place(0.0, guess, &[0]).unwrap();
        let run = scene.simulate(&ContactStart { body, contacts: vec![0] }, &times(0.1, 100), 1e-12).unwrap();
        // Over an edge it is carried, rho > r; over a corner (rho - r) omega^2 is below -g. The radius of curvature
        // jumps, and so does the force, to below zero.
        let first = &run.events[0];
        assert_eq!(first.kind, ContactEventKind::Lifts);
        let before = run.instants.iter().rfind(|s| s.t < first.t).unwrap();
        assert!(before.forces[0].y > MASS * G && before.body.phi0 < bulge, "{before:?}");
        let after = run.instants.iter().find(|s| s.t > first.t).unwrap();
        assert!(after.body.phi0 > bulge && after.contacts[0].gap > 0.0);
        check_run(&scene, &run);
    }
}

#[test]
fn the_order_of_the_integrator_survives_a_located_event() {
    // An egg that spins on the floor slides until it rolls: error against steps, from one tolerance to the next.
    let egg = Ellipse::new(0.05, 0.045, DVec2::new(0.004, 0.0)).unwrap();
    let scene = scene(egg, 3e-4, vec![line(DVec2::ZERO, 0.0, 0.3)]);
    let body = scene.place(0.0, BodyState { omega0: -20.0, ..at(0.0, 0.05) }, &[0]).unwrap();
    let start = ContactStart { body, contacts: vec![0] };
    let end = |tolerance: f64| {
        let run = scene.simulate(&start, &[0.0, 0.8], tolerance).unwrap();
        let kinds: Vec<_> = run.events.iter().map(|e| e.kind).collect();
        assert_eq!(kinds, [ContactEventKind::SlipEnds]);
        (run.statistics.accepted as f64, run.instants[1].body)
    };
    let (_, exact) = end(1e-14);
    let [coarse, fine] = [1e-5, 1e-10].map(|tolerance| {
        let (steps, body) = end(tolerance);
        (steps, (body.p_WCm - exact.p_WCm).length() + 0.05 * (body.phi0 - exact.phi0).abs())
    });
    let order = (coarse.1 / fine.1).ln() / (fine.0 / coarse.0).ln();
    assert!(fine.0 > 2.0 * coarse.0 && (6.5..10.0).contains(&order), "{order} {coarse:?} {fine:?}");
}

/// A body that spins above a plate that shakes 50 times as often as a step of a quarter of its size in flight: one of two in 400 drawn motions in
/// which the plate was passed by.
#[test]
fn a_plate_that_comes_and_goes_within_a_step_is_touched() {
    let (amplitude, frequency, phase) =
        (0.002_509_590_041_151_513_5, 4_989.879_790_291_279, 3.458_107_680_469_344_5);
    let law = MotionLaw::Sinusoid { mean: 0.0, amplitude, frequency, phase };
    let up = MotionPart::Shift { direction: std::f64::consts::FRAC_PI_2, law };
    let palm = moved(line(DVec2::ZERO, 0.175_440_630_191_603_7, 0.3), up);
    let scene = scene(Ellipse::new(0.05, 0.03, DVec2::ZERO).unwrap(), 3e-4, vec![palm]);
    let body = BodyState {
        v_WCm: DVec2::new(0.084_845_437_285_609_59, 0.088_599_303_260_039_23),
        omega0: -2.141_478_437_832_76,
        phi0: 2.638_280_855_298_578_6,
        ..at(0.008_389_163_543_325_489, 0.063_011_785_308_829_74)
    };
    let start = ContactStart { body, contacts: Vec::new() };
    let run = scene.simulate(&start, &times(0.1, 2000), 1e-5).unwrap();
    assert!(!run.events.is_empty());
    check_run(&scene, &run);
}
