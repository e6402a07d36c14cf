//! Of palms without friction.

use super::*;
use crate::reliability::{Reason, Reliability};
use contact_kinematics::Palm;
use object_dynamics::integrate::Tolerance;

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

/// What an ellipsoid of a kilogram that is let go between three planes makes palms feel.
pub(super) fn tumbled(axes: DVec3, start: InitialMotion, times: SampleTimes) -> SensorLog {
    tumbled_of(axes, MassProperties::uniform_ellipsoid(1.0, axes).unwrap(), start, times)
}

/// The same of one that need not be uniform.
pub(super) fn tumbled_of(
    axes: DVec3,
    mass: MassProperties,
    start: InitialMotion,
    times: SampleTimes,
) -> SensorLog {
    let palms = [60.0f64, 180.0, 300.0].map(|at| Palm::fixed(at.to_radians(), 60f64.to_radians()).unwrap());
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, G).unwrap();
    scene.simulate(start, times, Tolerance::uniform(1e-13)).unwrap().sensor_log(&scene).unwrap()
}

/// Over nine hundred natural times no step of the whole chain is taken if it integrates the motion from its start alone.
#[test]
fn a_minute_of_a_small_body_is_found() {
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(2.0, 3.0, 2.0) };
    let exact = tumbled(DVec3::new(0.05, 0.04, 0.03), start, SampleTimes { duration: 60.0, rate: 100.0 });
    let level = SensorNoise { contact: 4e-4, force: 0.1, torque: 0.0 };
    let noise = ContactNoiseLevel { force_fixed: level.force, ..noise(level.contact, 0.0) };
    let log = ContactLog::try_from(&exact.with_noise(&level, 1).unwrap()).unwrap();
    let options = ContactOptions { friction: Some(0.0), suspects: false, ..options(noise) };
    let found = estimate_contacts(&log, None, &options).unwrap();
    assert!(found.reliability.is_reliable(), "{:?}", found.reliability);
    for ((state, at), deviations) in found.states.iter().zip(log.truth().unwrap()).zip(&found.deviations) {
        let off = [(state.p_WCm - at.p_WCm) / deviations[0], (state.w_WO - at.w_WO) / deviations[2]];
        let off = off.map(|off| off.abs().max_element());
        assert!(off[0].max(off[1]) < 5.5, "{off:?} deviations");
    }
}

/// Over five natural times of slow rocking the search of an unknown body ends at motions that leave 3 to 40 more than the most probable one, and that hold
/// their own deviations for small: with these draws of noise each was 30 to 42 deviations off, relied on, before bodies were flung from other starts.
#[test]
fn what_a_short_log_leaves_open_is_looked_for_from_many_starts() {
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.3, 0.3) };
    let times = SampleTimes { duration: 2.0, rate: 100.0 };
    let exact = tumbled(DVec3::new(1.0, 2.0, 2.5), start, times);
    let level = SensorNoise { contact: 0.025, force: 0.065, torque: 0.0 };
    let floor = 3e-5 * G.sqrt();
    let noise = ContactNoiseLevel { force_fixed: level.force, floor, ..noise(level.contact, 0.0) };
    let options = ContactOptions { friction: Some(0.0), ..options(noise) };
    for seed in [8102, 8106, 8112, 8118] {
        let log = ContactLog::try_from(&exact.with_noise(&level, seed).unwrap()).unwrap();
        let found = estimate_contacts(&log, None, &options).unwrap();
        let (state, at, of) = (found.states[0], log.truth().unwrap()[0], found.deviations[0]);
        let off = [(state.p_WCm - at.p_WCm) / of[0], (state.w_WO - at.w_WO) / of[2]];
        let worst = off.into_iter().map(|off| off.abs().max_element()).fold(0.0, f64::max);
        assert!(worst < 5.0 || !found.reliability.is_reliable(), "{seed}: {worst} deviations in silence");
    }
}

/// At more than 0.4 natural times from sample to sample nobody knows what forces do in between.
#[test]
fn samples_too_far_apart_are_refused_by_name() {
    let noise = noise(4e-5, 0.004);
    let natural = (SIZE / G).sqrt();
    for (spacing, refused) in [(0.3, false), (0.5, true)] {
        let log = noisy(&normal_only(&rubbed(2.0, 1.0 / (spacing * natural), 0.0)), &noise, 1);
        let options = ContactOptions { size: Some(SIZE), ..options(noise) };
        let found = estimate_contacts(&log, None, &options).unwrap();
        let told = matches!(&found.reliability, Reliability::Unreliable(reasons)
            if reasons.iter().any(|of| matches!(of, Reason::TooSparse { most, .. } if (most / natural - 0.4).abs() < 1e-9)));
        assert_eq!(told, refused, "{:?}", found.reliability);
    }
}
