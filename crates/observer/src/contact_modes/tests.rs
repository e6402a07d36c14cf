//! What every sample must obey.

mod alike;
mod between_cells;
mod doubts;

use super::asleep::Followed;
use super::*;
use nalgebra::{Matrix2, Matrix2x6, Matrix6, Vector2};

const DT: f64 = 1e-3;

fn options() -> ContactModesOptions {
    ContactModesOptions::new(0.6, 0.01, 1.0)
}

fn one(friction: ContactFriction) -> ContactModes {
    ContactModes::new(&[friction], options()).unwrap()
}

/// Of 1 N along the normal with noise of 2 %, and a slip against the friction with noise of 2 mm/s.
fn reading(ratio: f64, slip: f64) -> ContactReading {
    let covariance = Matrix2::identity() * 4e-6;
    ContactReading {
        normal_force: 1.0,
        friction: Vector2::new(0.6 * ratio, 0.8 * ratio),
        force_deviation: 0.02,
        slip: Some(ContactSlip { velocity: Vector2::new(-0.6 * slip, -0.8 * slip), covariance }),
        touches: false,
    }
}

fn seen(ratio: f64, slip: f64) -> [ContactSeen; 1] {
    [ContactSeen::Read(reading(ratio, slip))]
}

fn sum(odds: ContactOdds) -> f64 {
    odds.off + odds.slide + odds.stick
}

#[test]
fn clear_cases_are_told_and_a_loss_is_seen() {
    for friction in [ContactFriction::Known(0.3), ContactFriction::Unknown { material: 7 }] {
        let mut modes = one(friction);
        for _ in 0..50 {
            modes.push(DT, &seen(0.1, 0.0)).unwrap();
        }
        // Where the friction is not known, a ratio that stays the same may be it.
        let sure = if matches!(friction, ContactFriction::Known(_)) { 0.99 } else { 0.9 };
        assert!(modes.odds(0).unwrap().stick > sure);
        assert_eq!(modes.friction(0), None, "nothing slid");
        for _ in 0..200 {
            modes.push(DT, &seen(0.3, 0.1)).unwrap();
        }
        assert!(modes.odds(0).unwrap().slide > 0.99);
        if let ContactFriction::Unknown { .. } = friction {
            let learned = modes.friction(0).unwrap();
            assert!((learned.coefficient - 0.3).abs() < 2.0 * learned.deviation, "{learned:?}");
            assert!(learned.deviation < 0.01 && learned.deviation > 0.001, "{learned:?}");
        } else {
            assert_eq!(modes.friction(0), None, "it was stated");
        }
        let unloaded = ContactReading {
            normal_force: 0.008,
            friction: Vector2::new(-0.01, 0.005),
            force_deviation: 0.01,
            slip: None,
            touches: false,
        };
        for _ in 0..20 {
            modes.push(DT, &[ContactSeen::Read(unloaded)]).unwrap();
        }
        assert!(modes.odds(0).unwrap().off > 0.99, "{:?}", modes.odds(0));
        modes.push(DT, &[ContactSeen::Read(ContactReading { touches: true, ..unloaded })]).unwrap();
        assert_eq!(modes.odds(0).unwrap().off, 0.0);
        modes.push(DT, &[ContactSeen::Read(ContactReading { normal_force: -0.1, ..unloaded })]).unwrap();
        assert_eq!(modes.odds(0).unwrap().off, 1.0);
        assert_eq!(modes.label(0), Some(object_dynamics::ContactMode::Off));
    }
    assert_eq!(one(ContactFriction::Known(0.3)).label(0), None);
    assert_eq!(one(ContactFriction::Known(0.3)).odds(1), None);
}

/// Of two contacts of one unknown friction, with forces known to 0.1 %, one slides while the ratio of the other falls slowly through the grid: its friction is not given up
/// for those that the other one passes by (bins are narrow next to each, and foretold its ratio the better).
#[test]
fn a_friction_that_is_known_is_kept_while_another_ratio_passes_by() {
    let precise = |ratio: f64, slip: f64, k: u32| {
        let mut random = crate::random::Normal::seeded(u64::from(k));
        let mut noise = || 1e-3 * random.draw();
        let friction = Vector2::new(ratio + noise(), 0.0);
        let velocity = Vector2::new(-slip + 0.6 * noise(), 0.6 * noise());
        let slip = Some(ContactSlip { velocity, covariance: Matrix2::identity() * 3.6e-7 });
        let (normal_force, force_deviation, touches) = (1.0 + noise(), 1e-3, false);
        ContactSeen::Read(ContactReading { normal_force, friction, force_deviation, slip, touches })
    };
    let mut options = options();
    options.slip_errors_last = 0.05;
    let mut modes = ContactModes::new(&[ContactFriction::Unknown { material: 1 }; 2], options).unwrap();
    for k in 0..400 {
        let falls = 0.395 - 2e-4 * f64::from(k);
        modes.push(DT, &[precise(0.408, 0.02, 2 * k), precise(falls, 0.0, 2 * k + 1)]).unwrap();
    }
    let (odds, learned) = (modes.odds(0).unwrap(), modes.friction(0).unwrap());
    assert!(odds.slide > 0.99 && modes.odds(1).unwrap().stick > 0.99, "{odds:?}");
    assert!((learned.coefficient - 0.408).abs() < 2.0 * learned.deviation, "{learned:?}");
}

/// The density of the first sample against sums over the cells' own densities, written down directly.
#[test]
fn the_density_of_the_first_sample() {
    let mut modes = one(ContactFriction::Known(0.3));
    let found = modes.push(DT, &[ContactSeen::Read(reading(0.29, 0.03))]).unwrap();
    let tau = std::f64::consts::TAU;
    let normal = |x: f64, v: f64| (-x * x / (2.0 * v)).exp() / (tau * v).sqrt();
    let (r, s, speed) = (0.29_f64, 0.03 / 0.6, 0.6_f64);
    let sr = 0.02 * (1.0 + r * r).sqrt();
    let v = 4e-6 / (speed * speed);
    let turn = sr / r;
    let count = 200_000;
    // Landing speeds are half-normal, with deviation 0.15; ratios anywhere in the disc. Bins blur both.
    let slide: f64 = (0..count)
        .map(|k| {
            let x = 1.2 * (k as f64 + 0.5) / f64::from(count);
            2.0 * normal(x, 0.15 * 0.15) * normal(s - x, v) * normal(0.0, v + (turn * x).powi(2)) * 1.2
                / f64::from(count)
        })
        .sum();
    let slide = slide * normal(r - 0.3, sr * sr) / (tau * r);
    let stick: f64 = (0..count)
        .map(|k| {
            let q = 0.3 * (k as f64 + 0.5) / f64::from(count);
            2.0 * q / 0.09 * normal(r - q, sr * sr) * 0.3 / f64::from(count)
        })
        .sum();
    let stick = stick / (tau * r) * normal(s, v + 1e-6) * normal(0.0, v + 1e-6);
    let expected = ((slide + stick) / 3.0 * (-1.0_f64).exp()).ln();
    assert!((found - expected).abs() < 0.15, "{found} {expected}");
}

#[test]
fn contacts_of_known_friction_are_apart_and_those_of_one_material_together() {
    let known = ContactFriction::Known(0.4);
    let mut pair = ContactModes::new(&[known; 2], options()).unwrap();
    let (mut first, mut second) = (one(known), one(known));
    for k in 0..30 {
        let (a, b) = (seen(0.3, 0.0)[0], seen(0.4, 1e-3 * f64::from(k))[0]);
        let both = pair.push(DT, &[a, b]).unwrap();
        let apart = first.push(DT, &[a]).unwrap() + second.push(DT, &[b]).unwrap();
        assert!((both - apart).abs() < 1e-9);
    }
    assert_eq!((pair.odds(0), pair.odds(1)), (first.odds(0), second.odds(0)));
    // One slides at 0.3 and tells the other, which sticks at 0.2, what the friction is.
    let material = |m| ContactFriction::Unknown { material: m };
    let mut shared = ContactModes::new(&[material(1), material(1), material(2)], options()).unwrap();
    let sticks = ContactSeen::Read(ContactReading { slip: None, ..reading(0.2, 0.0) });
    for _ in 0..100 {
        shared.push(DT, &[seen(0.3, 0.1)[0], sticks, sticks]).unwrap();
    }
    assert_eq!(shared.friction(0), shared.friction(1));
    assert_eq!(shared.friction(2), None, "a plateau of the forces alone is no sliding");
    let told = shared.odds(1).unwrap();
    assert!(told.stick > 0.99, "{told:?}");
}

#[test]
fn outliers_and_gaps_leave_numbers() {
    for friction in [ContactFriction::Known(0.3), ContactFriction::Unknown { material: 0 }] {
        let mut modes = one(friction);
        for _ in 0..20 {
            modes.push(DT, &seen(0.29, 0.05)).unwrap();
        }
        let far = reading(1e5, -1e6);
        for (dt, seen) in [
            (1e-9, [ContactSeen::Read(ContactReading { force_deviation: 1.0, ..far })]),
            (999.0, seen(0.29, 0.05)),
            (1e-12, [ContactSeen::Off]),
            (1e-12, [ContactSeen::Read(ContactReading { touches: true, ..reading(0.0, 0.0) })]),
            (1e-300, seen(1e3, 1e3)),
            (1e-3, [ContactSeen::Missing]),
        ] {
            let density = modes.push(dt, &seen).unwrap();
            let odds = modes.odds(0).unwrap();
            assert!(density.is_finite() && (sum(odds) - 1.0).abs() < 1e-12, "{seen:?} {density} {odds:?}");
        }
        for _ in 0..30 {
            modes.push(DT, &seen(0.29, 0.05)).unwrap();
        }
        assert!(modes.odds(0).unwrap().slide > 0.99);
    }
}

/// Only numbers without unit count: forces in another unit, lengths in another, give the same odds.
#[test]
fn odds_do_not_depend_on_units() {
    let mut here = one(ContactFriction::Known(0.3));
    let there_options = ContactModesOptions::new(600.0, 10.0, 1000.0);
    let mut there = ContactModes::new(&[ContactFriction::Known(0.3)], there_options).unwrap();
    for k in 0..100 {
        let own = reading(0.25 + 1e-3 * f64::from(k % 60), 1e-4 * f64::from(k));
        let slip = own.slip.unwrap();
        let scaled = ContactReading {
            normal_force: 1e3 * own.normal_force,
            friction: 1e3 * own.friction,
            force_deviation: 1e3 * own.force_deviation,
            slip: Some(ContactSlip { velocity: 1e3 * slip.velocity, covariance: 1e6 * slip.covariance }),
            ..own
        };
        let a = here.push(DT, &[ContactSeen::Read(own)]).unwrap();
        let b = there.push(DT, &[ContactSeen::Read(scaled)]).unwrap();
        assert!((a - b - 1e3_f64.ln()).abs() < 1e-9, "a density per newton");
        assert!((here.odds(0).unwrap().slide - there.odds(0).unwrap().slide).abs() < 1e-10);
    }
}

#[test]
fn what_is_wrong_is_named_and_nothing_changes() {
    let mut modes = one(ContactFriction::Known(0.3));
    modes.push(DT, &seen(0.2, 0.0)).unwrap();
    let before = modes.odds(0);
    let good = reading(0.2, 0.0);
    let slip = good.slip.unwrap();
    let with_slip = |slip| ContactReading { slip: Some(slip), ..good };
    let singular = Matrix2::new(1.0, 1.0, 1.0, 1.0);
    let cases = [
        (ContactReading { normal_force: f64::NAN, ..good }, "normal force of contact 0 at sample 1 is NaN"),
        (
            ContactReading { friction: Vector2::new(0.0, f64::INFINITY), ..good },
            "friction of contact 0 at sample 1 is inf",
        ),
        (
            ContactReading { force_deviation: 0.0, ..good },
            "deviation of the force of contact 0 at sample 1 is 0",
        ),
        (ContactReading { force_deviation: 1e-300, ..good }, "force, in deviations of contact 0"),
        (with_slip(ContactSlip { velocity: Vector2::new(f64::NAN, 0.0), ..slip }), "slip of contact 0"),
        (
            with_slip(ContactSlip { velocity: Vector2::new(1e300, 0.0), ..slip }),
            "slip, in natural speeds of contact 0",
        ),
        (
            with_slip(ContactSlip { covariance: -slip.covariance, ..slip }),
            "variance of the slip of contact 0",
        ),
        (with_slip(ContactSlip { covariance: singular, ..slip }), "determinant of the slip's covariance"),
    ];
    for (reading, words) in cases {
        let error = modes.push(DT, &[ContactSeen::Read(reading)]).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    for dt in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let error = modes.push(dt, &seen(0.2, 0.0)).unwrap_err();
        assert!(matches!(error, ContactModesError::TimeStep { sample: 1, .. }), "{error}");
    }
    let error = modes.push(DT, &[]).unwrap_err();
    assert!(matches!(error, ContactModesError::Contacts { found: 0, needed: 1, .. }), "{error}");
    let slopes = [Matrix2x6::zeros()];
    for covariance in [Matrix6::zeros(), Matrix6::identity() * f64::NAN, -Matrix6::identity()] {
        let twist = TwistError { slopes: &slopes, covariance: &covariance };
        let error = modes.push_with_twist(DT, &seen(0.2, 0.0), &twist).unwrap_err();
        assert_eq!(error, ContactModesError::TwistCovariance { sample: 1 });
    }
    let covariance = Matrix6::identity();
    let error =
        modes.push_with_twist(DT, &seen(0.2, 0.0), &TwistError { slopes: &[], covariance: &covariance });
    assert!(error.unwrap_err().to_string().contains("slopes of 0 contact(s)"));
    assert_eq!((modes.odds(0), modes.samples()), (before, 1));
    for value in [0.0, -0.3, f64::NAN, f64::INFINITY, 11.0] {
        let error =
            ContactModes::new(&[ContactFriction::Known(0.3), ContactFriction::Known(value)], options());
        assert!(matches!(error.unwrap_err(), ContactModesError::Friction { contact: 1, .. }));
    }
    let refused = |options| ContactModes::new(&[ContactFriction::Known(0.3)], options).unwrap_err();
    assert_eq!(ContactModes::new(&[], options()).unwrap_err(), ContactModesError::NoContact);
    let no_speed = ContactModesOptions { natural_speed: 0.0, ..options() };
    assert!(refused(no_speed).to_string().contains("natural speed is 0"));
    for slip_errors_last in [-1e-3, 1e3, f64::NAN] {
        assert!(
            refused(ContactModesOptions { slip_errors_last, ..options() })
                .to_string()
                .contains("time for which errors of slips last")
        );
    }
    assert!(matches!(
        refused(ContactModesOptions { label_level: 1.0, ..options() }),
        ContactModesError::Label(_)
    ));
}

/// A twist that is known exactly adds nothing.
#[test]
fn a_twist_without_error_changes_nothing() {
    let mut plain = one(ContactFriction::Known(0.3));
    let mut with_twist = plain.clone();
    let slopes = [Matrix2x6::from_fn(|i, j| f64::from(i == j))];
    let covariance = Matrix6::identity() * 1e-16;
    for k in 0..60 {
        let seen = seen(0.28, 5e-4 * f64::from(k));
        let a = plain.push(DT, &seen).unwrap();
        let b = with_twist
            .push_with_twist(DT, &seen, &TwistError { slopes: &slopes, covariance: &covariance })
            .unwrap();
        assert!((a - b).abs() < 1e-6);
        assert!((plain.odds(0).unwrap().slide - with_twist.odds(0).unwrap().slide).abs() < 1e-7);
    }
}
