//! What was taken as known of the sensors, and is not so.

use super::*;
use crate::faults::{SensorFault, Suspect};
use crate::reliability::{Reason, Reliability};

/// With the sensors' constants tested, the modes being told.
fn tested(log: &ContactLog, noise: ContactNoiseLevel) -> ContactEstimate {
    let options = ContactOptions { suspects: true, ..options(noise) };
    estimate_contacts(log, Some(&modes(log)), &options).unwrap()
}

fn of(found: &ContactEstimate, fault: SensorFault) -> Suspect {
    *found.suspects.iter().find(|suspect| suspect.fault == fault).unwrap()
}

/// The log as palms tell it whose forces are to be changed.
fn forces(log: &ContactLog, change: impl Fn(usize, usize, &[DVec3]) -> DVec3) -> ContactLog {
    let mut records = log.records();
    for (i, record) in records.iter_mut().enumerate() {
        let ForceChannel::Three(told) = &record.force else { panic!("forces of three axes") };
        let changed = (0..told.len()).map(|k| change(i, k, told)).collect();
        record.force = ForceChannel::Three(changed);
    }
    ContactLog::new(log.times().to_vec(), records, log.truth().map(<[_]>::to_vec)).unwrap()
}

/// The log as it is told by a palm that says contacts to be elsewhere along its x axis, m.
fn shifted(log: &ContactLog, palm: usize, by: f64) -> ContactLog {
    let mut records = log.records();
    let ContactPoints::World(points) = &mut records[palm].contacts else { panic!("points in the world") };
    for (k, point) in points.iter_mut().enumerate().filter_map(|(k, point)| Some((k, point.as_mut()?))) {
        *point += log.palms()[palm].motion(k).pose.R_WP * (DVec3::X * by);
    }
    ContactLog::new(log.times().to_vec(), records, log.truth().map(<[_]>::to_vec)).unwrap()
}

#[test]
fn scores_are_standard_normal_where_nothing_is_wrong() {
    let (exact, noise) = (log(0.4, 500.0), noise(4e-5, 0.004));
    let (mut squares, mut count) = (0.0, 0.0);
    for seed in 0..4 {
        let found = tested(&noisy(&exact, &noise, seed), noise);
        assert!(found.reliability.is_reliable(), "{seed}: {:?}", found.reliability);
        assert_eq!(found.suspects.len(), 19, "six of each palm, and a delay");
        for suspect in &found.suspects {
            assert!(suspect.score().abs() < 4.0 && suspect.tolerated > 0.0, "{suspect}");
            squares += suspect.score().powi(2);
            count += 1.0;
        }
    }
    // Nineteen numbers that hang together, worth about six, in four runs.
    let mean: f64 = squares / count;
    assert!((0.3..1.8).contains(&mean), "{mean}");
}

/// Each to first order: to within a fifth of it and four deviations.
#[test]
fn a_wrong_constant_is_named_with_its_value() {
    let (exact, noise) = (log(0.4, 500.0), noise(4e-5, 0.004));
    let told = noisy(&exact, &noise, 5);
    let gain = forces(&told, |i, k, f| if i == 1 { f[k] / 1.05 } else { f[k] });
    let cases = [
        (SensorFault::ForceGain { palm: 2 }, 0.05, gain),
        (SensorFault::ContactOffset { palm: 3, axis: 0 }, 5e-4, shifted(&told, 2, -5e-4)),
    ];
    for (fault, value, log) in cases {
        let found = tested(&log, noise);
        let suspect = of(&found, fault);
        let error = (suspect.value - value).abs();
        assert!(error < 0.2 * value + 4.0 * suspect.deviation, "{suspect}, true {value}");
        let Reliability::Unreliable(why) = &found.reliability else { panic!("{fault}: believed") };
        let named = why.iter().find_map(|reason| match reason {
            Reason::Fault(named) => Some(named.fault),
            _ => None,
        });
        // Over so short a log a gain is hardly told from a bias of the same palm.
        let alike = |named| match named {
            SensorFault::ForceBias { palm } => fault == SensorFault::ForceGain { palm },
            named => named == fault,
        };
        assert!(named.is_some_and(alike), "{why:?}");
    }
}
