use super::*;

const SAMPLES: usize = 4000;

/// A fingertip and a cup with three axes each, and a plane with the normal force and a motor.
fn log() -> ContactLog {
    let force = DVec3::new(0.3, 0.4, 1.2);
    let sums: Vec<_> = (0..SAMPLES).map(|k| force * (k as f64 / 1000.0)).collect();
    let three = |record: PalmRecord| PalmRecord {
        force: ForceChannel::Three(vec![force; SAMPLES]),
        impulse: ForceChannel::Three(sums.clone()),
        ..record
    };
    let plane = PalmRecord {
        force: ForceChannel::Normal(vec![2.0; SAMPLES]),
        torque: Some((0..SAMPLES).map(|k| (k % 2 == 0).then_some(0.1)).collect()),
        ..palm(PalmSurface::Plane, DVec3::X * 0.01, SAMPLES)
    };
    let fingertip = palm(PalmSurface::Sphere { radius: 0.012 }, DVec3::Z * 0.012, SAMPLES);
    let cup = palm(PalmSurface::Cup { radius: 0.12 }, DVec3::NEG_Z * 0.12, SAMPLES);
    ContactLog::new(times(SAMPLES), vec![three(fingertip), three(cup), plane], None).unwrap()
}

const NOISE: ContactNoise = ContactNoise {
    contact: 2e-4,
    force: ChannelNoise { fixed: 0.0, share: 0.02 },
    impulse: ChannelNoise { fixed: 3e-5, share: 0.0 },
    torque: 4e-3,
};

/// Root mean square of the lengths over all samples.
fn rms(values: impl Iterator<Item = DVec3>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        (sum, count) = (sum + value.length_squared(), count + 1.0);
    }
    f64::sqrt(sum / count)
}

#[test]
fn deviations_are_those_asked_for() {
    let (exact, noisy) = (log(), log().with_noise(&NOISE, 7).unwrap());
    for (a, b) in exact.palms().iter().zip(noisy.palms()) {
        let all = || (0..SAMPLES).map(|k| (k, a.touch(k).unwrap(), b.touch(k).unwrap()));
        // Two tangent directions. 8000 numbers: their deviation is known to 0.8 %.
        let contact = rms(all().map(|(_, a, b)| b.p_WC - a.p_WC)) / 2.0_f64.sqrt();
        assert!((contact / 2e-4 - 1.0).abs() < 0.03, "{contact}");
        let off = all().map(|(k, _, touch)| {
            let s = b.motion(k).pose.at_rest().to_palm(touch.p_WC);
            b.surface().nearest(s).unwrap().distance.abs()
        });
        assert!(off.fold(0.0, f64::max) < 1e-15, "contacts leave their palm");
        let turned = rms(all().map(|(_, a, b)| b.n.get() - a.n.get())) / 2.0_f64.sqrt();
        let expected = b.surface().radius().map_or(0.0, |radius| 2e-4 / radius);
        assert!((turned - expected).abs() <= 0.03 * expected, "{turned} {expected}");
        let axes = if a.impulse_axes().is_some() { 3.0 } else { 1.0_f64 };
        let force = rms((0..SAMPLES).map(|k| b.force(k).unwrap().vector - a.force(k).unwrap().vector));
        let length = a.force(0).unwrap().vector.length();
        assert!((force / axes.sqrt() / (0.02 * length) - 1.0).abs() < 0.04, "{force}");
    }
    let impulse = |i: usize| {
        let [a, b] = [&exact, &noisy].map(|log| &log.palms()[i]);
        rms((1..SAMPLES).map(|k| b.impulse(k).unwrap().vector - a.impulse(k).unwrap().vector))
    };
    assert!([0, 1].iter().all(|&i| (impulse(i) / 3.0_f64.sqrt() / 3e-5 - 1.0).abs() < 0.03));
    let torque = (0..SAMPLES).step_by(2).map(|k| DVec3::X * (noisy.palms()[2].torque(k).unwrap() - 0.1));
    assert!((rms(torque) / 4e-3 - 1.0).abs() < 0.05);
    assert!(noisy.palms()[2].torque(1).is_none() && noisy.palms()[2].impulse(1).is_none());
}

#[test]
fn noise_repeats_by_seed_and_a_lost_contact_does_not_shift_it() {
    let noisy = log().with_noise(&NOISE, 7).unwrap();
    assert_eq!(log().with_noise(&NOISE, 7).unwrap(), noisy);
    assert_ne!(log().with_noise(&NOISE, 8).unwrap(), noisy);
    assert_eq!(log().with_noise(&ContactNoise::default(), 8).unwrap(), log());
    let mut records = log().records();
    if let ContactPoints::World(points) = &mut records[0].contacts {
        points[100] = None;
    }
    let lost = ContactLog::new(times(SAMPLES), records, None).unwrap().with_noise(&NOISE, 7).unwrap();
    assert!(lost.palms()[0].touch(100).is_none());
    assert_eq!(lost.palms()[0].touch(101), noisy.palms()[0].touch(101));
    assert_eq!(lost.palms()[2].force(3000), noisy.palms()[2].force(3000));
    let nan = ContactNoise { contact: f64::NAN, ..NOISE };
    assert!(log().with_noise(&nan, 7).is_err());
}
