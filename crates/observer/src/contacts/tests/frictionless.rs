//! Of palms without friction.

use super::*;

/// A log with the normal forces alone.
pub(super) fn normal_only(log: &ContactLog) -> ContactLog {
    with_records(log, |i, record| {
        let palm = &log.palms()[i];
        let along = |k: usize| Some(palm.force(k)?.vector.dot(palm.touch(k)?.n.get()));
        let force = (0..log.times().len()).map(|k| along(k).unwrap_or(0.0)).collect();
        PalmRecord { force: ForceChannel::Normal(force), impulse: ForceChannel::Missing, ..record }
    })
}

#[test]
fn their_normal_force_is_enough() {
    let exact = normal_only(&rubbed(0.4, 500.0, 0.0));
    let noise = noise(4e-5, 0.004);
    let (mut sum, runs) = (0.0, 6);
    for seed in 0..runs {
        let log = noisy(&exact, &noise, seed);
        let found = estimate_contacts(&log, None, &options(noise)).unwrap();
        assert!(found.reliability.is_reliable(), "{seed}: {:?}", found.reliability);
        sum += errors(&found, &log).0;
    }
    let mean = sum / (12.0 * runs as f64);
    assert!((0.3..2.0).contains(&mean), "squared errors are {mean} of what is said");
}

#[test]
fn friction_that_is_not_ruled_out_needs_all_of_the_force() {
    let log = normal_only(&rubbed(0.05, 500.0, 0.1));
    let refused = estimate_contacts(&log, None, &options(noise(4e-5, 0.004)));
    assert_eq!(refused.unwrap_err(), ContactEstimateError::NoForce { palm: 1 });
}

#[test]
fn an_exact_log_gives_the_motion_to_what_integration_leaves() {
    let log = normal_only(&rubbed(0.4, 1000.0, 0.0));
    let noise = ContactNoiseLevel { floor: 1e-7 * (G * SIZE).sqrt(), ..noise(0.0, 0.0) };
    let found = estimate_contacts(&log, None, &options(noise)).unwrap();
    assert!(found.reliability.is_reliable(), "{:?}", found.reliability);
    let pairs = found.states.iter().zip(log.truth().unwrap());
    let worst = pairs.map(|(state, at)| state.p_WCm.distance(at.p_WCm)).fold(0.0, f64::max);
    // Orientations are integrated to fourth order in the time between samples over the natural time.
    let fourth = (1e-3 / (SIZE / G).sqrt()).powi(4);
    assert!(worst < 3.0 * fourth * SIZE, "{worst} m");
    assert!((found.mass / 0.2 - 1.0).abs() < fourth, "{}", found.mass);
}

/// Over forty natural times no search of the whole log ends at its motion: it is found over the beginning and carried on.
#[test]
fn a_log_of_many_natural_times_is_found() {
    let exact = normal_only(&rubbed(2.6, 500.0, 0.0));
    let lasts = exact.duration() / (SIZE / G).sqrt();
    assert!(lasts > 35.0, "{lasts} natural times: contact was lost");
    let noise = noise(4e-5, 0.004);
    for seed in 0..3 {
        let log = noisy(&exact, &noise, seed);
        let found = estimate_contacts(&log, None, &options(noise)).unwrap();
        assert!(found.reliability.is_reliable(), "{seed}: {:?}", found.reliability);
        let mean = errors(&found, &log).0 / 12.0;
        assert!(mean < 4.0, "{seed}: squared errors are {mean} of what is said");
        for ((state, at), deviations) in found.states.iter().zip(log.truth().unwrap()).zip(&found.deviations)
        {
            let off = ((state.p_WCm - at.p_WCm) / deviations[0]).abs().max_element();
            assert!(off < 5.0, "{seed}: {off} deviations");
        }
    }
}

/// One contact of a hundred a fifth of the size off: they are found, all but those that noise hides, and no other; the motion is that without them.
#[test]
fn misread_contacts_are_told_and_survived() {
    let exact = normal_only(&rubbed(0.8, 500.0, 0.0));
    let noise = noise(4e-5, 0.004);
    let told = noisy(&exact, &noise, 3);
    let mut records = told.records();
    let mut off = Vec::new();
    for (i, record) in records.iter_mut().enumerate() {
        let ContactPoints::World(points) = &mut record.contacts else { panic!("points in the world") };
        // Two side by side, the others alone.
        for k in [37, 110, 111, 250 + 7 * i] {
            let x = told.palms()[i].motion(k).pose.R_WP * DVec3::X;
            *points[k].as_mut().unwrap() += x * (0.2 * SIZE);
            off.push((k, i));
        }
    }
    off.sort_unstable();
    let wrong = ContactLog::new(told.times().to_vec(), records, told.truth().map(<[_]>::to_vec)).unwrap();
    let [right, found] = [&told, &wrong].map(|log| estimate_contacts(log, None, &options(noise)).unwrap());
    assert!(right.misread.is_empty(), "{:?}", right.misread);
    assert_eq!(found.misread, off);
    assert!(found.reliability.is_reliable(), "{:?}", found.reliability);
    for ((a, b), deviations) in found.states.iter().zip(&right.states).zip(&right.deviations) {
        assert!(((a.p_WCm - b.p_WCm) / deviations[0]).abs().max_element() < 1.0);
    }
}
