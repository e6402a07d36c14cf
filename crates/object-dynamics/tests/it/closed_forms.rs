//! Motions with friction whose solution is known in closed form.

use contact_kinematics::{PalmSurface, Sphere, SurfaceMotion, SurfacePose};
use glam::{DQuat, DVec3};
use object_dynamics::integrate::{Dop853, Tolerance};
use object_dynamics::{
    BodyState, ContactEventKind, ContactInstant, ContactMode, ContactScene, ContactSimulation, ContactStart,
    MassProperties, PalmDrive, SampleTimes, ScenePalm,
};

const G: f64 = 9.81;
const RADIUS: f64 = 0.04;
const TOLERANCE: f64 = 1e-13;

fn palm(surface: PalmSurface, p_WP: DVec3, z: DVec3, friction: f64) -> ScenePalm {
    let pose = SurfacePose::new(p_WP, DQuat::from_rotation_arc(DVec3::Z, z)).unwrap();
    ScenePalm { surface, drive: PalmDrive::Prescribed(SurfaceMotion::immobile(pose)), friction }
}

/// A ball whose moment of inertia is `share` of `m r^2`, on one palm.
fn ball(share: f64, palm: ScenePalm) -> ContactScene<Sphere> {
    let (mass, body) = (0.3, Sphere::new(RADIUS).unwrap());
    let inertia = MassProperties::from_principal(mass, DVec3::splat(share * mass * RADIUS * RADIUS)).unwrap();
    ContactScene::new(body, inertia, vec![palm], G).unwrap()
}

fn run(scene: &ContactScene<Sphere>, body: BodyState, duration: f64) -> ContactSimulation {
    let times = SampleTimes { duration, rate: 50.0 };
    scene.simulate(&ContactStart::touching(body), times, TOLERANCE).unwrap()
}

fn last(simulation: &ContactSimulation) -> &ContactInstant {
    simulation.instants.last().unwrap()
}

/// An inclined plane that falls towards x, and the direction down it.
fn incline(angle: f64, friction: f64) -> (ScenePalm, DVec3, DVec3) {
    let normal = DVec3::new(angle.sin(), 0.0, angle.cos());
    (
        palm(PalmSurface::Plane, DVec3::ZERO, normal, friction),
        normal,
        DVec3::new(angle.cos(), 0.0, -angle.sin()),
    )
}

fn resting(normal: DVec3) -> BodyState {
    BodyState { p_WCm: RADIUS * normal, R_WO: DQuat::IDENTITY, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO }
}

fn energy_is_balanced(scene: &ContactScene<Sphere>, simulation: &ContactSimulation, tolerance: f64) {
    let first = scene.energy(&simulation.instants[0].state.body);
    for now in &simulation.instants {
        let defect =
            scene.energy(&now.state.body) - first - now.friction_work - now.palm_work - now.blow_work;
        assert!(defect.abs() < tolerance, "{} J at {} s", defect, now.state.t);
    }
}

#[test]
fn a_ball_rolls_or_slides_down_an_incline() {
    let (angle, share) = (0.5_f64, 0.4);
    // Rolling needs mu >= tan(angle) / (1 + 1 / share).
    let critical = angle.tan() / (1.0 + 1.0 / share);
    for (friction, mode) in [
        (1.01 * critical, ContactMode::Stick),
        (0.99 * critical, ContactMode::Slide),
        (0.0, ContactMode::Slide),
    ] {
        let (palm, normal, down) = incline(angle, friction);
        let scene = ball(share, palm);
        let simulation = run(&scene, resting(normal), 1.0);
        let now = last(&simulation);
        let a = match mode {
            ContactMode::Stick => G * angle.sin() / (1.0 + share),
            _ => G * (angle.sin() - friction * angle.cos()),
        };
        assert_eq!(now.modes, [mode]);
        assert!((now.state.body.p_WCm - RADIUS * normal - 0.5 * a * down).length() < 1e-10, "{friction}");
        assert!((now.state.body.v_WCm - a * down).length() < 1e-10, "{friction}");
        assert!((now.contacts[0].gap).abs() < 1e-16);
        energy_is_balanced(&scene, &simulation, 1e-10);
    }
}

#[test]
fn a_block_slides_up_an_incline_stops_and_stays() {
    // A ball that hardly can be turned is a block: its slip hangs on the velocity alone, to 1 / share.
    let (angle, friction, share) = (0.3_f64, 0.5, 1e13);
    let (palm, normal, down) = incline(angle, friction);
    let scene = ball(share, palm);
    let body = BodyState { v_WCm: -1.2 * down, ..resting(normal) };
    let simulation = run(&scene, body, 1.0);
    let braking = G * (angle.sin() + friction * angle.cos());
    let event = &simulation.events[0];
    assert_eq!((event.kind, event.modes.as_slice()), (ContactEventKind::SlipEnds, &[ContactMode::Stick][..]));
    assert!((event.t - 1.2 / braking).abs() < 1e-10, "{} for {}", event.t, 1.2 / braking);
    let way = 1.2 * 1.2 / (2.0 * braking);
    let place = RADIUS * normal - way * down;
    assert!((last(&simulation).state.body.p_WCm - place).length() < 1e-10);
    // Once it sticks it does not creep.
    let stopped: Vec<_> = simulation.instants.iter().filter(|now| now.state.t > event.t).collect();
    assert!(stopped.iter().all(|now| now.rates[0].slip.length() < 1e-13));
    energy_is_balanced(&scene, &simulation, 1e-10);
}

#[test]
fn a_ball_that_spins_and_slides_comes_to_roll() {
    let (friction, share) = (0.2, 0.4);
    let scene = ball(share, palm(PalmSurface::Plane, DVec3::ZERO, DVec3::Z, friction));
    let (v0, w0) = (DVec3::new(0.8, 0.3, 0.0), DVec3::new(4.0, -20.0, 7.0));
    let body = BodyState { v_WCm: v0, w_WO: w0, ..resting(DVec3::Z) };
    let simulation = run(&scene, body, 1.0);
    // The slip keeps its direction: v' = -mu g tau, and the spin takes up as much / share.
    let slip = v0 + w0.cross(-RADIUS * DVec3::Z);
    let time = slip.length() / (friction * G * (1.0 + 1.0 / share));
    let end = v0 - slip / (1.0 + 1.0 / share);
    let event = &simulation.events[0];
    assert!((event.t - time).abs() < 1e-10 && event.modes == [ContactMode::Stick], "{} for {time}", event.t);
    let now = last(&simulation);
    let way = 0.5 * (v0 + end) * time + end * (now.state.t - time);
    assert!((now.state.body.v_WCm - end).length() < 1e-10);
    assert!((now.state.body.p_WCm - RADIUS * DVec3::Z - way).length() < 1e-10);
    // Nothing brakes the spin about the normal.
    assert!((now.state.body.w_WO.z - w0.z).abs() < 1e-10);
    energy_is_balanced(&scene, &simulation, 1e-10);
}

#[test]
fn a_ball_rolls_in_a_cup_and_off_a_cylinder() {
    let share = 0.4;
    let coefficient = G / (1.0 + share);
    // In a cup: (R - r) x'' = -g sin(x) / (1 + share). On a cylinder the sign turns and R + r takes its place.
    for (surface, arm, sign, duration) in [
        (PalmSurface::Cup { radius: 0.11 }, 0.11 - RADIUS, -1.0, 1.0),
        (PalmSurface::Cylinder { radius: 0.08 }, 0.08 + RADIUS, 1.0, 0.16),
    ] {
        let pose =
            SurfacePose::new(DVec3::ZERO, DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2)).unwrap();
        let drive = PalmDrive::Prescribed(SurfaceMotion::immobile(pose));
        let scene = ball(share, ScenePalm { surface, drive, friction: 2.0 });
        let place = |x: f64| arm * DVec3::new(x.sin(), 0.0, sign * x.cos());
        let start = BodyState { p_WCm: place(0.4), ..resting(DVec3::Z) };
        let simulation = run(&scene, start, duration);
        assert!(simulation.events.is_empty(), "{:?}", simulation.events);
        let field = |_: f64, y: &[f64; 2]| Ok::<_, ()>([y[1], sign * coefficient / arm * y[0].sin()]);
        let mut pendulum = Dop853::new(field, 0.0, [0.4, 0.0], Tolerance::uniform(1e-14)).unwrap();
        while pendulum.time() < duration {
            pendulum.step(duration, |_| ()).unwrap();
        }
        let [x, rate] = *pendulum.state();
        let now = &last(&simulation).state.body;
        assert!(
            (now.p_WCm - place(x)).length() < 1e-10,
            "{surface:?}: {:.1e}",
            (now.p_WCm - place(x)).length()
        );
        let velocity = rate * arm * DVec3::new(x.cos(), 0.0, -sign * x.sin());
        assert!((now.v_WCm - velocity).length() < 1e-10);
        energy_is_balanced(&scene, &simulation, 1e-10);
    }
}

#[test]
fn a_ball_falls_on_a_plane_and_stays() {
    let scene = ball(0.4, palm(PalmSurface::Plane, DVec3::ZERO, DVec3::Z, 0.3));
    let body = BodyState {
        p_WCm: (RADIUS + 0.05) * DVec3::Z,
        v_WCm: DVec3::new(0.2, 0.0, 0.5),
        ..resting(DVec3::Z)
    };
    let start = ContactStart { in_flight: true, ..ContactStart::touching(body) };
    let simulation = scene.simulate(&start, SampleTimes { duration: 1.0, rate: 100.0 }, TOLERANCE).unwrap();
    let time = (0.5 + (0.25 + 2.0 * G * 0.05_f64).sqrt()) / G;
    assert_eq!(simulation.events[0].kind, ContactEventKind::Touches);
    assert!((simulation.events[0].t - time).abs() < 1e-12);
    // The impulse of the blow, m (g t - v), and of the weight after it.
    let now = last(&simulation);
    assert!((now.impulses[0].z - 0.3 * (G - 0.5)).abs() < 1e-10, "{:?}", now.impulses);
    energy_is_balanced(&scene, &simulation, 1e-10);
    let still =
        scene.simulate(&ContactStart::touching(body), SampleTimes { duration: 1.0, rate: 100.0 }, TOLERANCE);
    assert!(still.unwrap_err().to_string().contains("gap of 5.000e-2 m"));
}
