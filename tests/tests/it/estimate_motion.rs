//! The estimate of a known body from simulated logs of three palms: right without a guess, honest about its error, and silent about nothing.

use crate::noisy::{estimated, exactly, largest_errors, squares, words};
use glam::DQuat;
use recon::contact_kinematics::{Direction, Ellipsoid, Palm, SupportFunction};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    ContactLog, InitialMotion, MassProperties, SampleTimes, SensorLog, SensorNoise, Simulation,
    ThreePalmScene,
};
use recon::observer::contacts::ContactEstimate;
use recon::observer::rigid::nearest_turn;
use recon_tests::{Random, exact_log, f5, few_or_all, g2};

#[test]
fn exact_logs_are_explained_exactly() {
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 4.2, 1000.0);
    check_exact(&scene, &simulation, &log, 1e-10);
    // Moving palms, full inertia tensor, dented body; rates of the palms from their normals alone.
    let (scene, start) = g2();
    let (simulation, log) = exact_log(&scene, start, 4.0, 1000.0);
    check_exact(&scene, &simulation, &log, 1e-10);
    let mut samples = log.samples().to_vec();
    for palm in samples.iter_mut().flat_map(|s| &mut s.palms) {
        palm.rate = None;
    }
    // Fourth-order differences of the normals at 1 kHz: rates to 1e-12 times fifth derivatives (of order 40).
    let log = SensorLog::new(samples, None).unwrap();
    check_exact(&scene, &simulation, &log, 1e-8);
}

/// Motion, and contacts on the body: where its normal is that of the palm, in its own axes.
fn check_exact<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    simulation: &Simulation,
    log: &SensorLog,
    tolerance: f64,
) {
    let found = exactly(scene, log, true).unwrap();
    let (centre, spin) = largest_errors(&found, &simulation.instants);
    assert!(centre < tolerance && spin < tolerance, "{centre:e} {spin:e}");
    assert!(found.reliability.is_reliable(), "{}", words(&found.reliability));
    assert!(found.relied_on.iter().all(|relied| *relied));
    let contacts = ContactLog::try_from(log).unwrap();
    let same = nearest_turn(scene.mass(), found.states[0].R_WO, simulation.instants[0].R_WO);
    for (k, state) in found.states.iter().enumerate() {
        let own = (state.R_WO * same).inverse();
        for palm in contacts.palms() {
            let touch = palm.touch(k).unwrap();
            let jet = scene.body().jet(Direction::new_unchecked(own * -touch.n.get()));
            assert!((own * (touch.p_WC - state.p_WCm)).distance(jet.point) < 10.0 * tolerance);
        }
    }
}

#[test]
fn error_falls_with_fourth_order_in_the_sample_time() {
    let (scene, start) = f5();
    let error = |rate| {
        let (simulation, log) = exact_log(&scene, start, 4.2, rate);
        largest_errors(&exactly(&scene, &log, true).unwrap(), &simulation.instants).1
    };
    let (coarse, fine) = (error(25.0), error(100.0));
    let order = (coarse / fine).log2() / 2.0;
    assert!((3.5..6.5).contains(&order), "{coarse:e} {fine:e}: order {order}");
}

#[test]
fn random_scenes_come_out_right_from_no_guess() {
    let mut random = Random::new(11);
    let mut tried = 0;
    while tried < few_or_all(6, 12) {
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
        let found = exactly(&scene, &log, true).unwrap();
        let (centre, spin) = largest_errors(&found, &simulation.instants);
        let said = words(&found.reliability);
        assert!(centre < 1e-6 && spin < 1e-6, "scene {tried}, semi-axes {axes}: {centre:e} {spin:e} {said}");
        assert!(found.reliability.is_reliable(), "scene {tried}: {said}");
        let (at, now) = (found.states[0].R_WO, simulation.instants[0].R_WO);
        assert!((at * nearest_turn(&mass, at, now)).angle_between(now) < 1e-5);
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
    for &known in few_or_all(&[false][..], &[false, true]) {
        check(&simulation, &|seed| estimated(&scene, &clean.with_noise(&noise, seed).unwrap(), noise, known));
    }
    if few_or_all(true, false) {
        return;
    }
    let (scene, start) = g2();
    let (simulation, clean) = exact_log(&scene, start, 2.0, 500.0);
    let noise = SensorNoise { contact: 2.5e-4, ..noise };
    check(&simulation, &|seed| estimated(&scene, &clean.with_noise(&noise, seed).unwrap(), noise, true));
}
