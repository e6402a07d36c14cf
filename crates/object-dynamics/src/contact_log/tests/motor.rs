//! Torques of motors: in logs of simulations, and what they say of the contact.

use super::*;
use crate::{
    BodyState, ContactScene, ContactStart, MassProperties, PalmDrive, PalmTorque, SampleTimes, ScenePalm,
};
use contact_kinematics::{Direction, Ellipsoid, MotionLaw, SurfaceMotion};

const INERTIA: f64 = 2e-3;

/// A plate on a hinge along y, 20 mm under its surface, or in the surface; a motor holds up the ellipsoid that slides on it.
fn hinged(pivot: DVec3, friction: f64) -> (ContactScene<Ellipsoid>, ContactStart) {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let torque = MotionLaw::Sinusoid { mean: -0.15, amplitude: 0.1, frequency: 20.0, phase: 0.3 };
    let pose = SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY };
    let motor =
        PalmTorque { pose, pivot, axis: Direction::Y, inertia: INERTIA, torque, angle: 0.0, rate: 0.0 };
    let below = SurfacePose { p_WP: DVec3::Z * -0.5, R_WP: DQuat::IDENTITY };
    let floor = PalmDrive::Prescribed(SurfaceMotion::immobile(below));
    let palms = vec![
        ScenePalm { surface: PalmSurface::Plane, drive: PalmDrive::Torque(motor), friction },
        ScenePalm { surface: PalmSurface::Plane, drive: floor, friction },
    ];
    let mass = MassProperties::uniform_ellipsoid(0.2, axes).unwrap();
    let body = BodyState {
        p_WCm: DVec3::new(0.1, 0.0, axes.z),
        R_WO: DQuat::IDENTITY,
        v_WCm: DVec3::new(0.3, 0.05, 0.0),
        w_WO: DVec3::new(0.0, 0.0, 2.0),
    };
    let scene = ContactScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    (scene, ContactStart { body, palms: None, in_flight: false })
}

fn log(pivot: DVec3, friction: f64, rate: f64) -> ContactLog {
    let (scene, start) = hinged(pivot, friction);
    let simulation = scene.simulate(&start, SampleTimes { duration: 0.2, rate }, 1e-12).unwrap();
    ContactLog::from_simulation(&scene, &simulation).unwrap()
}

/// Largest difference of a force by torque from the normal force of the log, N.
fn worst(log: &ContactLog) -> f64 {
    let (forces, palm) = (log.forces_of_torque(0).unwrap(), &log.palms()[0]);
    let difference = |(k, force): (usize, &Option<f64>)| {
        (normal_force(palm, k) - force.expect("the object touches the plate all the time")).abs()
    };
    forces.iter().enumerate().map(difference).fold(0.0, f64::max)
}

fn normal_force(palm: &LoggedPalm, k: usize) -> f64 {
    palm.force(k).unwrap().vector.dot(palm.touch(k).unwrap().n.get())
}

#[test]
fn torque_and_contact_turn_the_palm() {
    for (depth, friction) in [(0.02, 0.0), (0.0, 0.05), (0.02, 0.05)] {
        let log = log(DVec3::Z * -depth, friction, 1000.0);
        let palm = &log.palms()[0];
        let hinge = *palm.hinge().unwrap();
        let moment = |k: usize| {
            let lever = palm.touch(k).unwrap().p_WC - hinge.pivot;
            palm.torque(k).unwrap() - hinge.axis.get().dot(lever.cross(palm.force(k).unwrap().vector))
        };
        let rate = |k: usize| palm.motion(k).w_WP.dot(hinge.axis.get());
        // Simpson's rule over 1 ms: its error is below 1e-4 times the fifth power of 20 / s times 1 ms, in N m times 0.2 s.
        let simpson = |k: usize| (moment(k - 1) + 4.0 * moment(k) + moment(k + 1)) / 3000.0;
        let last = log.times().len() - 1;
        let given: f64 = (1..last).step_by(2).map(simpson).sum();
        let gained = INERTIA * (rate(last) - rate(0));
        assert!(gained.abs() > 1e-4, "the palm turns: {gained} N m s");
        assert!((gained - given).abs() < 1e-9, "{depth} {friction}: {gained} {given}");
    }
}

#[test]
fn forces_follow_from_torques() {
    // Without friction, and with friction in a plate through its hinge, where it has no moment: second order, to a tenth.
    for (depth, friction) in [(0.02, 0.0), (0.0, 0.05)] {
        let at = |rate| worst(&log(DVec3::Z * -depth, friction, rate));
        let [coarse, fine] = [at(250.0), at(1000.0)];
        assert!((14.4..17.6).contains(&(coarse / fine)), "{depth} {friction}: {coarse:e} {fine:e}");
    }
    let below = log(DVec3::Z * -0.02, 0.05, 1000.0);
    assert!(worst(&below) > 0.01, "friction above the hinge has one");
    // Without the palm's own inertia.
    let (palm, hinge) = (&below.palms()[0], below.palms()[0].hinge().unwrap());
    let massless = palm.torque(100).unwrap() / hinge.lever(&palm.touch(100).unwrap());
    assert!((massless - normal_force(palm, 100)).abs() > 0.01);
}

#[test]
fn what_tells_no_force_is_named() {
    let good = log(DVec3::Z * -0.02, 0.0, 100.0);
    assert!(matches!(good.forces_of_torque(1), Err(ContactLogError::NoMotor { palm: 2, what: "hinge", .. })));
    assert!(matches!(good.forces_of_torque(2), Err(ContactLogError::PalmCount { found: 3 })));
    let changed = |change: &dyn Fn(&mut PalmRecord)| {
        let mut records = good.records();
        change(&mut records[0]);
        ContactLog::new(good.times().to_vec(), records, None)
    };
    let torque = |k: usize, value| changed(&move |palm| palm.torque.as_mut().unwrap()[k] = value);
    let gap = torque(7, None).unwrap().forces_of_torque(0);
    assert!(matches!(gap, Err(ContactLogError::Missing { what: "torque", palm: 1, sample: 7, .. })));
    assert!(matches!(
        torque(7, Some(f64::NAN)),
        Err(ContactLogError::ReadingNotFinite { what: "torque", palm: 1, sample: 7, .. })
    ));
    let without = changed(&|palm| palm.torque = None).unwrap().forces_of_torque(0);
    assert!(matches!(without, Err(ContactLogError::NoMotor { palm: 1, what: "torque", .. })));
    assert!(
        changed(&|palm| palm.hinge.as_mut().unwrap().inertia = 0.0).is_ok(),
        "a palm that weighs nothing"
    );
    for inertia in [-1e-9, f64::NAN] {
        let light = changed(&|palm| palm.hinge.as_mut().unwrap().inertia = inertia);
        assert!(matches!(light, Err(ContactLogError::Hinge { palm: 1, what: "moment of inertia", .. })));
    }
    let away = changed(&|palm| palm.hinge.as_mut().unwrap().pivot.x = f64::INFINITY);
    assert!(matches!(away, Err(ContactLogError::Hinge { what: "pivot", .. })));
    // On the axis the torque says nothing of the force, and nothing is made up.
    let on_axis = changed(&|palm| {
        let ContactPoints::World(points) = &mut palm.contacts else { unreachable!() };
        points[3] = None;
        palm.force = ForceChannel::Missing;
    });
    let forces = on_axis.unwrap().forces_of_torque(0).unwrap();
    assert!(forces[3].is_none() && forces[2].is_some());
}

#[cfg(feature = "noise")]
#[test]
fn a_motor_is_noisy_whether_or_not_its_palm_is_touched() {
    let mut records = log(DVec3::Z * -0.02, 0.0, 100.0).records();
    let ContactPoints::World(points) = &mut records[0].contacts else { unreachable!() };
    points[3] = None;
    let times = (0..21).map(|k| 0.01 * f64::from(k)).collect();
    let exact = ContactLog::new(times, records, None).unwrap();
    let noisy = exact.with_noise(&ContactNoise { torque: 1e-3, ..ContactNoise::default() }, 5).unwrap();
    let changed = |k| noisy.palms()[0].torque(k) != exact.palms()[0].torque(k);
    assert!((0..21).all(changed));
}

#[test]
fn torques_that_contradict_the_forces_are_named() {
    let log = log(DVec3::Z * -0.02, 0.05, 1000.0);
    let made = |change: &dyn Fn(&mut PalmRecord)| {
        let mut records = log.records();
        change(&mut records[0]);
        ContactLog::new(log.times().to_vec(), records, None)
    };
    let times_torque = |factor: f64| {
        made(&|record| record.torque.iter_mut().flatten().flatten().for_each(|torque| *torque *= factor))
    };
    assert!(times_torque(1.0).is_ok() && times_torque(1.2).is_ok());
    for factor in [1e3, -1.0] {
        let error = times_torque(factor).unwrap_err();
        let ContactLogError::TorqueAgainstForce { palm: 1, torque, moment } = error else {
            panic!("{error}")
        };
        assert!((torque - moment).abs() > 0.5 * moment.abs(), "{error}");
        assert!(error.to_string().contains("pivot, axis and inertia"), "{error}");
    }
    let far = made(&|record| record.hinge.iter_mut().for_each(|hinge| hinge.pivot.x -= 1.0));
    assert!(matches!(far, Err(ContactLogError::TorqueAgainstForce { palm: 1, .. })), "{far:?}");
    let forces = |record: &mut PalmRecord| {
        let ForceChannel::Three(forces) = &mut record.force else { panic!("three axes") };
        forces.iter_mut().for_each(|force| *force *= 3.0);
    };
    let other = made(&|record| {
        forces(record);
        record.impulse = ForceChannel::Missing;
    });
    assert!(matches!(other, Err(ContactLogError::TorqueAgainstForce { palm: 1, .. })));
}
