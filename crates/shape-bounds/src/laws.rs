//! What holds for the bounds of all contacts: laws that relate one result to another.

use crate::generators::{AXES, Source};
use crate::strategies::{contacts, exact_isometry, shuffled};
use crate::{BoundsError, ContactSample, IncrementalBounds, ShapeBounds};
use contact_kinematics::Direction;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

/// Half-spaces are moved out by 8 units of rounding of the largest coordinate, by the incremental form of twice it.
const ROUNDED: f64 = 3.0 * 16.0 * AXES.x * f64::EPSILON;

/// So many cases, the same ones each time.
fn cases(count: u32) -> Config {
    let cases = crate::few_or_all(count, 20 * count);
    Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(19), ..Config::default() }
}

/// Where the upper bound reaches to: what is computed of it is rounded at that size.
fn reach(bounds: &ShapeBounds) -> f64 {
    let corners = bounds.upper().bounded().into_iter().flat_map(|upper| upper.vertices());
    corners.map(|v| v.length() / AXES.x).fold(1.0, f64::max)
}

/// The support values of both bounds along some directions.
fn supports(bounds: &ShapeBounds) -> impl Iterator<Item = (f64, f64)> + '_ {
    let mut s = Source::new(3);
    (0..12).map(move |_| bounds.support(Direction::new_unchecked(s.direction())))
}

fn moved(contact: &ContactSample, by: impl Fn(glam::DVec3) -> glam::DVec3) -> ContactSample {
    ContactSample { point: by(contact.point), normal: contact.normal }
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn more_contacts_never_widen(contacts in contacts(5..50)) {
        let before = ShapeBounds::from_contacts(&contacts[..contacts.len() - 1])?;
        let after = ShapeBounds::from_contacts(&contacts)?;
        for ((low, high), (lower, upper)) in supports(&before).zip(supports(&after)) {
            prop_assert!(lower >= low, "{low} {lower}");
            prop_assert!(upper <= high + ROUNDED * reach(&before), "{high} {upper}");
        }
        prop_assert!(after.lower_volume() >= before.lower_volume() - ROUNDED * AXES.x);
    }

    #[test]
    fn order_repetition_and_turns_do_not_matter(contacts in contacts(8..50), seed in any::<u64>(), turn in exact_isometry()) {
        let one = ShapeBounds::from_contacts(&contacts)?;
        let mut others = shuffled(&contacts, seed);
        others.extend_from_within(..4);
        let turned = |c: &ContactSample| ContactSample {
            point: turn * c.point,
            normal: Direction::new_unchecked(turn * c.normal.get()),
        };
        let other = ShapeBounds::from_contacts(&others.iter().map(turned).collect::<Vec<_>>())?;
        let mut s = Source::new(3);
        for (low, high) in supports(&one) {
            let (lower, upper) = other.support(Direction::new_unchecked(turn * s.direction()));
            prop_assert!((low - lower).abs() <= ROUNDED, "{low} {lower}");
            // Both without end, or the same.
            prop_assert!(high == upper || (high - upper).abs() <= ROUNDED * reach(&one), "{high} {upper}");
        }
    }

    #[test]
    fn grown_contacts_have_grown_bounds_to_the_last_bit(contacts in contacts(5..50), exponent in -60..60_i32) {
        let factor = 2_f64.powi(exponent);
        let one = ShapeBounds::from_contacts(&contacts)?;
        let grown: Vec<ContactSample> = contacts.iter().map(|c| moved(c, |p| p * factor)).collect();
        let grown = ShapeBounds::from_contacts(&grown)?;
        prop_assert_eq!(grown.lower_volume(), one.lower_volume() * factor.powi(3));
        prop_assert_eq!(grown.upper_volume(), one.upper_volume() * factor.powi(3));
        let gaps = [one, grown].map(|bounds| bounds.largest_gap().map(|gap| gap.distance));
        prop_assert_eq!(gaps[0].map(|distance| distance * factor), gaps[1]);
    }

    #[test]
    fn a_contact_pushed_beyond_a_plane_is_named(contacts in contacts(8..50), which in any::<prop::sample::Index>()) {
        let at = which.index(contacts.len());
        let mut wrong = contacts;
        // Out along its normal by a tenth: it lies beyond the planes of none but others, and its own goes with it.
        let out = 0.1 * wrong[at].normal.get();
        wrong[at].point += out;
        let others: Vec<usize> = (0..wrong.len())
            .filter(|k| wrong[*k].half_space().excess(wrong[at].point) > 1e-3)
            .collect();
        match ShapeBounds::from_contacts(&wrong) {
            Err(BoundsError::Contradiction(found)) => {
                prop_assert_eq!(found.contact, at);
                prop_assert!(others.contains(&found.plane));
            }
            other => prop_assert!(others.is_empty(), "{other:?}"),
        }
    }
}

proptest! {
    #![proptest_config(cases(8))]

    #[test]
    fn contact_by_contact_is_all_at_once_at_every_prefix(contacts in contacts(4..32)) {
        let mut growing = IncrementalBounds::new();
        for (k, contact) in contacts.iter().enumerate() {
            growing.insert(contact)?;
            if k < 3 {
                let too_few = matches!(growing.bounds(), Err(BoundsError::TooFew { .. }));
                prop_assert!(too_few);
                continue;
            }
            let (one, all) = (growing.bounds()?, ShapeBounds::from_contacts(&contacts[..=k])?);
            for ((low, high), (lower, upper)) in supports(&one).zip(supports(&all)) {
                prop_assert_eq!(low, lower);
                prop_assert!(high == upper || (high - upper).abs() <= ROUNDED * reach(&all), "{}: {} {}", k, high, upper);
            }
        }
    }
}
