//! Noise that is not as stated, and constants that leave no motion to be found.

use super::frictionless::normal_only;
use super::*;
use crate::faults::Constant;
use crate::reliability::{Reason, Reliability};

/// Ten times as noisy as stated windows are of one sample each, and a search from nothing finds no motion of so many nodes.
#[test]
fn readings_count_as_noisy_as_they_scatter() {
    let exact = normal_only(&rubbed(0.4, 500.0, 0.0));
    for [of_contacts, of_forces] in [[1.0, 1.0], [10.0, 1.0], [1.0, 4.0]] {
        let found = |seed| {
            let log = noisy(&exact, &noise(of_contacts * 2e-5, of_forces * 0.002), seed);
            let found = estimate_contacts(&log, None, &options(noise(2e-5, 0.002))).unwrap();
            assert!(found.reliability.is_reliable(), "{seed}: {:?}", found.reliability);
            // Of 1200 numbers on contacts and 600 on forces, which hang together, medians tell deviations to a twentieth and a fourteenth.
            for (rougher, times, within) in
                [(found.evidence.rougher[0], of_contacts, 0.1), (found.evidence.rougher[1], of_forces, 0.2)]
            {
                assert!((rougher / times - 1.0).abs() < within, "{seed}: {rougher} for {times}");
            }
            errors(&found, &log).0 / 12.0
        };
        let mean = (0..4).map(found).sum::<f64>() / 4.0;
        assert!((0.2..2.5).contains(&mean), "squared errors are {mean} of what is said");
    }
}

/// Contacts at taxels a fiftieth of the size apart, where a tenth of that is stated as noise.
#[test]
fn contacts_at_taxels_are_those_of_a_noisy_sensor() {
    let pitch = 0.02 * SIZE;
    let exact = normal_only(&rubbed(0.6, 500.0, 0.0));
    let told = noisy(&exact, &noise(4e-6, 0.002), 4);
    let taxels = with_contacts(&told, |_, _, own| (own / pitch).round() * pitch);
    let found = estimate_contacts(&taxels, None, &options(noise(0.1 * pitch, 0.002))).unwrap();
    assert!(found.reliability.is_reliable(), "{:?}", found.reliability);
    assert!(found.evidence.rougher[0] > 1.0 / (0.1 * 12.0_f64.sqrt()), "{:?}", found.evidence);
    let mean = errors(&found, &taxels).0 / 12.0;
    assert!(mean < 4.0, "squared errors are {mean} of what is said");
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
    let gain =
        |reason: &Reason| matches!(reason, Reason::Fault(of) if of.fault == Constant::ForceGain { palm: 2 });
    assert!(reasons.iter().any(gain), "{reasons:?}");
}
