//! Bodies in flight: what comes and goes within one step of the integration touches them all the same.

use contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, MotionPart, PalmSurface, SurfaceMotion, SurfacePose,
};
use glam::{DQuat, DVec3};
use object_dynamics::integrate::find_root;
use object_dynamics::*;

fn scene(surface: PalmSurface, motion: SurfaceMotion) -> ContactScene<Ellipsoid> {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let (body, mass) = (Ellipsoid::new(axes).unwrap(), MassProperties::uniform_ellipsoid(0.2, axes).unwrap());
    let palm = ScenePalm { surface, drive: PalmDrive::Prescribed(motion), friction: 0.3 };
    ContactScene::new(body, mass, vec![palm], 9.81).unwrap()
}

fn start(p_WCm: DVec3, v_WCm: DVec3, w_WO: DVec3) -> ContactStart {
    let body = BodyState { p_WCm, R_WO: DQuat::IDENTITY, v_WCm, w_WO };
    ContactStart { in_flight: true, ..ContactStart::touching(body) }
}

/// The first touch and the deepest overlap, m, of a run at some tolerances.
fn touched(
    scene: &ContactScene<Ellipsoid>,
    start: &ContactStart,
    duration: f64,
) -> [(Option<ContactEvent>, f64); 3] {
    [1e-4, 1e-7, 1e-10].map(|tolerance| {
        let run = scene.simulate(start, SampleTimes { duration, rate: 5000.0 }, tolerance).unwrap();
        let gaps = run.instants.iter().map(|now| now.contacts[0].gap);
        (run.events.first().cloned(), -gaps.fold(0.0, f64::min))
    })
}

/// A body that flies up, just over a plate that is thrown up and down again under it within a fraction of what a step in flight takes.
#[test]
fn a_plate_that_comes_and_goes_within_a_step_is_touched() {
    let once = [(200.0, 0.0293, true, 0.02), (200.0, 0.0294, true, 0.02), (200.0, 0.0297, false, 0.02)];
    // Every 2 ms: the body is above its highest place for 20 ms.
    let often = [(3000.0, 0.0301, true, 0.03), (3000.0, 0.0301, false, 0.02), (3000.0, 0.0294, true, 0.02)];
    for (frequency, height, touches, duration) in once.into_iter().chain(often) {
        let pose = SurfacePose::new(DVec3::new(0.0, 0.0, -0.01), DQuat::IDENTITY).unwrap();
        let law = MotionLaw::Sinusoid { mean: 0.0, amplitude: 0.01, frequency, phase: 0.0 };
        let direction = Direction::new(DVec3::Z).unwrap();
        let parts = vec![MotionPart::Shift { direction, law }];
        let scene = scene(PalmSurface::Plane, SurfaceMotion::Parts { pose, parts });
        let start = start(DVec3::new(0.0, 0.0, height), DVec3::new(0.0, 0.0, 0.098), DVec3::ZERO);
        let runs = touched(&scene, &start, duration);
        for (event, overlap) in &runs {
            assert_eq!(event.is_some(), touches, "{height}: {runs:?}");
            assert!(*overlap < 1e-6, "{height}: {runs:?}");
        }
        let when = runs.map(|(event, _)| event.map_or(0.0, |event| event.t));
        assert!((when[1] - when[2]).abs() < 1e-7, "{height}: {when:?}");
    }
}

/// A corner of a body that spins passes a plate once in half a turn.
#[test]
fn a_spinning_body_touches_with_its_ends() {
    let pose = SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).unwrap();
    let scene = scene(PalmSurface::Plane, SurfaceMotion::immobile(pose));
    let runs = touched(&scene, &start(DVec3::new(0.0, 0.0, 0.049), DVec3::ZERO, 40.0 * DVec3::Y), 0.03);
    // About its second axis; in closed form.
    let gap = |t: f64| {
        let (sin, cos) = (40.0 * t).sin_cos();
        0.049 - 0.5 * 9.81 * t * t - (0.05 * sin).hypot(0.03 * cos)
    };
    let expected = find_root(gap, 0.0, 0.03, 1e-15).unwrap();
    for (event, overlap) in &runs {
        let t = event.as_ref().map_or(f64::NAN, |event| event.t);
        assert!((t - expected).abs() < 1e-6 && *overlap < 1e-6, "{expected}: {runs:?}");
    }
}

/// A body that flies past a fingertip in a straight line, without spin, grazes it or does not.
#[test]
fn a_fingertip_that_is_passed_is_grazed() {
    for (aside, touches) in [(0.0448, true), (0.0452, false)] {
        let pose = SurfacePose::new(DVec3::new(0.0, aside, 0.0), DQuat::IDENTITY).unwrap();
        let tip = scene(PalmSurface::Sphere { radius: 0.005 }, SurfaceMotion::immobile(pose));
        // Half of the way up and down again lies about the tip: it is passed at the top of the flight, sideways.
        let start = start(DVec3::new(-0.4, 0.0, 0.0), DVec3::new(4.0, 0.0, 0.981), DVec3::ZERO);
        let start = ContactStart {
            body: BodyState { p_WCm: start.body.p_WCm - DVec3::Z * 0.04905, ..start.body },
            ..start
        };
        let runs = touched(&tip, &start, 0.2);
        for (event, overlap) in &runs {
            assert_eq!(event.is_some(), touches, "{aside}: {runs:?}");
            assert!(*overlap < 1e-6, "{aside}: {runs:?}");
        }
    }
}
