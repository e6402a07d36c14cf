//! Wrong constants of the sensors: found when they are asked for, reported when they are not.

use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{PalmReading, SensorLog, SensorNoise, ThreePalmScene};
use recon::observer::{
    KnownBody, NoiseLevel, Reason, Reliability, SensorPriors, estimate_motion, estimate_motion_and_sensors,
};
use recon_tests::{exact_log, f5, g2};

const NOISE: SensorNoise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };

fn known<S: SupportFunction>(scene: &ThreePalmScene<S>) -> KnownBody {
    let noise = Some(NoiseLevel { contact: NOISE.contact, force: NOISE.force });
    KnownBody { mass: *scene.mass(), gravity: scene.gravity(), palm_inertias: None, noise }
}

fn changed(log: &SensorLog, change: impl Fn(usize, &mut PalmReading)) -> SensorLog {
    let mut samples = log.samples().to_vec();
    for sample in &mut samples {
        sample.palms.iter_mut().enumerate().for_each(|(i, palm)| change(i, palm));
    }
    SensorLog::new(samples, None).unwrap()
}

#[test]
fn a_wrong_force_gain_is_reported_by_the_chi_squared_test() {
    let (scene, start) = f5();
    let (_, log) = exact_log(&scene, start, 3.0, 200.0);
    let log = log.with_noise(&NOISE, 1).unwrap();
    assert!(estimate_motion(&log, &known(&scene)).unwrap().reliability.is_reliable());
    let wrong = changed(&log, |i, palm| {
        if i == 1 {
            palm.force = palm.force.map(|f| f * 1.05);
        }
    });
    let estimate = estimate_motion(&wrong, &known(&scene)).unwrap();
    let Reliability::Unreliable(reasons) = &estimate.reliability else { panic!("believed") };
    assert!(
        reasons.iter().any(|r| matches!(r, Reason::Inconsistent { misfit } if *misfit > 1.4)),
        "{reasons:?}"
    );
}

#[test]
fn gains_and_biases_are_found_within_their_deviations() {
    let (scene, start) = g2();
    let (_, log) = exact_log(&scene, start, 4.0, 500.0);
    let gains = [1.03, 0.97, 1.02];
    let biases = [0.1, -0.2, 0.05];
    let wrong = changed(&log.with_noise(&NOISE, 3).unwrap(), |i, palm| {
        // What is to be multiplied and added afterwards.
        palm.force = palm.force.map(|f| (f - biases[i]) / gains[i]);
    });
    let priors = SensorPriors { force_gain: 0.1, force_bias: 0.5, ..SensorPriors::default() };
    let estimate = estimate_motion_and_sensors(&wrong, &known(&scene), &priors).unwrap();
    for (k, truth) in gains.into_iter().chain(biases).enumerate() {
        let found = &estimate.constants[k];
        println!("{}: {:.4} +- {:.4}, true {truth}", found.name, found.value, found.deviation);
        assert!((found.value - truth).abs() < 4.0 * found.deviation, "{}", found.name);
    }
    assert!(estimate.constants[..3].iter().all(|c| c.deviation < 0.03));
    assert!(estimate.motion.reliability.is_reliable(), "{:?}", estimate.motion.reliability);
}

#[test]
fn a_delay_of_the_forces_is_found() {
    let (scene, start) = g2();
    let (_, log) = exact_log(&scene, start, 3.0, 500.0);
    // Forces reported two samples, 4 ms, late.
    let late = 2;
    let noisy = log.with_noise(&NOISE, 4).unwrap();
    let mut samples = noisy.samples().to_vec();
    for k in (late..samples.len()).rev() {
        for i in 0..3 {
            samples[k].palms[i].force = samples[k - late].palms[i].force;
        }
    }
    let wrong = SensorLog::new(samples[late..].to_vec(), None).unwrap();
    let priors = SensorPriors { force_delay: 0.02, ..SensorPriors::default() };
    let estimate = estimate_motion_and_sensors(&wrong, &known(&scene), &priors).unwrap();
    let found = estimate.constants[12];
    println!("{}: {:.5} +- {:.5}", found.name, found.value, found.deviation);
    assert!((found.value - 4e-3).abs() < 4.0 * found.deviation && found.deviation < 1e-3);
}
