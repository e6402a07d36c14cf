//! Noise that is not as stated, and constants that leave no motion to be found.

use super::frictionless::normal_only;
use super::*;
use crate::faults::SensorFault;
use crate::reliability::{Reason, Reliability};

/// Ten times as noisy as stated windows are of one sample each, and a search from nothing finds no motion of so many nodes.
#[test]
fn contacts_count_as_noisy_as_they_scatter() {
    let exact = normal_only(&rubbed(0.4, 500.0, 0.0));
    for times in [1.0, 10.0] {
        let found = |seed| {
            let log = noisy(&exact, &noise(times * 2e-5, 0.004), seed);
            let found = estimate_contacts(&log, None, &options(noise(2e-5, 0.004))).unwrap();
            assert!(found.reliability.is_reliable(), "{times}, {seed}: {:?}", found.reliability);
            // Of 1200 numbers that hang together the median tells a deviation to a twentieth.
            let rougher = found.evidence.rougher;
            assert!((times.max(1.0)..1.2 * times).contains(&(rougher * 1.1)), "{times}, {seed}: {rougher}");
            errors(&found, &log).0 / 12.0
        };
        let mean = (0..4).map(found).sum::<f64>() / 4.0;
        assert!((0.2..2.5).contains(&mean), "squared errors are {mean} of what is said");
    }
}

/// Over forty natural times a force that is told 5 % too large leaves no motion: what is wrong is told by the first eight.
#[test]
fn what_leaves_no_motion_to_be_found_is_named_by_the_beginning() {
    let exact = normal_only(&rubbed(2.6, 500.0, 0.0));
    let noise = noise(4e-5, 0.001);
    let told = noisy(&exact, &noise, 2);
    let gain = with_records(&told, |i, record| {
        let ForceChannel::Normal(force) = &record.force else { panic!("normal forces") };
        let force = force.iter().map(|f| if i == 1 { f * 1.05 } else { *f }).collect();
        PalmRecord { force: ForceChannel::Normal(force), ..record }
    });
    let found = estimate_contacts(&gain, None, &ContactOptions { suspects: true, ..options(noise) }).unwrap();
    let Reliability::Unreliable(reasons) = &found.reliability else { panic!("relied on") };
    assert!(matches!(reasons[0], Reason::NotConverged { .. }), "{reasons:?}");
    let gain = |reason: &Reason| matches!(reason, Reason::Fault(of) if of.fault == SensorFault::ForceGain { palm: 2 });
    assert!(reasons.iter().any(gain), "{reasons:?}");
}
