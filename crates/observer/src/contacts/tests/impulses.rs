//! Measured impulses in place of integrals of forces at samples.

use super::super::record::{Interval, Record};
use super::*;

const SHARE: f64 = 0.004;

fn with_impulses(noise: ContactNoiseLevel, share: f64) -> ContactNoiseLevel {
    ContactNoiseLevel { impulse: Some(ImpulseNoise { fixed: 0.0, share }), ..noise }
}

/// The log with its palms as `change` leaves them.
fn changed(log: &ContactLog, change: impl Fn(usize, &mut PalmRecord)) -> ContactLog {
    with_records(log, |i, mut record| {
        change(i, &mut record);
        record
    })
}

fn without_forces(log: &ContactLog) -> ContactLog {
    changed(log, |_, record| record.force = ForceChannel::Missing)
}

/// Two millimetres above its palms: it falls on one after the other, each time with a blow that no sample sees.
fn fall(seconds: f64) -> ContactLog {
    let (scene, start) = scene(0.1, 2e-3);
    let start = ContactStart { in_flight: true, ..ContactStart::touching(start) };
    simulated(&scene, &start, seconds, 500.0)
}

/// Impulse, moment about the world's origin and first moment of the force over the whole record.
fn total(record: &Record) -> [DVec3; 3] {
    let (mut after, mut sums) = (0.0, [DVec3::ZERO; 3]);
    for Interval { h, impulse, first, .. } in &record.intervals {
        sums[0] += impulse.force;
        sums[1] += impulse.moment + record.origin.cross(impulse.force);
        sums[2] += after * impulse.force + *first;
        after += h;
    }
    sums
}

#[test]
fn links_have_the_impulses_of_the_log_through_blows() {
    let log = fall(0.3);
    let noise = with_impulses(noise(0.0, 0.0), SHARE);
    for log in [&log, &without_forces(&log)] {
        let record = Record::new(log, &options(noise)).unwrap();
        assert!(record.all_impulses);
        for (k, interval) in (1..).zip(&record.intervals) {
            let measured: DVec3 = log.palms().iter().map(|palm| palm.impulse(k).unwrap().vector).sum();
            assert!((interval.impulse.force - measured).length() < 1e-15, "{k}");
        }
        // The momentum that the body has at the end, to what the simulation is good to.
        let (first, last) = (log.truth().unwrap()[0], log.truth().unwrap()[log.times().len() - 1]);
        let gained = (last.v_WCm - first.v_WCm + DVec3::Z * G * log.duration()) * 0.2;
        assert!((total(&record)[0] - gained).length() < 1e-9, "{:?} {gained}", total(&record)[0]);
    }
    let by_forces = Record::new(&log, &options(super::noise(0.0, SHARE))).unwrap();
    let missed = total(&by_forces)[0] - total(&Record::new(&log, &options(noise)).unwrap())[0];
    assert!(missed.length() > 1e-3, "samples of the force see the blows: {missed}");
}

#[test]
fn moments_are_of_fourth_order_in_the_time_between_samples() {
    // All at rest against nothing: a run without any change of modes.
    let (scene, start) = scene(0.1, 0.0);
    let times = |rate: f64| SampleTimes { duration: 0.02, rate };
    let at = |rate: f64| {
        let run = scene.simulate(&ContactStart::touching(start), times(rate), 1e-12).unwrap();
        ContactLog::from_simulation(&scene, &run).unwrap()
    };
    let fine = at(16_000.0);
    assert!(modes(&fine).iter().all(|modes| *modes == super::modes(&fine)[0]), "a mode changes");
    let noise = with_impulses(noise(0.0, 0.0), SHARE);
    let truth = total(&Record::new(&fine, &options(super::noise(0.0, 0.0))).unwrap());
    let errors = |rate: f64| {
        let found = total(&Record::new(&at(rate), &options(noise)).unwrap());
        [1, 2].map(|i| (found[i] - truth[i]).length())
    };
    let (coarse, half) = (errors(500.0), errors(1000.0));
    for i in 0..2 {
        // Order 4 is a ratio of 16; 3.5 tells it from 3.
        assert!(coarse[i] > 11.0 * half[i], "{coarse:?} {half:?}");
    }
}

#[test]
fn a_push_between_samples_is_an_impulse_of_unknown_place_and_time() {
    let log = log(0.1, 500.0);
    let push = DVec3::new(0.0, 0.0, 1e-3);
    let noise = with_impulses(noise(0.0, 0.0), SHARE);
    // Palm 2 is touched at none of three samples, and gives an impulse between two of them.
    let interval = |given: DVec3| {
        let lost = changed(&log, |i, record| {
            if let (1, ContactPoints::World(points), ForceChannel::Three(sums)) =
                (i, &mut record.contacts, &mut record.impulse)
            {
                points[19..22].fill(None);
                let more = given - (sums[21] - sums[20]);
                sums[21..].iter_mut().for_each(|sum| *sum += more);
            }
        });
        Record::new(&lost, &options(noise)).unwrap().intervals[20]
    };
    let (with, none) = (interval(push), interval(DVec3::ZERO));
    assert!(with.blow && !none.blow);
    assert!((with.impulse.force - none.impulse.force - push).length() < 1e-15);
    let wider = with.noise.white - none.noise.white;
    // The arm across the push is unknown by a tenth of the body at least.
    assert!(wider[(3, 3)].sqrt() > 0.1 * SIZE * push.z && wider[(5, 5)].abs() < 1e-12 * wider[(3, 3)]);
}

#[test]
fn a_fall_is_known_through_its_blows_to_within_its_deviations() {
    let exact = fall(0.4);
    let noise = noise(4e-5, SHARE);
    let log = noisy(&exact, &noise, 4);
    let noise = with_impulses(noise, SHARE);
    for log in [&log, &without_forces(&log)] {
        let found = estimate_contacts(log, Some(&modes(&exact)), &options(noise)).unwrap();
        assert!(found.reliability.is_reliable(), "{:?} {:?}", found.reliability, found.evidence);
        assert!(found.relied_on.iter().all(|relied| *relied));
        let (squares, mass) = errors(&found, &exact);
        assert!(
            (0.1..1.6).contains(&(squares / 12.0)),
            "squared errors are {} of what is said",
            squares / 12.0
        );
        assert!(mass < 4.0 * found.mass_deviation, "{mass} {}", found.mass_deviation);
        // Blows are what tells the inertia: with their impulses open it is not learned.
        let worst = found.inertia_deviations.into_iter().fold(0.0, f64::max);
        assert!(worst < 0.3, "{:?}", found.inertia_deviations);
    }
}

#[test]
fn errors_with_impulses_are_as_large_as_they_are_said_to_be() {
    let exact = log(0.3, 500.0);
    let runs = 4;
    // All palms by impulses alone, and one of them, the others by forces alone.
    for mixed in [false, true] {
        let mut sum = 0.0;
        for seed in 0..runs {
            let noise = noise(4e-5, SHARE);
            let log = changed(&noisy(&exact, &noise, seed), |i, record| {
                let channel = if mixed && i > 0 { &mut record.impulse } else { &mut record.force };
                *channel = ForceChannel::Missing;
            });
            let options = options(with_impulses(noise, SHARE));
            let found = estimate_contacts(&log, Some(&modes(&exact)), &options).unwrap();
            let (squares, mass) = errors(&found, &exact);
            assert!(mass < 5.0 * found.mass_deviation, "{seed}: {mass} {}", found.mass_deviation);
            sum += squares;
        }
        let mean = sum / (12.0 * runs as f64);
        assert!((0.4..1.6).contains(&mean), "mixed {mixed}: squared errors are {mean} of what is said");
    }
}

#[test]
fn impulses_count_where_their_noise_is_stated() {
    let exact = log(0.1, 500.0);
    let blind = without_forces(&exact);
    let (unread, read) = (noise(4e-5, SHARE), with_impulses(noise(4e-5, SHARE), SHARE));
    let modes = modes(&exact);
    let refused = estimate_contacts(&blind, Some(&modes), &options(unread)).unwrap_err();
    assert_eq!(refused, ContactEstimateError::NoForce { palm: 1 });
    assert!(refused.to_string().contains("impulse"), "{refused}");
    let found = estimate_contacts(&blind, Some(&modes), &options(read)).unwrap();
    assert_eq!(found.states.len(), exact.times().len());
    // A normal impulse is not enough.
    let normal = changed(&blind, |_, record| {
        record.impulse = ForceChannel::Normal(vec![0.0; exact.times().len()]);
    });
    let refused = estimate_contacts(&normal, Some(&modes), &options(read)).unwrap_err();
    assert_eq!(refused, ContactEstimateError::NoForce { palm: 1 });
}

#[test]
fn modes_are_told_from_impulses() {
    // It slides for a tenth of half a second: in less, the ratios of sliding are more than a tenth of all.
    let exact = rubbed(0.3, 1000.0, 0.3);
    let noise = noise(4e-5, 0.01);
    let log = without_forces(&noisy(&exact, &noise, 3));
    let found = estimate_contacts(&log, None, &options(with_impulses(noise, 0.01))).unwrap();
    let (mut sticks, mut told) = (0, 0);
    for (true_modes, modes) in modes(&exact).iter().zip(&found.modes) {
        for (truth, mode) in true_modes.iter().zip(modes) {
            assert!((*truth, *mode) != (ContactMode::Slide, ContactMode::Stick), "a slip is taken for none");
            sticks += usize::from(*truth == ContactMode::Stick);
            told += usize::from(*mode == ContactMode::Stick);
        }
    }
    assert!(sticks > 300 && 2 * told > sticks, "{told} of {sticks} that stick");
    assert!(found.evidence.misfit < 1.5);
}
