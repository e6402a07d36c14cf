//! Where the estimators stop working on palms that swing and for bodies of which nothing is known: it is said, in words,
//! and not guessed.

use crate::noisy::{changed, estimated, words, worst_of_all};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm, SupportFunction};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, MassProperties, SampleTimes, SensorLog, SensorNoise, Simulation, ThreePalmScene,
};
use recon::observer::contacts::ContactEstimate;
use recon_tests::{exact_log, few_or_all, g2};

const NOISE: SensorNoise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };

/// What is said of the log, of a body of which nothing is known and, where all is run, of a known one.
fn both<S: SupportFunction>(scene: &ThreePalmScene<S>, log: &SensorLog) -> Vec<ContactEstimate> {
    few_or_all(&[false][..], &[false, true])
        .iter()
        .map(|&known| estimated(scene, log, NOISE, known))
        .collect()
}

/// Right to within deviations, or refused.
fn is_honest(found: &ContactEstimate, simulation: &Simulation) -> bool {
    !found.reliability.is_reliable() || worst_of_all(found, &simulation.instants) < 5.0
}

#[test]
fn a_log_that_is_too_short_for_its_noise_is_right_or_refused() {
    let (scene, start) = g2();
    let (simulation, clean) = exact_log(&scene, start, 0.5, 200.0);
    for seed in 0..few_or_all(1, 2) {
        for found in both(&scene, &clean.with_noise(&NOISE, seed).unwrap()) {
            assert!(is_honest(&found, &simulation), "seed {seed}: {:?}", found.evidence);
        }
    }
}

#[test]
fn a_wrong_force_gain_is_reported() {
    let (scene, start) = g2();
    let (_, clean) = exact_log(&scene, start, 2.0, 100.0);
    let noisy = clean.with_noise(&NOISE, 1).unwrap();
    let wrong = changed(&noisy, |_, i, palm| {
        if i == 1 {
            palm.force = palm.force.map(|force| 1.1 * force);
        }
    });
    for found in both(&scene, &wrong) {
        assert!(!found.reliability.is_reliable(), "{:?}", found.evidence);
    }
    // With the right gain both are relied on: it is the gain that is reported.
    for found in both(&scene, &noisy) {
        assert_eq!(words(&found.reliability), "");
    }
}

/// A palm is left for a while, as its sensor says while the body is there: what goes on without it is right or refused.
#[test]
fn a_noisy_log_goes_on_where_a_palm_is_lost() {
    let (scene, start) = g2();
    let (_, log) = exact_log(&scene, start, few_or_all(1.2, 2.0), few_or_all(100.0, 250.0));
    let noisy = log.with_noise(&NOISE, 4).unwrap();
    let early = changed(&noisy, |k, i, palm| {
        if i == 0 && k >= log.samples().len() / 4 {
            palm.contact = None;
            palm.force = Some(0.0);
        }
    });
    for found in both(&scene, &early) {
        assert_eq!(found.states.len(), early.samples().len());
        // The palm bore a third of the weight, and is said to bear none.
        assert!(!found.reliability.is_reliable(), "{:?}", found.evidence);
    }
}

#[test]
fn a_body_at_rest_is_reported() {
    // In balance on palms that stand still: symmetric about the vertical, so that it stays.
    let axes = DVec3::new(1.8, 1.8, 1.0);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    let palms = [60.0, 180.0, 300.0f64].map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let rest = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::ZERO };
    let (simulation, clean) = exact_log(&scene, rest, 1.5, 50.0);
    for found in both(&scene, &clean.with_noise(&NOISE, 2).unwrap()) {
        assert!(is_honest(&found, &simulation), "{:?}", found.evidence);
        // At rest nothing is told of the axes, or of the inertia.
        let open = found
            .axes_deviations
            .map_or(found.inertia_deviations.iter().copied().fold(0.0, f64::max), |of| of.max_element());
        assert!(open > 0.3, "{open}");
    }
}

#[test]
fn palms_that_are_nearly_parallel_are_right_or_reported() {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let degrees = 15.0;
    let azimuths = [0.0, 180.0 - degrees / 2.0, 180.0 + degrees / 2.0f64];
    let palms = azimuths.map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.1, 0.1) };
    let times = SampleTimes { duration: 2.0, rate: 100.0 };
    let simulation = scene.simulate(start, times, Tolerance::uniform(1e-13)).unwrap();
    let log = simulation.sensor_log(&scene).unwrap().split_truth().0.with_noise(&NOISE, 3).unwrap();
    for found in both(&scene, &log) {
        assert!(is_honest(&found, &simulation), "{degrees} degrees: {:?}", found.evidence);
    }
}
