//! Contacts that may have one friction, and what is followed of it.

use super::*;
use crate::random::Normal;

/// A reading of 1 N with noise of 2 % and white slip noise of 2 mm/s.
fn noisy(ratio: f64, slip: f64, normal: &mut Normal) -> ContactSeen {
    let exact = reading(ratio, slip);
    let mut both = |deviation: f64| Vector2::new(normal.draw(), normal.draw()) * deviation;
    let (friction, velocity) = (exact.friction + both(0.02), both(2e-3));
    let slip = exact.slip.map(|slip| ContactSlip { velocity: slip.velocity + velocity, ..slip });
    ContactSeen::Read(ContactReading { friction, slip, ..exact })
}

/// Two contacts slide, of one friction or of two: each learns its own, and one that only sticks has what the other one learned where they are of one.
#[test]
fn evidence_tells_whether_contacts_have_one_friction() {
    let alike = ContactFriction::Alike { material: 0 };
    for (frictions, sticks) in [([0.3, 0.3], false), ([0.3, 0.6], false), ([0.3, 0.2], true)] {
        let mut modes = ContactModes::new(&[alike; 2], options()).unwrap();
        let mut normal = Normal::seeded(3);
        for k in 0..150 {
            let slip = 0.05 + 5e-4 * f64::from(k);
            let other = noisy(frictions[1], if sticks { 0.0 } else { slip }, &mut normal);
            let log_density = modes.push(DT, &[noisy(frictions[0], slip, &mut normal), other]).unwrap();
            assert!(log_density.is_finite());
        }
        let learned = [0, 1].map(|i| modes.friction(i).unwrap().coefficient);
        let expected = if sticks { [0.3, 0.3] } else { frictions };
        for (learned, friction) in learned.iter().zip(expected) {
            // A step of the grid is 1.6 %.
            assert!((learned / friction - 1.0).abs() < 0.016, "{learned} {friction}");
        }
        assert_eq!(learned[0] == learned[1], frictions[0] == frictions[1] || sticks, "{learned:?}");
        assert_eq!(modes.odds(1).unwrap().stick > 0.9, sticks, "{:?}", modes.odds(1));
    }
}

/// One that touches without a force that tells anything may slide or stick, and is not off; nothing is learned of its friction.
#[test]
fn a_contact_that_is_known_to_touch_is_not_off() {
    let mut modes = one(ContactFriction::Alike { material: 0 });
    for _ in 0..50 {
        modes.push(DT, &[ContactSeen::Touches]).unwrap();
    }
    let odds = modes.odds(0).unwrap();
    assert!(odds.off == 0.0 && odds.slide.min(odds.stick) > 0.01, "{odds:?}");
    assert_eq!(modes.friction(0), None);
}

/// A contact that sticks at one ratio and then at a higher one, leaves and comes back: frictions that were far from its ratio are followed once it is
/// near them, and the one that it slides at in the end is found among them.
#[test]
fn frictions_that_were_far_are_followed_when_the_ratio_comes_near() {
    let mut modes = one(ContactFriction::Unknown { material: 0 });
    let mut normal = Normal::seeded(4);
    let mut push = |seen| {
        modes.push(DT, &[seen]).unwrap();
        let odds = modes.odds(0).unwrap();
        assert!((sum(odds) - 1.0).abs() < 1e-12, "{odds:?}");
        (modes.contacts[0].followed.iter().filter(|of| **of == Followed::Alone).count(), odds)
    };
    for ratio in [0.15, 0.45, 0.3] {
        let count = (0..100).map(|_| push(noisy(ratio, 0.0, &mut normal)).0).last().unwrap();
        assert!((2..70).contains(&count), "{count} of 160 at {ratio}");
    }
    (0..5).for_each(|_| assert_eq!(push(ContactSeen::Off).1.off, 1.0));
    for k in 0..200 {
        push(noisy(0.7, 1e-3 * f64::from(k), &mut normal));
    }
    let learned = modes.friction(0).unwrap();
    assert!((learned.coefficient / 0.7 - 1.0).abs() < 0.016, "{learned:?}");
    assert!(modes.odds(0).unwrap().slide > 0.99);
}
