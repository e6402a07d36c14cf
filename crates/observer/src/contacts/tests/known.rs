//! Of a body whose mass and inertia are known.

use super::*;
use crate::reliability::{Reason, Reliability};
use crate::rigid::nearest_turn;

/// Squared error of the axes at the first sample over its variance.
fn axes_error(found: &ContactEstimate, log: &ContactLog, mass: &MassProperties) -> f64 {
    let (at, state) = (log.truth().unwrap()[0], found.states[0]);
    let same = nearest_turn(mass, at.R_WO, state.R_WO);
    let turn = (state.R_WO * (at.R_WO * same).conjugate()).normalize();
    let turn = if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis();
    (turn / found.axes_deviations.unwrap()).length_squared() / 3.0
}

#[test]
fn axes_of_a_known_body_are_found_as_well_as_it_is_said() {
    let exact = log(0.4, 500.0);
    let noise = noise(4e-5, 0.004);
    let mass = MassProperties::uniform_ellipsoid(0.2, DVec3::new(0.05, 0.04, 0.03)).unwrap();
    let (mut sum, mut widest, runs) = (0.0, 0.0f64, 6);
    for seed in 0..runs {
        let log = noisy(&exact, &noise, seed);
        let options = ContactOptions { body: Some(mass), ..options(noise) };
        let found = estimate_contacts(&log, Some(&modes(&log)), &options).unwrap();
        assert!(found.reliability.is_reliable(), "{seed}: {:?}", found.reliability);
        assert_eq!(found.inertia, mass.inertia());
        sum += axes_error(&found, &log, &mass);
        widest = found.axes_deviations.unwrap().max_element().max(widest);
    }
    let mean = sum / runs as f64;
    assert!((0.3..2.0).contains(&mean), "squared errors are {mean} of what is said");
    assert!(widest < 0.3, "deviation of the axes: {widest}");
}

#[test]
fn axes_of_a_ball_cannot_be_told() {
    let log = noisy(&log(0.4, 500.0), &noise(4e-5, 0.004), 1);
    let ball = MassProperties::from_principal(0.2, DVec3::splat(1e-4)).unwrap();
    let options = ContactOptions { body: Some(ball), ..options(noise(4e-5, 0.004)) };
    let found = estimate_contacts(&log, Some(&modes(&log)), &options).unwrap();
    let least = found.axes_deviations.unwrap().min_element();
    assert!(least > 1.0, "{least} rad, of a ball");
}

#[test]
fn another_body_than_was_stated_is_named() {
    let noise = noise(4e-5, 0.004);
    let log = noisy(&log(0.4, 500.0), &noise, 2);
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let reasons = |mass: f64| {
        let body = Some(MassProperties::uniform_ellipsoid(mass, axes).unwrap());
        let options = ContactOptions { body, ..options(noise) };
        estimate_contacts(&log, Some(&modes(&log)), &options).unwrap().reliability
    };
    assert!(reasons(0.2).is_reliable());
    let Reliability::Unreliable(why) = reasons(0.204) else { panic!("a mass off by a fiftieth is believed") };
    assert!(why.iter().any(|reason| matches!(reason, Reason::OtherBody { .. })), "{why:?}");
}

#[test]
fn axes_of_what_is_almost_a_ball_are_not_told_and_its_motion_is_as_well_known_as_is_said() {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let moments = DVec3::new(0.369, 0.370, 0.415) * (0.2 * SIZE * SIZE);
    let mass = MassProperties::from_principal(0.2, moments).unwrap();
    let (scene, start) = scene(0.0, 0.0);
    let scene = ContactScene::new(Ellipsoid::new(axes).unwrap(), mass, scene.palms().to_vec(), G).unwrap();
    let exact = simulated(&scene, &ContactStart::touching(start), 0.5, 200.0);
    let noise = noise(4e-4, 0.01);
    let (mut worst, mut squares, mut count) = (0.0_f64, 0.0, 0.0);
    for seed in 0..crate::few_or_all(4, 8) {
        let log = noisy(&exact, &noise, seed);
        let options = ContactOptions { body: Some(mass), friction: Some(0.0), ..options(noise) };
        let found = estimate_contacts(&log, None, &options).unwrap();
        assert!(found.reliability.is_reliable(), "{seed}: {:?}", found.reliability);
        assert_eq!(found.inertia, mass.inertia());
        // About the axis of nearly the same moments nothing is known of them.
        assert!(found.axes_deviations.unwrap().length() > 1.5, "{seed}: {:?}", found.axes_deviations);
        for (k, (state, at)) in found.states.iter().zip(log.truth().unwrap()).enumerate() {
            let [p, v, w, _] = found.deviations[k];
            let off =
                [(state.p_WCm - at.p_WCm) / p, (state.v_WCm - at.v_WCm) / v, (state.w_WO - at.w_WO) / w];
            worst = off.iter().map(|off| off.abs().max_element()).fold(worst, f64::max);
            squares += off.iter().map(|off| off.length_squared()).sum::<f64>();
            count += 9.0;
        }
    }
    let mean = squares / count;
    assert!(worst < 5.0 && (0.4..1.6).contains(&mean), "{worst} deviations, squares {mean} of what is said");
}
