//! The three-palm estimator on simulated logs: right without a guess, honest about its error, and silent about nothing.

use crate::noisy::{estimated, squares};
use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm, SupportFunction};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, Instant, MassProperties, SampleTimes, SensorLog, SensorNoise, Simulation, ThreePalmScene,
};
use recon::observer::{
    ContactEstimate, KnownBody, MotionEstimate, NoiseLevel, Reason, Reliability, StartState, UnknownBody,
    estimate_body, estimate_body_from, estimate_motion, estimate_motion_from, nearest_turn,
};
use recon_tests::{Random, exact_log, f5, g2};

fn known<S: SupportFunction>(scene: &ThreePalmScene<S>, noise: Option<NoiseLevel>) -> KnownBody {
    KnownBody { mass: *scene.mass(), gravity: scene.gravity(), palm_inertias: scene.palm_inertias(), noise }
}

/// Errors of the start state in the order of the covariance; the orientation against the nearest of the equivalent
/// ones.
fn errors(estimate: &MotionEstimate, mass: &MassProperties, truth: &Instant) -> [f64; 12] {
    let L = truth.R_WO * (mass.inertia() * (truth.R_WO.inverse() * truth.w_WO));
    let found = estimate.start.R_WO;
    let turn = (found * nearest_turn(mass, found, truth.R_WO)) * truth.R_WO.inverse();
    let angle = DVec3::new(turn.x, turn.y, turn.z) * 2.0 * turn.w.signum();
    let parts = [
        estimate.start.p_WCm - truth.touch.p_WCm,
        estimate.start.v_WCm - truth.rates.v_WCm,
        estimate.start.L_WO - L,
        angle,
    ];
    std::array::from_fn(|i| parts[i / 3][i % 3])
}

fn largest_error(estimate: &MotionEstimate, simulation: &Simulation) -> (f64, f64) {
    let pairs = || estimate.motion.iter().zip(&simulation.instants);
    let cm = pairs().map(|(m, now)| m.p_WCm.distance(now.touch.p_WCm)).fold(0.0, f64::max);
    let w = pairs().map(|(m, now)| m.w_WO.distance(now.w_WO)).fold(0.0, f64::max);
    (cm, w)
}

#[test]
fn exact_logs_are_explained_exactly() {
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 4.2, 1000.0);
    check_exact(&simulation, &estimate_motion(&log, &known(&scene, None)).unwrap(), 1e-10);
    // Moving palms, full inertia tensor, dented body; rates of the palms from their normals alone.
    let (scene, start) = g2();
    let (simulation, log) = exact_log(&scene, start, 4.0, 1000.0);
    let estimate = estimate_motion(&log, &known(&scene, None)).unwrap();
    check_exact(&simulation, &estimate, 1e-10);
    let mut samples = log.samples().to_vec();
    for palm in samples.iter_mut().flat_map(|s| &mut s.palms) {
        palm.rate = None;
    }
    // Fourth-order differences of the normals at 1 kHz: rates to 1e-12 times fifth derivatives (of order 40).
    let log = SensorLog::new(samples, None).unwrap();
    check_exact(&simulation, &estimate_motion(&log, &known(&scene, None)).unwrap(), 1e-8);
}

/// A start nearby saves the search and nothing else, with the body known or unknown.
#[test]
fn a_start_nearby_leads_to_the_same_estimate() {
    let (scene, start) = f5();
    let (_, log) = exact_log(&scene, start, 2.0, 500.0);
    let known = known(&scene, None);
    let found = estimate_motion(&log, &known).unwrap();
    let near = StartState {
        p_WCm: found.start.p_WCm + DVec3::new(0.05, -0.04, 0.05),
        v_WCm: found.start.v_WCm + DVec3::new(-0.05, 0.05, 0.03),
        L_WO: found.start.L_WO * 1.1,
        R_WO: DQuat::from_scaled_axis(DVec3::new(0.05, 0.03, -0.05)) * found.start.R_WO,
    };
    let again = estimate_motion_from(&log, &known, &near).unwrap();
    assert!(again.start.p_WCm.distance(found.start.p_WCm) < 1e-10);
    assert!(again.start.R_WO.angle_between(found.start.R_WO) < 1e-7);
    let unknown = UnknownBody { gravity: scene.gravity(), palm_inertias: None, noise: None };
    let found = estimate_body(&log, &unknown).unwrap();
    let moments = scene.mass().principal().moments * DVec3::new(1.05, 0.97, 1.0);
    let mass = MassProperties::new(1.05, DMat3::from_diagonal(moments)).unwrap();
    let near = StartState { R_WO: DQuat::from_rotation_x(0.05) * scene.mass().principal().axes, ..near };
    let again = estimate_body_from(&log, &unknown, &mass, &near).unwrap();
    assert!(again.motion.start.p_WCm.distance(found.motion.start.p_WCm) < 1e-9);
    assert!((again.body.mass.mass() - found.body.mass.mass()).abs() < 1e-9);
}

fn check_exact(simulation: &Simulation, estimate: &MotionEstimate, tolerance: f64) {
    let (cm, w) = largest_error(estimate, simulation);
    assert!(cm < tolerance && w < tolerance, "{cm:e} {w:e}");
    assert!(estimate.reliability.is_reliable(), "{:?}", estimate.reliability);
    assert_eq!(estimate.evidence.rank, 12);
    for (now, r) in simulation.instants.iter().zip(&estimate.radii) {
        for i in 0..3 {
            assert!((now.touch.contacts[i].jet.value - r[i]).abs() < 10.0 * tolerance);
        }
    }
}

#[test]
fn contact_curves_lie_on_the_body() {
    let (scene, start) = f5();
    let (_, log) = exact_log(&scene, start, 4.2, 1000.0);
    let estimate = estimate_motion(&log, &known(&scene, None)).unwrap();
    // The scene starts at the identity, so the frame nearest to the world's axes is the body's own.
    for point in estimate.curves.iter().flat_map(|c| c.points()) {
        let jet = scene.body().jet(point.n_O);
        assert!((jet.point - point.beta_O).length() < 1e-9);
        // Fourth-order differences at 1 kHz.
        assert!((jet.hessian * point.n_dot_O - point.beta_dot_O).length() < 1e-8);
    }
}

#[test]
fn torques_serve_where_forces_were_not_logged() {
    let (scene, start) = g2();
    let scene = scene.with_palm_inertias([0.5, 0.7, 0.4]).unwrap();
    let (simulation, log) = exact_log(&scene, start, 3.0, 1000.0);
    let mut samples = log.samples().to_vec();
    for palm in samples.iter_mut().flat_map(|s| &mut s.palms) {
        palm.force = None;
    }
    let log = SensorLog::new(samples, None).unwrap();
    let (cm, w) = largest_error(&estimate_motion(&log, &known(&scene, None)).unwrap(), &simulation);
    assert!(cm < 1e-8 && w < 1e-8, "{cm:e} {w:e}");
}

#[test]
fn error_falls_with_fourth_order_in_the_sample_time() {
    let (scene, start) = f5();
    let error = |rate| {
        let (simulation, log) = exact_log(&scene, start, 4.2, rate);
        largest_error(&estimate_motion(&log, &known(&scene, None)).unwrap(), &simulation).1
    };
    let (coarse, fine) = (error(25.0), error(100.0));
    let order = (coarse / fine).log2() / 2.0;
    assert!((3.5..6.5).contains(&order), "{coarse:e} {fine:e}: order {order}");
}

#[test]
fn random_scenes_come_out_right_from_no_guess() {
    let mut random = Random::new(11);
    let mut tried = 0;
    while tried < 12 {
        let axes = random.vector(1.0, 2.5);
        let mass = MassProperties::uniform_ellipsoid(random.within(0.5, 2.5), axes).unwrap();
        let palms = [0.0, 1.0, 2.0].map(|k: f64| {
            let azimuth = k * std::f64::consts::TAU / 3.0 + random.within(-0.3, 0.3);
            Palm::fixed(azimuth, random.within(0.8, 1.2)).unwrap()
        });
        let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
        let R_WO = DQuat::from_scaled_axis(random.vector(-3.0, 3.0));
        let start = InitialMotion { R_WO, w_WO: random.vector(-0.8, 0.8) };
        let times = SampleTimes { duration: 3.0, rate: 500.0 };
        let Ok(simulation) = scene.simulate(start, times, Tolerance::uniform(1e-13)) else { continue };
        if simulation.instants.len() < 500 {
            continue;
        }
        tried += 1;
        let log = simulation.sensor_log(&scene).unwrap().split_truth().0;
        let estimate = estimate_motion(&log, &known(&scene, None)).unwrap();
        let (cm, w) = largest_error(&estimate, &simulation);
        let right = cm < 1e-6 && w < 1e-6;
        assert!(
            right || !estimate.reliability.is_reliable(),
            "scene {tried}: {cm:e} {w:e} without a warning"
        );
        assert!(right, "scene {tried}, semi-axes {axes}: {cm:e} {w:e} {:?}", estimate.reliability);
        let orientation = errors(&estimate, &mass, &simulation.instants[0]);
        assert!(orientation[9..].iter().all(|e| e.abs() < 1e-5), "{orientation:?}");
    }
}

#[test]
fn deviations_are_consistent_under_noise() {
    // Contact noise 0.1 % of the size, force noise 1 % of what a palm carries; then contact noise of 0.01 %, where between nodes
    // the motion wanders by more than contacts explain. The errors of a run hang together: the squares of nine numbers are worth
    // about three independent ones, 12 over 4 runs, whose mean has a deviation of sqrt(2 / 12) = 0.41. The band is two of those wide.
    let check = |simulation: &Simulation, run: &dyn Fn(u64) -> ContactEstimate| {
        let runs = 4;
        let (mut sum, mut worst): (f64, f64) = (0.0, 0.0);
        for seed in 0..runs {
            let found = run(seed);
            assert!(found.reliability.is_reliable(), "seed {seed}: {:?}", found.reliability);
            let squares = squares(&found, 0, &simulation.instants[0]);
            sum += squares.iter().sum::<f64>() / squares.len() as f64;
            worst = squares.iter().fold(worst, |m, v| m.max(*v));
        }
        let mean = sum / runs as f64;
        assert!((0.18..1.82).contains(&mean), "{mean}");
        assert!(worst < 25.0, "{} deviations", worst.sqrt());
    };
    let noise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
    let (scene, start) = f5();
    let (simulation, clean) = exact_log(&scene, start, 3.0, 100.0);
    for known in [true, false] {
        check(&simulation, &|seed| estimated(&scene, &clean.with_noise(&noise, seed).unwrap(), noise, known));
    }
    let (scene, start) = g2();
    let (simulation, clean) = exact_log(&scene, start, 2.0, 500.0);
    let noise = SensorNoise { contact: 2.5e-4, ..noise };
    check(&simulation, &|seed| estimated(&scene, &clean.with_noise(&noise, seed).unwrap(), noise, true));
}

/// The momentum form is for exact logs: of a noisy one it says so.
#[test]
fn noise_is_not_for_the_momentum_form() {
    let (scene, start) = f5();
    let (_, clean) = exact_log(&scene, start, 3.0, 100.0);
    let noise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
    let found = estimate_motion(&clean.with_noise(&noise, 1).unwrap(), &known(&scene, None)).unwrap();
    let Reliability::Unreliable(reasons) = found.reliability else { panic!("believed") };
    let level = reasons.iter().find_map(|reason| match reason {
        Reason::Noisy { contact } => Some(*contact),
        _ => None,
    });
    // By the roughness of 600 numbers.
    assert!((level.unwrap() / 2.5e-3 - 1.0).abs() < 0.2, "{level:?}");
}
