//! Wrong constants of the sensors: named, with what they are.

use crate::noisy::{changed, estimated, words};
use recon::object_dynamics::{SensorLog, SensorNoise};
use recon::observer::contacts::ContactEstimate;
use recon::observer::faults::{Constant, Suspect};
use recon_tests::{exact_log, f5, few_or_all, g2};

const NOISE: SensorNoise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };

fn of(found: &ContactEstimate, fault: Constant) -> Suspect {
    *found.suspects.iter().find(|suspect| suspect.fault == fault).unwrap()
}

/// To first order, and to within what noise leaves: a value, and how much of it may be beyond first order.
fn assert_found(found: &ContactEstimate, fault: Constant, value: f64, beyond: f64) {
    let suspect = of(found, fault);
    let error = (suspect.value - value).abs();
    assert!(error < 4.0 * suspect.deviation + beyond * value.abs(), "{suspect}; true {value}");
    assert!(!found.reliability.is_reliable(), "{suspect}: believed");
}

#[test]
fn a_wrong_force_gain_is_refused() {
    let (scene, start) = f5();
    let (_, log) = exact_log(&scene, start, 3.0, few_or_all(100.0, 200.0));
    let log = log.with_noise(&NOISE, 1).unwrap();
    if few_or_all(false, true) {
        let right = estimated(&scene, &log, NOISE, true);
        assert!(right.reliability.is_reliable(), "{}", words(&right.reliability));
    }
    let wrong = changed(&log, |_, i, palm| {
        if i == 1 {
            palm.force = palm.force.map(|f| f * 1.05);
        }
    });
    let found = estimated(&scene, &wrong, NOISE, true);
    assert!(!found.reliability.is_reliable(), "believed: {:?}", found.evidence);
}

#[test]
fn a_gain_and_a_bias_are_found_within_their_deviations() {
    let (scene, start) = g2();
    let (_, log) = exact_log(&scene, start, 4.0, few_or_all(250.0, 500.0));
    let log = log.with_noise(&NOISE, 3).unwrap();
    let with = |change: &dyn Fn(f64) -> f64| {
        changed(&log, |_, i, palm| {
            if i == 2 {
                palm.force = palm.force.map(change);
            }
        })
    };
    let gain = estimated(&scene, &with(&|f| f / 1.03), NOISE, true);
    assert_found(&gain, Constant::ForceGain { palm: 3 }, 0.03, 0.2);
    if few_or_all(true, false) {
        return;
    }
    let bias = estimated(&scene, &with(&|f| f - 0.2), NOISE, true);
    assert_found(&bias, Constant::ForceBias { palm: 3 }, 0.2, 0.2);
}

#[test]
fn a_delay_of_the_forces_is_found() {
    let (scene, start) = g2();
    let (_, log) = exact_log(&scene, start, 3.0, 500.0);
    // Forces reported five samples, 10 ms, late.
    let late = 5;
    let noisy = log.with_noise(&NOISE, 4).unwrap();
    let mut samples = noisy.samples().to_vec();
    for k in (late..samples.len()).rev() {
        for i in 0..3 {
            samples[k].palms[i].force = samples[k - late].palms[i].force;
        }
    }
    let wrong = SensorLog::new(samples[late..].to_vec(), None).unwrap();
    let found = estimated(&scene, &wrong, NOISE, true);
    assert_found(&found, Constant::ForceDelay, 0.01, 0.2);
}
