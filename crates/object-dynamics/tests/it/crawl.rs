//! Sticking on three palms that comes loose: simulated by time stepping.

use crate::contact_modes::{energy_defect, funnel, violations};
use contact_kinematics::{Direction, Ellipsoid, MotionLaw, MotionPart, SupportFunction, SurfaceMotion};
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::*;

/// An ellipsoid at rest on three planes with friction, the first of which is tilted flatter by `height` rad.
fn tilted(height: f64, damped: bool) -> (ContactScene<Ellipsoid>, BodyState) {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let (body, mass) = (Ellipsoid::new(axes).unwrap(), MassProperties::uniform_ellipsoid(0.2, axes).unwrap());
    let mut palms = funnel(0.3);
    let poses = palms.iter().map(|palm| match &palm.drive {
        PalmDrive::Prescribed(motion) => motion.at(0.0),
        _ => unreachable!(),
    });
    let poses: Vec<_> = poses.collect();
    let n = [0, 1, 2].map(|i| poses[i].R_WP.z_axis);
    let pose = contact_kinematics::SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&poses[0].R_WP)).unwrap();
    let axis = Direction::new(n[0].cross(DVec3::Z)).unwrap();
    let law = MotionLaw::Ramp { height, start: 0.02, duration: 0.12 };
    let parts = vec![MotionPart::Turn { pivot: DVec3::ZERO, axis, law }];
    palms[0].drive = PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts });
    if damped {
        // The second palm on stiff springs: its velocity is a state.
        let pose =
            contact_kinematics::SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&poses[1].R_WP)).unwrap();
        palms[1].drive = PalmDrive::Spring(PalmSpring {
            command: SurfaceMotion::immobile(pose),
            stiffness: DMat3::from_diagonal(DVec3::splat(5e3)),
            damping: DMat3::from_diagonal(DVec3::splat(20.0)),
            mass: 0.05,
        });
    }
    // Where the centre lies lowest on such planes the longest axis is nearly level; friction holds the rest.
    let R_WO = DQuat::from_axis_angle(DVec3::new(0.3, 0.2, 1.0).normalize(), 0.4);
    let support = n.map(|n| body.value(Direction::new(R_WO.inverse() * -n).unwrap()));
    let p_WCm = DMat3::from_cols(n[0], n[1], n[2]).transpose().inverse() * DVec3::from_array(support);
    let start = BodyState { p_WCm, R_WO, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
    (ContactScene::new(body, mass, palms, 9.81).unwrap(), start)
}

fn run(scene: &ContactScene<Ellipsoid>, start: BodyState, tolerance: f64) -> ContactSimulation {
    let times = SampleTimes { duration: 0.06, rate: 100.0 };
    scene.simulate(&ContactStart::touching(start), times, tolerance).unwrap()
}

#[test]
fn gaps_cones_and_energy_hold_where_sticking_comes_loose() {
    let (scene, start) = tilted(0.3, false);
    let simulation = run(&scene, start, 1e-7);
    let modes = |k: usize| simulation.instants[k].modes.clone();
    assert_eq!(modes(0), [ContactMode::Stick; 3]);
    assert!(simulation.instants.iter().any(|now| now.modes.contains(&ContactMode::Slide)));
    let [gap, cone, creep] = violations(&scene, &simulation);
    // The tolerance in natural units: 4e-9 m, 2e-7 N, 6e-8 m/s.
    assert!(gap < 4e-9 && cone < 2e-7 && creep < 6e-8, "{gap:.1e} {cone:.1e} {creep:.1e}");
    // 1e-7 in each of some hundred steps, of m g l = 0.08 J.
    let defect = energy_defect(&scene, &simulation);
    assert!(defect < 1e-6, "{defect:.1e}");
    let palm_work = simulation.instants.last().unwrap().palm_work;
    assert!(palm_work.abs() > 1e-5, "{palm_work:.1e}");
}

#[test]
fn the_error_of_time_stepping_falls_with_its_step() {
    let (scene, start) = tilted(0.3, false);
    let end = |tolerance: f64| run(&scene, start, tolerance).instants.last().unwrap().state.body;
    let exact = end(1e-8);
    let errors = [1e-4, 1e-7].map(|tolerance| (end(tolerance).p_WCm - exact.p_WCm).length());
    // Steps go as the root of the tolerance: of order 1 the error falls 32-fold, of order 2 1000-fold.
    assert!(errors[1] < errors[0] / 31.6 && errors[0] < 1e-5, "{errors:?}");
}

#[test]
fn a_palm_on_springs_comes_along() {
    let (scene, start) = tilted(0.3, true);
    let simulation = run(&scene, start, 1e-7);
    let [gap, cone, creep] = violations(&scene, &simulation);
    assert!(gap < 1e-9 && cone < 1e-6 && creep < 1e-6, "{gap:.1e} {cone:.1e} {creep:.1e}");
    let last = simulation.instants.last().unwrap();
    let pressed = last.state.palms[1].position.length();
    let expected = last.forces[1].length() / 5e3;
    assert!((pressed - expected).abs() < 0.2 * expected, "{pressed:.1e} {expected:.1e}");
}

#[test]
fn forces_stay_in_their_cones_beside_slow_slips() {
    let (scene, start) = tilted(-0.08, true);
    let times = SampleTimes { duration: 0.2, rate: 2000.0 };
    let simulation = scene.simulate(&ContactStart::touching(start), times, 1e-7).unwrap();
    let slow = |now: &ContactInstant| {
        let pairs = now.modes.iter().zip(&now.rates);
        let mut slips = pairs.filter(|(mode, _)| **mode == ContactMode::Slide).map(|(_, rates)| rates.slip);
        now.modes.contains(&ContactMode::Stick) && slips.any(|slip| slip.length() < 1e-5)
    };
    assert!(simulation.instants.iter().any(slow));
    // The tolerance times the weight; 7e-3 N where directions of slow slips are not held to it.
    let [_, cone, _] = violations(&scene, &simulation);
    assert!(cone < 1e-7 * 0.2 * 9.81, "{cone:.1e}");
}

/// The first palm leaves at 0.0525 s: from then on it decides nothing, and the second slides whatever the tolerance is.
#[test]
fn a_palm_that_has_left_decides_nothing() {
    let (scene, start) = tilted(0.3, false);
    let times = SampleTimes { duration: 0.055, rate: 1000.0 };
    let [coarse, fine] = [1e-6, 1e-8].map(|tolerance| {
        let run = scene.simulate(&ContactStart::touching(start), times, tolerance).unwrap();
        run.instants.last().unwrap().clone()
    });
    assert_eq!(coarse.modes, [ContactMode::Off, ContactMode::Slide, ContactMode::Stick]);
    assert_eq!(coarse.modes, fine.modes);
    let [a, b] = [&coarse, &fine].map(|now| now.rates[1].slip.length());
    assert!((a - b).abs() < 0.05 * b, "{a:.2e} {b:.2e}");
}

#[test]
fn a_palm_that_is_far_away_changes_nothing() {
    let (scene, start) = tilted(0.3, false);
    let far = contact_kinematics::SurfacePose::new(-DVec3::Z, DQuat::IDENTITY).unwrap();
    let mut palms = scene.palms().to_vec();
    palms.push(ScenePalm {
        drive: PalmDrive::Prescribed(SurfaceMotion::immobile(far)),
        ..scene.palms()[0].clone()
    });
    let with = ContactScene::new(*scene.body(), *scene.mass(), palms, 9.81).unwrap();
    let [alone, beside] = [&scene, &with].map(|scene| run(scene, start, 1e-6));
    assert!(!alone.events.is_empty());
    assert_eq!(alone.statistics, beside.statistics);
    for (a, b) in alone.instants.iter().zip(&beside.instants) {
        assert_eq!((a.state.body, &a.modes[..]), (b.state.body, &b.modes[..3]));
    }
}

/// At 1e-12 and its hundredth of creep the first forces after sticking came loose were off by a tenth.
#[test]
fn a_tolerance_below_rounding_gives_the_motion_of_a_coarser_one() {
    let (scene, start) = tilted(0.3, false);
    let times = SampleTimes { duration: 0.025, rate: 1000.0 };
    let [coarse, fine] = [1e-9, 1e-13]
        .map(|tolerance| scene.simulate(&ContactStart::touching(start), times, tolerance).unwrap().instants);
    for (a, b) in coarse.iter().zip(&fine) {
        let apart = (a.state.body.w_WO - b.state.body.w_WO).length();
        let force = a.forces.iter().zip(&b.forces).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
        assert!(apart < 1e-5 && force < 1e-3, "{} s: {apart:.1e} rad/s, {force:.1e} N", a.state.t);
    }
}
