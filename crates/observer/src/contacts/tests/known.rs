//! Of a body whose mass and inertia are known.

use super::*;
use crate::three_palms::nearest_turn;

/// Squared errors of the orientation over their variances, mean over all samples.
fn turn_errors(found: &ContactEstimate, log: &ContactLog, mass: &MassProperties) -> f64 {
    let truth = log.truth().unwrap();
    let same = nearest_turn(mass, truth[0].R_WO, found.states[0].R_WO);
    let one = |((state, at), deviations): ((&BodyState, &BodyState), &[DVec3; 4])| {
        let turn = (state.R_WO * (at.R_WO * same).conjugate()).normalize();
        let turn = if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis();
        (turn / deviations[3]).length_squared()
    };
    let squares: f64 = found.states.iter().zip(truth).zip(&found.deviations).map(one).sum();
    squares / (3.0 * truth.len() as f64)
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
        sum += turn_errors(&found, &log, &mass);
        widest = found.deviations[0][3].max_element().max(widest);
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
    let least = found.deviations[0][3].min_element();
    assert!(least > 1.0, "{least} rad, of a ball");
}
