//! Steps that are tried beyond a contact that is still to come.

use contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, MotionPart, PalmSurface, SurfaceMotion, SurfacePose,
};
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::*;

/// A fingertip on a spring that moves in along -Y, from 1 mm off an ellipsoid that rests on a table.
fn scene() -> (ContactScene<Ellipsoid>, ContactStart) {
    let body = Ellipsoid::new(DVec3::new(0.035, 0.03, 0.025)).unwrap();
    let mass = MassProperties::from_principal(0.1, DVec3::new(3.05e-5, 3.7e-5, 4.25e-5)).unwrap();
    let at = |p| SurfacePose::new(p, DQuat::IDENTITY).unwrap();
    let table = ScenePalm {
        surface: PalmSurface::Plane,
        drive: PalmDrive::Prescribed(SurfaceMotion::immobile(at(DVec3::ZERO))),
        friction: 0.5,
    };
    let law = MotionLaw::Ramp { height: 0.004, start: 0.05, duration: 0.25 };
    let direction = Direction::new(-DVec3::Y).unwrap();
    let parts = vec![MotionPart::Shift { direction, law }];
    let spring = PalmSpring {
        command: SurfaceMotion::Parts { pose: at(DVec3::new(0.0, 0.043, 0.025)), parts },
        stiffness: DMat3::from_diagonal(DVec3::splat(1500.0)),
        damping: DMat3::from_diagonal(DVec3::splat(11.0)),
        mass: 0.02,
    };
    let tip = ScenePalm {
        surface: PalmSurface::Sphere { radius: 0.012 },
        drive: PalmDrive::Spring(spring),
        friction: 0.8,
    };
    let p_WCm = DVec3::new(0.0, 0.0, 0.025);
    let start = BodyState { p_WCm, R_WO: DQuat::IDENTITY, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
    (ContactScene::new(body, mass, vec![table, tip], 9.81).unwrap(), ContactStart::touching(start))
}

#[test]
fn a_step_tried_into_a_palm_is_taken_again() {
    let (scene, start) = scene();
    let touch = [1e-8, 1e-10, 1e-12].map(|tolerance| {
        let run = scene.simulate(&start, SampleTimes { duration: 0.2, rate: 1000.0 }, tolerance).unwrap();
        let event = run.events.iter().find(|event| event.kind == ContactEventKind::Touches).unwrap();
        assert_eq!(event.palm, 1);
        event.t
    });
    assert!((touch[0] - touch[2]).abs() < 1e-6 && (touch[1] - touch[2]).abs() < 1e-8, "{touch:?}");
}
