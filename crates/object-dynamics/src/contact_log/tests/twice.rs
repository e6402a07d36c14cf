use super::*;

#[test]
fn impulses_that_contradict_the_forces_are_named() {
    let times = times(20);
    let force = DVec3::new(0.3, 0.4, 1.2);
    let made = |factor: f64, blow: f64| {
        let sum = |t: &f64| force * (t * factor) + DVec3::Z * if *t > 9.5e-3 { blow } else { 0.0 };
        let record = PalmRecord {
            force: ForceChannel::Three(vec![force; 20]),
            impulse: ForceChannel::Three(times.iter().map(sum).collect()),
            ..palm(PalmSurface::Plane, DVec3::X * 0.01, 20)
        };
        ContactLog::new(times.clone(), vec![record], None)
    };
    // A blow of a hundred times the whole force is none of its samples.
    assert!(made(1.0, 0.0).is_ok() && made(1.3, 0.0).is_ok() && made(1.0, 2.5).is_ok());
    for wrong in [1e3, 1e-3, -1.0, 0.0] {
        let error = made(wrong, 0.0).unwrap_err();
        let ContactLogError::ImpulseAgainstForce { palm: 1, impulse, integral } = error else {
            panic!("{error}")
        };
        // Over 1 ms, in the palm's axes, which turn no length.
        assert!((integral.length() - 1e-3 * force.length()).abs() < 1e-15, "{integral}");
        assert!((impulse - wrong * integral).length() <= 1e-12 * wrong.abs(), "{impulse} {integral}");
        assert!(error.to_string().contains("N s and N"), "{error}");
    }
}

/// Noise of three axes without pattern, each between -1 and 1.
fn noise(k: usize) -> DVec3 {
    let part = |i: usize| ((k * 3 + i + 1) as f64 * 12.9898).sin() * 43_758.545_3;
    DVec3::new(part(0).fract(), part(1).fract(), part(2).fract())
}

#[test]
fn forces_of_another_palm_beside_right_impulses_are_named() {
    let forces = [DVec3::new(0.3, 0.4, 1.2), DVec3::new(-0.9, -0.5, 0.4)];
    let made = |of: [usize; 2], share: f64| {
        let record = |i: usize| {
            let noisy = |k: usize| forces[of[i]] + share * noise(k + 1000 * i);
            let mut sum = DVec3::ZERO;
            let impulse = |k: usize| {
                sum += 1e-3 * (forces[i] + share * noise(k + 500 + 1000 * i));
                sum
            };
            PalmRecord {
                force: ForceChannel::Three((0..200).map(noisy).collect()),
                impulse: ForceChannel::Three((0..200).map(impulse).collect()),
                ..palm(PalmSurface::Plane, DVec3::X * 0.01, 200)
            }
        };
        ContactLog::new(times(200), vec![record(0), record(1)], None)
    };
    // Noise that hides the direction from one sample to the next.
    for share in [0.0, 0.1, 0.5] {
        assert!(made([0, 1], share).is_ok(), "{share}");
        let error = made([1, 0], share).unwrap_err();
        // Each axis errs by its noise over the root of 200 samples, and half as much again as a median.
        let within = |a: DVec3, b: DVec3| (a - b).length() < 1e-3 * (1e-12 + 0.3 * share);
        let turned = forces.map(|force| 1e-3 * (DQuat::from_rotation_x(-0.7) * force));
        assert!(
            matches!(error, ContactLogError::ImpulseAgainstForce { palm: 1, impulse, integral }
                if within(impulse, turned[0]) && within(integral, turned[1])),
            "{share}: {error}"
        );
        assert!(error.to_string().contains("columns of this palm"), "{error}");
    }
}

#[test]
fn normal_impulses_beside_forces_with_friction_are_no_contradiction() {
    let force = DVec3::new(0.3, 0.4, 1.2);
    let normal = force.dot(DQuat::from_rotation_x(0.7) * DVec3::Z);
    // More friction than normal force.
    assert!((force.length_squared() - normal * normal).sqrt() > 1.5 * normal);
    let made = |factor: f64| {
        let record = PalmRecord {
            force: ForceChannel::Three(vec![force; 20]),
            impulse: ForceChannel::Normal(times(20).iter().map(|t| factor * normal * t).collect()),
            ..palm(PalmSurface::Plane, DVec3::X * 0.01, 20)
        };
        ContactLog::new(times(20), vec![record], None)
    };
    assert!(made(1.0).is_ok() && made(1.9).is_ok());
    assert!(matches!(made(2.1), Err(ContactLogError::ImpulseAgainstForce { palm: 1, .. })));
}
