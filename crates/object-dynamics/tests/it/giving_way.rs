//! Palms that give way: the energy of body, palms, motors and springs together.

use contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, PalmSurface, SupportFunction, SurfaceMotion, SurfacePose,
};
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::*;

const G: f64 = 9.81;

/// An ellipsoid that touches the plane `z = 0` at some distance from the origin.
fn on_a_plane(drive: PalmDrive, friction: f64) -> (ContactScene<Ellipsoid>, BodyState) {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let (body, mass) = (Ellipsoid::new(axes).unwrap(), MassProperties::uniform_ellipsoid(0.2, axes).unwrap());
    let R_WO = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.4);
    let down = Direction::new(R_WO.inverse() * -DVec3::Z).unwrap();
    let (h, b) = (body.value(down), R_WO * body.point(down));
    let w_WO = DVec3::new(0.5, -1.0, 2.0);
    let v_WCm = DVec3::new(0.1, 0.05, -w_WO.cross(b).z);
    let start = BodyState { p_WCm: DVec3::new(0.1, 0.0, h), R_WO, v_WCm, w_WO };
    let palm = ScenePalm { surface: PalmSurface::Plane, drive, friction };
    (ContactScene::new(body, mass, vec![palm], G).unwrap(), start)
}

fn run(scene: &ContactScene<Ellipsoid>, start: BodyState) -> ContactSimulation {
    let times = SampleTimes { duration: 0.4, rate: 100.0 };
    scene.simulate(&ContactStart::touching(start), times, 1e-12).unwrap()
}

/// Largest departure of an energy from what it was, less the work of friction and blows.
fn drift(simulation: &ContactSimulation, energy: impl Fn(&ContactInstant) -> f64) -> f64 {
    let first = energy(&simulation.instants[0]);
    let kept = |now: &ContactInstant| energy(now) - first - now.friction_work - now.blow_work;
    simulation.instants.iter().map(|now| kept(now).abs()).fold(0.0, f64::max)
}

#[test]
fn a_motor_s_work_is_in_the_palm_and_the_body() {
    let pose = SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).unwrap();
    let (inertia, torque) = (2e-3, -0.15);
    for friction in [0.0, 0.3] {
        let drive = PalmTorque {
            pose,
            pivot: DVec3::ZERO,
            axis: Direction::Y,
            inertia,
            torque: MotionLaw::Constant { value: torque },
            angle: 0.0,
            rate: 0.0,
        };
        let (scene, start) = on_a_plane(PalmDrive::Torque(drive), friction);
        let simulation = run(&scene, start);
        let energy = |now: &ContactInstant| {
            let hinge = now.state.palms[0];
            let palm = 0.5 * inertia * hinge.velocity.x.powi(2) - torque * hinge.position.x;
            scene.energy(&now.state.body) + palm
        };
        let turned = simulation.instants.last().unwrap().state.palms[0].position.x;
        assert!(turned.abs() > 0.05, "the palm turns: {turned} rad");
        let drift = drift(&simulation, energy);
        assert!(drift < 1e-10, "friction {friction}: {drift:.1e} J");
        // The palm moves with its hinge alone.
        for now in &simulation.instants {
            let lever = DVec3::Y.cross(now.contacts[0].p_WC);
            let slip_of_palm = now.palms[0].material_velocity(now.contacts[0].p_WC);
            let rate = now.state.palms[0].velocity.x;
            assert!((slip_of_palm - rate * lever).length() < 1e-13);
        }
    }
}

#[test]
fn springs_keep_what_they_take() {
    let pose = SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).unwrap();
    let (stiffness, mass) = (DMat3::from_diagonal(DVec3::new(300.0, 200.0, 150.0)), 0.05);
    for friction in [0.0, 0.3] {
        let command = SurfaceMotion::immobile(pose);
        let spring = PalmSpring { command, stiffness, damping: DMat3::ZERO, mass };
        let (scene, start) = on_a_plane(PalmDrive::Spring(spring), friction);
        let simulation = run(&scene, start);
        let energy = |now: &ContactInstant| {
            let palm = now.state.palms[0];
            let stretched = 0.5 * palm.position.dot(stiffness * palm.position);
            scene.energy(&now.state.body) + stretched + 0.5 * mass * palm.velocity.length_squared()
        };
        let sunk = simulation.instants.iter().map(|now| -now.state.palms[0].position.z).fold(0.0, f64::max);
        assert!(sunk > 0.01, "the palm sinks: {sunk} m");
        let drift = drift(&simulation, energy);
        assert!(drift < 1e-10, "friction {friction}: {drift:.1e} J");
    }
}
