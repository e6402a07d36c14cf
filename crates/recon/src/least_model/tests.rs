use super::*;
use contact_kinematics::{Ellipsoid, Palm, PalmFrame, PalmSurface, SurfaceMotion, SurfacePose};
use glam::{DQuat, DVec3};
use object_dynamics::integrate::Tolerance;
use object_dynamics::{
    BodyState, ContactLog, ContactPoints, ContactScene, ContactStart, ForceChannel, InitialMotion,
    MassProperties, PalmDrive, PalmRecord, RecordedMotion, SampleTimes, ScenePalm, SensorNoise,
    ThreePalmScene,
};
use observer::contacts::{ContactNoiseLevel, ContactOptions};
use std::f64::consts::TAU;

const G: f64 = 9.81;
const AXES: DVec3 = DVec3::new(0.05, 0.042, 0.035);
/// Noise of contacts, m, and forces, N.
const NOISE: [f64; 2] = [2e-5, 2e-3];
const SAMPLES: usize = 300;

fn level() -> ContactNoiseLevel {
    let [contact, force_fixed] = NOISE;
    ContactNoiseLevel {
        contact,
        force_fixed,
        force_share: 0.0,
        impulse: None,
        floor: 3e-5 * (G * 0.04).sqrt(),
    }
}

/// Standard normal numbers, of twelve uniform ones each.
fn normal(seed: u64) -> impl FnMut() -> f64 {
    let mut random = recon_random(seed);
    move || (0..12).map(|_| random()).sum::<f64>() - 6.0
}

fn recon_random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(2).wrapping_add(1);
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// What two planes along y record of forces of about 3 N, one of which is `tilted` out of the plane (rad), with friction `mu`.
fn two_planes(tilted: f64, mu: f64, seed: u64) -> ContactLog {
    let mut draw = normal(seed);
    let palm = |(i, slope): (usize, f64)| {
        let tilt = if i == 0 { DQuat::from_rotation_x(tilted) } else { DQuat::IDENTITY };
        let pose = SurfacePose::new(DVec3::ZERO, tilt * DQuat::from_rotation_y(slope)).unwrap();
        let [x, y, n] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| pose.R_WP * axis);
        let (mut points, mut forces) = (Vec::new(), Vec::new());
        for k in 0..SAMPLES {
            let t = k as f64 / SAMPLES as f64;
            let [along, across] = [0.04 + 0.01 * (5.0 * t).sin() + NOISE[0] * draw(), NOISE[0] * draw()];
            let size = 3.0 + (7.0 * t).sin();
            let noise = NOISE[1] * DVec3::new(draw(), draw(), draw());
            points.push(Some(along * x + across * y));
            forces.push(size * n + mu * size * x + noise);
        }
        PalmRecord {
            surface: PalmSurface::Plane,
            friction: None,
            motion: RecordedMotion::Fixed(pose),
            contacts: ContactPoints::World(points),
            force: ForceChannel::Three(forces),
            impulse: ForceChannel::Missing,
            torque: None,
            hinge: None,
            truth: None,
            largest_offset: f64::INFINITY,
        }
    };
    let times = (0..SAMPLES).map(|k| 1e-3 * k as f64).collect();
    ContactLog::new(times, [0.7, -0.7].into_iter().enumerate().map(palm).collect(), None).unwrap()
}

#[test]
fn what_is_in_a_plane_is_told_so_and_a_tilt_just_above_noise_is_not() {
    // A force of 3 N out of the plane by a tilt shows by its mean over 300 samples: one deviation of that is 2e-4 rad.
    let one = NOISE[1] / 3.0 / (SAMPLES as f64).sqrt();
    let passed = |tilt: f64| {
        (0..20).filter(|seed| is_planar(&two_planes(tilt, 0.0, *seed), &level()).is_passed_test()).count()
    };
    // False alarms are one in a thousand for each of two tests.
    assert!(passed(0.0) >= 19);
    assert!(passed(0.3 * one) >= 19);
    // Ten deviations add 100 to a sum of 47 +- 10.
    assert_eq!(passed(10.0 * one), 0);
}

#[test]
fn friction_just_above_noise_is_told() {
    let one = NOISE[1] / 3.0 / (SAMPLES as f64).sqrt();
    let passed = |mu: f64| {
        (0..20).filter(|seed| is_frictionless(&two_planes(0.0, mu, *seed), &level()).is_passed_test()).count()
    };
    assert_eq!(passed(0.0), 20);
    // On both palms: seven deviations each add 98.
    assert_eq!(passed(7.0 * one), 0);
}

#[test]
fn one_of_three_samples_keeps_every_channel() {
    let log = two_planes(0.0, 0.1, 3);
    let thin = one_of(&log, 3).unwrap();
    assert_eq!(thin.times().len(), SAMPLES / 3);
    assert_eq!((thin.times()[7], thin.palms()[1].touch(7)), (log.times()[21], log.palms()[1].touch(21)));
    assert_eq!(thin.palms()[0].force(5), log.palms()[0].force(15));
    assert!(one_of(&log, SAMPLES).is_err());
}

/// An ellipsoid on three planes, in minimal coordinates and through contact modes.
fn three_planes(
    friction: f64,
) -> (ThreePalmScene<Ellipsoid>, InitialMotion, ContactScene<Ellipsoid>, ContactStart) {
    let mass = MassProperties::uniform_ellipsoid(0.3, AXES).unwrap();
    let (mut held, mut palms) = (Vec::new(), Vec::new());
    for k in 0..3 {
        let (azimuth, slope) = (f64::from(k) * TAU / 3.0, 0.8 + 0.1 * f64::from(k));
        held.push(Palm::fixed(azimuth, slope).unwrap());
        let turn = DQuat::from_mat3(&PalmFrame::from_azimuth_slope(azimuth, slope).rotation());
        let pose = SurfacePose::new(DVec3::ZERO, turn).unwrap();
        let drive = PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts: Vec::new() });
        palms.push(ScenePalm { surface: PalmSurface::Plane, drive, friction });
    }
    let body = Ellipsoid::new(AXES).unwrap();
    let held = ThreePalmScene::new(body, mass, [held[0], held[1], held[2]], G).unwrap();
    let start = InitialMotion { R_WO: DQuat::from_rotation_x(0.4), w_WO: DVec3::new(2.0, 1.0, 3.0) };
    let now = held.instant(0.0, start.R_WO, start.w_WO).unwrap();
    let state =
        BodyState { p_WCm: now.touch.p_WCm, v_WCm: now.rates.v_WCm, w_WO: start.w_WO, R_WO: start.R_WO };
    let scene = ContactScene::new(body, mass, palms, G).unwrap();
    (held, start, scene, ContactStart::touching(state))
}

#[test]
fn the_chosen_simulation_is_as_near_as_was_asked() {
    for (friction, model) in [(0.0, Model::MinimalCoordinates), (0.2, Model::ContactModes)] {
        let (_, _, scene, start) = three_planes(friction);
        let times = SampleTimes { duration: 0.5, rate: 100.0 };
        for wanted in [1e-3, 1e-6, 1e-9] {
            let found = least_motion(&scene, &start, times, Accuracy::new(wanted).unwrap()).unwrap();
            let truth = scene.simulate(&start, times, (0.01 * found.tolerance).max(1e-14)).unwrap();
            let size = body_size(scene.body());
            let pairs = found.states.iter().zip(&truth.instants);
            let off =
                pairs.map(|(a, b)| Pose::from(*a).off(&Pose::from(b.state.body), size)).fold(0.0, f64::max);
            assert!(off <= wanted && found.choice.is_reached, "{friction} {wanted:e}: {off:e}");
            assert!(
                found.choice.reached >= off,
                "{wanted:e}: {:e} is said, {off:e} it is",
                found.choice.reached
            );
            let chosen = found.choice.decisions[0].alternatives.iter().find(|of| of.chosen).unwrap();
            assert_eq!(chosen.model, model);
        }
    }
}

#[test]
fn what_no_tolerance_reaches_is_told() {
    // Errors that hang on the tolerance by its fourth root, as of a scheme that loses its order.
    let run = |tolerance: f64| Ok::<_, std::convert::Infallible>(tolerance);
    let poses = |of: &f64| vec![Pose { p_WCm: of.powf(0.25) * DVec3::X, R_WO: DQuat::IDENTITY }];
    let found = least_tolerance(Accuracy::new(1e-6).unwrap(), 1.0, run, poses).unwrap();
    assert!(!found.choice.is_reached && found.choice.reached > 1e-6);
    assert!(found.choice.verdict().contains("not reached"), "{}", found.choice.verdict());
}

#[test]
fn what_a_log_cannot_give_is_told_with_what_it_can() {
    let (held, start, ..) = three_planes(0.0);
    let run = held
        .simulate(start, SampleTimes { duration: 0.45, rate: 1000.0 }, Tolerance::uniform(1e-11))
        .unwrap();
    let [contact, force] = NOISE;
    let noise = SensorNoise { contact, force, ..SensorNoise::default() };
    let log = run.sensor_log(&held).unwrap().split_truth().0.with_noise(&noise, 6).unwrap();
    let log = ContactLog::try_from(&log).unwrap();
    let options = ContactOptions { friction: Some(0.0), ..ContactOptions::new(level(), G) };
    let near = least_estimate(&log, &options, Accuracy::new(1e-6).unwrap()).unwrap();
    assert!(!near.choice.is_reached && near.estimate.reliability.is_reliable());
    // What can be reached is reached when it is asked for.
    let best = near.choice.reached;
    assert!(best > 1e-6 && best < 0.1, "{best:e}");
    let enough = least_estimate(&log, &options, Accuracy::new(1.01 * best).unwrap()).unwrap();
    assert!(enough.choice.is_reached && enough.choice.reached <= 1.01 * best);
    let first = run.instants[0].R_WO;
    let off = |(state, now): (&BodyState, &object_dynamics::Instant)| {
        let turned = |R_WO| Pose { p_WCm: DVec3::ZERO, R_WO };
        let own = state.R_WO * enough.estimate.states[0].R_WO.inverse();
        turned(own).off(&turned(now.R_WO * first.inverse()), 1.0).powi(2)
    };
    let squares =
        enough.estimate.states.iter().zip(run.instants.iter().step_by(enough.every)).map(off).sum::<f64>();
    let turn = (squares / enough.estimate.states.len() as f64).sqrt();
    assert!(turn <= 1.01 * best, "{turn:e} beside {best:e}, {:?}", enough.choice);
}

#[test]
fn what_is_no_accuracy_is_refused() {
    assert!(Accuracy::new(0.0).is_err() && Accuracy::new(f64::NAN).is_err());
}
