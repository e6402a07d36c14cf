//! Discs, where everything has a closed form.

use super::*;
use contact_kinematics::planar::Circle;
use std::f64::consts::FRAC_PI_2;

const R: f64 = 0.05;

/// A uniform disc.
fn disc(palms: Vec<ScenePalm>) -> ContactScene<Circle> {
    scene(Circle::new(R, DVec2::ZERO).unwrap(), 0.5 * MASS * R * R, palms)
}

#[test]
fn a_disc_rolls_or_slides_down_an_incline() {
    let slope: f64 = 0.4;
    // A uniform disc rolls where mu exceeds tan(slope) / 3 = 0.1409.
    let sliding = |mu: f64| G * (slope.sin() - mu * slope.cos());
    for (mu, a) in [(0.5, 2.0 / 3.0 * G * slope.sin()), (0.1, sliding(0.1)), (0.0, sliding(0.0))] {
        let scene = disc(vec![line(DVec2::ZERO, slope, mu)]);
        let state = scene.place(0.0, at(0.0, 0.06), &[0]).unwrap();
        let run = scene
            .simulate(&ContactStart { body: state, contacts: vec![0] }, &times(10.0, 20), 1e-12)
            .unwrap();
        assert_eq!(run.events.len(), 0);
        for s in &run.instants {
            let down = (state.p_WCm - s.body.p_WCm).dot(DVec2::from_angle(slope));
            let expected = 0.5 * a * s.t * s.t;
            assert!((down - expected).abs() < 1e-10 * (1.0 + expected), "{mu} {}: {down} {expected}", s.t);
        }
        check_run(&scene, &run);
    }
}

#[test]
fn a_spinning_disc_slides_until_it_rolls() {
    let (mu, spin) = (0.2, 60.0);
    let scene = disc(vec![line(DVec2::ZERO, 0.0, mu)]);
    let state = BodyState { omega0: -spin, ..at(0.0, R) };
    let run =
        scene.simulate(&ContactStart { body: state, contacts: vec![0] }, &times(10.0, 50), 1e-12).unwrap();
    // v = mu g t, R omega = R spin - 2 mu g t.
    let (until, speed) = (spin * R / (3.0 * mu * G), spin * R / 3.0);
    let event = &run.events[0];
    assert_eq!((run.events.len(), event.kind), (1, ContactEventKind::SlipEnds));
    assert!((event.t - until).abs() < 1e-10 && event.modes == [ContactMode::Stick], "{event:?} {until}");
    for s in &run.instants {
        let (v, x) = if s.t < until {
            (mu * G * s.t, 0.5 * mu * G * s.t * s.t)
        } else {
            (speed, 0.5 * speed * until + speed * (s.t - until))
        };
        assert!(
            (s.body.v_WCm.x - v).abs() < 1e-10 && (s.body.p_WCm.x - x).abs() < 1e-10 * (1.0 + x),
            "{s:?}"
        );
    }
    // Two thirds of the energy of spin are lost.
    let lost = run.instants.last().unwrap().friction_work;
    assert!((lost + 2.0 / 3.0 * 0.25 * MASS * R * R * spin * spin).abs() < 1e-12, "{lost}");
    check_run(&scene, &run);
}

#[test]
fn a_disc_thrown_up_an_incline_stops_its_slip_and_comes_back_rolling() {
    let (slope, mu, v0): (f64, f64, f64) = (0.3, 0.25, 1.5);
    let scene = disc(vec![line(DVec2::ZERO, slope, mu)]);
    let up = DVec2::from_angle(slope);
    let n = up.perp();
    let state = BodyState { p_WCm: n * R, v_WCm: up * v0, ..BodyState::default() };
    let run =
        scene.simulate(&ContactStart { body: state, contacts: vec![0] }, &times(2.0, 40), 1e-12).unwrap();
    // Sliding up: v falls at g (sin + mu cos), R omega (clockwise) grows at 2 mu g cos.
    let (a, b) = (G * (slope.sin() + mu * slope.cos()), 2.0 * mu * G * slope.cos());
    let until = v0 / (a + b);
    let v1 = v0 - a * until;
    assert!((run.events[0].t - until).abs() < 1e-12, "{:?}", run.events);
    let last = run.instants.last().unwrap();
    let expected = v1 - 2.0 / 3.0 * G * slope.sin() * (last.t - until);
    assert!((last.body.v_WCm.dot(up) - expected).abs() < 1e-11 && run.events.len() == 1);
    check_run(&scene, &run);
}

/// Complete elliptic integral of the first kind by the arithmetic-geometric mean.
fn complete_elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    FRAC_PI_2 / a
}

#[test]
fn a_disc_rolls_in_a_cup_as_a_pendulum() {
    // (C - R) angle'' = -2/3 g sin(angle) for a cup of radius C: a pendulum.
    let (cup, start): (f64, f64) = (0.2, 1.0);
    let arm = cup - R;
    let palm = immobile(PalmSurface::Cup { radius: cup }, DVec2::new(0.1, 0.3), 0.4, 0.9);
    let scene = disc(vec![palm]);
    let centre = DVec2::new(0.1, 0.3);
    let state =
        BodyState { p_WCm: centre + arm * DVec2::new(start.sin(), -start.cos()), ..BodyState::default() };
    let period = 4.0 * (1.5 * arm / G).sqrt() * complete_elliptic((0.5 * start).sin());
    let at = [0.0, 0.25 * period, 0.5 * period, 10.0 * period];
    let run = scene.simulate(&ContactStart { body: state, contacts: vec![0] }, &at, 1e-13).unwrap();
    let angle = |s: &ContactInstant| {
        let arm = s.body.p_WCm - centre;
        arm.x.atan2(-arm.y)
    };
    for (s, expected) in run.instants.iter().zip([start, 0.0, -start, start]) {
        assert!((angle(s) - expected).abs() < 1e-10, "{} {expected}", angle(s));
    }
    assert_eq!(run.events.len(), 0);
    check_run(&scene, &run);
}

#[test]
fn a_disc_leaves_a_fingertip_where_it_must() {
    // From rest near the top of a frictionless disc: contact is lost at cos = 2/3 cos(start).
    let (tip, start): (f64, f64) = (0.03, 0.1);
    let scene = disc(vec![immobile(PalmSurface::Arc { radius: tip }, DVec2::ZERO, 0.0, 0.0)]);
    let arm = tip + R;
    let state = BodyState { p_WCm: arm * DVec2::new(start.sin(), start.cos()), ..BodyState::default() };
    let run =
        scene.simulate(&ContactStart { body: state, contacts: vec![0] }, &times(0.6, 60), 1e-13).unwrap();
    assert_eq!(run.events[0].kind, ContactEventKind::Lifts);
    let off = run.instants.iter().find(|s| s.modes[0] == ContactMode::Off).unwrap();
    // In flight energy and horizontal speed are those of the point of loss.
    let cos = 2.0 / 3.0 * start.cos();
    let speed = (G * arm * cos).sqrt();
    assert!((off.body.v_WCm.x - speed * cos).abs() < 1e-11, "{} {}", off.body.v_WCm.x, speed * cos);
    check_run(&scene, &run);
}

#[test]
fn a_falling_disc_is_stopped_by_an_inelastic_blow() {
    let (height, spin) = (0.3, -25.0);
    let fall: f64 = (2.0 * height / G).sqrt();
    let hit = G * fall;
    // The impulse of friction that stops the slip is m R |spin| / 3; the cone allows mu m hit.
    for mu in [0.5, 0.1] {
        let scene = disc(vec![line(DVec2::ZERO, 0.0, mu)]);
        let state = BodyState { omega0: spin, ..at(0.0, R + height) };
        let run =
            scene.simulate(&ContactStart { body: state, contacts: vec![] }, &times(0.5, 50), 1e-12).unwrap();
        let blow = &run.events[0];
        assert!((blow.t - fall).abs() < 1e-11 && blow.kind == ContactEventKind::Touches, "{blow:?}");
        let after = run.instants.iter().find(|s| s.t > fall).unwrap();
        let kick = (mu * hit).min(R * spin.abs() / 3.0);
        let slides = kick == mu * hit;
        assert_eq!(slides, after.modes[0] != ContactMode::Stick);
        let expected = kick + if slides { mu * G * (after.t - fall) } else { 0.0 };
        assert!((after.body.v_WCm.x - expected).abs() < 1e-11, "{mu}: {} {expected}", after.body.v_WCm.x);
        assert!(after.body.v_WCm.y.abs() < 1e-15);
        check_run(&scene, &run);
    }
}

#[test]
fn a_disc_held_in_a_wedge_by_friction_does_not_creep() {
    // On one wall alone it would roll; between both it stays, for ever, to the last bit.
    let palms = vec![line(DVec2::ZERO, -0.3, 0.5), line(DVec2::ZERO, 0.7, 0.5)];
    let scene = disc(palms);
    let state = scene.place(0.0, at(0.01, 0.06), &[0, 1]).unwrap();
    let run =
        scene.simulate(&ContactStart { body: state, contacts: vec![0, 1] }, &times(10.0, 10), 1e-10).unwrap();
    assert_eq!(run.events.len(), 0, "{:?}", run.events);
    assert!(run.instants.iter().all(|s| s.body == run.instants[0].body));
    check_run(&scene, &run);
}
