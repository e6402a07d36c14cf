use super::*;
use crate::{
    BodyState, ContactEvent, ContactEventKind, ContactMode, ContactScene, ContactStart, MassProperties,
    PalmDrive, PalmSpring, SampleTimes, ScenePalm,
};
use contact_kinematics::{Direction, Ellipsoid, MotionLaw, MotionPart, SurfaceMotion};
use glam::DMat3;

const MASS: f64 = 0.2;
const AXES: DVec3 = DVec3::new(0.05, 0.04, 0.03);

/// An ellipsoid that slides and turns on a tray, which may be shaken along x, and is pressed down by a fingertip on a spring.
fn pressed(shaken: bool) -> (ContactScene<Ellipsoid>, BodyState) {
    let at = |p_WP| SurfacePose { p_WP, R_WP: DQuat::IDENTITY };
    let law = MotionLaw::Sinusoid { mean: 0.0, amplitude: 0.01, frequency: 25.0, phase: 0.0 };
    let shift = MotionPart::Shift { direction: Direction::X, law };
    let tray =
        SurfaceMotion::Parts { pose: at(DVec3::ZERO), parts: if shaken { vec![shift] } else { Vec::new() } };
    // 3 mm into the object without load.
    let spring = PalmSpring {
        command: SurfaceMotion::immobile(at(DVec3::Z * (0.06 + 0.012 - 0.003))),
        stiffness: DMat3::from_diagonal(DVec3::splat(300.0)),
        damping: DMat3::from_diagonal(DVec3::splat(2.0)),
        mass: 0.02,
    };
    let palms = vec![
        ScenePalm { surface: PalmSurface::Plane, drive: PalmDrive::Prescribed(tray), friction: 0.2 },
        ScenePalm {
            surface: PalmSurface::Sphere { radius: 0.012 },
            drive: PalmDrive::Spring(spring),
            friction: 0.5,
        },
    ];
    let mass = MassProperties::uniform_ellipsoid(MASS, AXES).unwrap();
    let body = BodyState {
        p_WCm: DVec3::Z * AXES.z,
        R_WO: DQuat::IDENTITY,
        v_WCm: DVec3::X * 0.25,
        w_WO: DVec3::Z * 2.0,
    };
    (ContactScene::new(Ellipsoid::new(AXES).unwrap(), mass, palms, 9.81).unwrap(), body)
}

#[test]
fn the_log_of_a_simulation_obeys_mechanics() {
    let still = check(false);
    assert_eq!(still.palms()[0].twist_source(), TwistSource::Immobile);
    assert_eq!(still.palms()[1].twist_source(), TwistSource::Stated, "the fingertip gives way");
    assert_eq!(check(true).palms()[0].twist_source(), TwistSource::Stated);
}

fn check(shaken: bool) -> ContactLog {
    let (scene, body) = pressed(shaken);
    let mut palms = scene.palms_at_start();
    palms[1].position.z += 0.003;
    let start = ContactStart { body, palms: Some(palms), in_flight: false };
    let times = SampleTimes { duration: 0.3, rate: 200.0 };
    let simulation = scene.simulate(&start, times, 1e-10).unwrap();
    let log = ContactLog::from_simulation(&scene, &simulation).unwrap();
    let truth = log.truth().unwrap();
    let gravity = DVec3::new(0.0, 0.0, -9.81);
    for k in 1..log.times().len() {
        let change = truth[k].v_WCm - truth[k - 1].v_WCm - gravity * (log.times()[k] - log.times()[k - 1]);
        let pushes: DVec3 = log.palms().iter().map(|palm| palm.impulse(k).unwrap().vector).sum();
        // Where a slip ends, what is left of it (up to 1e-4 of the natural speed, 0.6 m/s) is taken away without a force.
        let interval = log.times()[k - 1]..=log.times()[k];
        let ends = |e: &ContactEvent| e.kind == ContactEventKind::SlipEnds && interval.contains(&e.t);
        let allowed = if simulation.events.iter().any(ends) { MASS * 0.6 * 1e-4 } else { 1e-9 };
        assert!((MASS * change - pushes).length() < allowed, "{k}: {}", MASS * change - pushes);
        for palm in log.palms() {
            let (contact, Some(touch)) = (palm.truth(k).unwrap(), palm.touch(k)) else { continue };
            let material = palm.motion(k).material_velocity(touch.p_WC);
            let slip = truth[k].v_WCm + truth[k].w_WO.cross(touch.p_WC - truth[k].p_WCm) - material;
            assert!((slip.length() - contact.slip).abs() < 1e-9 && contact.gap.abs() < 1e-9);
            let force = palm.force(k).unwrap().vector;
            let ratio = force.reject_from_normalized(touch.n.get()).length() / force.dot(touch.n.get());
            match contact.mode {
                ContactMode::Slide => assert!((ratio - palm.friction().unwrap()).abs() < 1e-9, "{k} {ratio}"),
                _ => assert!(ratio <= palm.friction().unwrap() * (1.0 + 1e-9)),
            }
        }
    }
    let modes = |mode| log.palms().iter().any(|palm| (0..60).any(|k| palm.truth(k).unwrap().mode == mode));
    assert!(modes(ContactMode::Slide), "nothing slides: the test says little");
    log
}
