//! Readings that are not as stated.

use super::*;
use crate::random::Normal;

/// A contact at 1 kHz that sticks for 150 ms with a ratio that grows to the friction, slides for 150 ms with a speed that rises and falls, and so on;
/// forces come `late` samples after slips. Noise of 2 % and 2 mm/s.
fn stick_and_slide(late: usize, count: usize) -> Vec<ContactSeen> {
    let mut normal = Normal::seeded(5);
    let at = |k: usize| {
        let (within, s) = (k % 300, (k % 150) as f64 / 150.0);
        if within < 150 { (0.3 * (0.3 + 0.7 * s), 0.0) } else { (0.3, 0.3 * s * (1.0 - s)) }
    };
    let read = |k: usize| {
        let (ratio, slip) = (at(k.saturating_sub(late)).0, at(k).1);
        let mut both = |deviation: f64| Vector2::new(normal.draw(), normal.draw()) * deviation;
        let (force, velocity, along) = (both(0.02), both(2e-3), both(0.02).x);
        let exact = reading(ratio, slip);
        ContactSeen::Read(ContactReading {
            normal_force: exact.normal_force + along,
            friction: exact.friction + force,
            slip: exact.slip.map(|slip| ContactSlip { velocity: slip.velocity + velocity, ..slip }),
            ..exact
        })
    };
    (0..count).map(read).collect()
}

/// By a stream that knows the friction, and of the whole log that learns it.
fn doubts(seen: &[ContactSeen]) -> [Vec<ContactModesDoubt>; 2] {
    let mut modes = one(ContactFriction::Known(0.3));
    seen.iter().for_each(|seen| assert!(modes.push(DT, &[*seen]).is_ok()));
    let times: Vec<f64> = (0..seen.len()).map(|k| DT * k as f64).collect();
    let whole = whole_modes(&times, &[seen.to_vec()], &options()).unwrap();
    [modes.doubts().collect(), whole.doubts]
}

#[test]
fn forces_that_are_late_are_doubted_and_others_are_not() {
    assert_eq!(doubts(&stick_and_slide(0, 900)), [Vec::new(), Vec::new()]);
    for doubts in doubts(&stick_and_slide(36, 900)) {
        let doubt = doubts.first().unwrap();
        assert_eq!((doubts.len(), doubt.about), (1, DoubtedReading::LateForces));
        assert!(doubt.by == 0.024 || doubt.by == 0.048, "{doubt:?}");
        assert!(doubt.to_string().starts_with("forces of contact 1 go better"), "{doubt}");
    }
}

/// A ratio that stays the same for long looks like a friction, until it does not: the true one is found nevertheless.
#[test]
fn a_friction_that_looks_well_for_a_while_is_not_taken() {
    let mut normal = Normal::seeded(2);
    let noise = 1e-3;
    let seen: Vec<ContactSeen> = (0..900)
        .map(|k| {
            let (ratio, slip) = match k {
                0..400 => (0.25, 0.0),
                400..500 => (0.25 + 5e-4 * (k - 400) as f64, 0.0),
                _ => (0.3, 1e-3 * (k - 499) as f64),
            };
            let exact = ContactReading { force_deviation: noise, ..reading(ratio, slip) };
            let mut both = |deviation: f64| Vector2::new(normal.draw(), normal.draw()) * deviation;
            let slip = exact.slip.map(|slip| ContactSlip { velocity: slip.velocity + both(2e-3), ..slip });
            ContactSeen::Read(ContactReading { friction: exact.friction + both(noise), slip, ..exact })
        })
        .collect();
    let times: Vec<f64> = (0..900).map(|k| DT * f64::from(k)).collect();
    let lasting = ContactModesOptions { slip_errors_last: 0.05, ..options() };
    let learned = whole_modes(&times, &[seen], &lasting).unwrap().frictions[0].unwrap();
    assert!((learned.coefficient - 0.3).abs() < 2.0 * learned.deviation, "{learned:?}");
}
