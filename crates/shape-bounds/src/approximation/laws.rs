//! What holds for every input: order, size and exact turns do not matter.

use crate::ContactSample;
use crate::approximation::SplineSurface;
use crate::generators::Source;
use crate::planar::approximation::PrincipalCurve;
use crate::strategies::{contacts, exact_isometry, shuffled};
use contact_kinematics::Direction;
use exact_hull::generators::AXES;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

/// The energy weighs 2e-9 or more in the equations of these lattices, which so keep seven digits of sixteen where there are no contacts.
const ROUNDED: f64 = 1e-7;

fn cases(count: u32) -> Config {
    let cases = crate::few_or_all(count, 10 * count);
    Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(19), ..Config::default() }
}

fn directions() -> impl Iterator<Item = DVec3> {
    let mut s = Source::new(3);
    (0..12).map(move |_| s.direction())
}

/// Points about an ellipse, as a palm in the plane might feel them.
fn scattered(seed: u64) -> Vec<DVec2> {
    let mut s = Source::new(seed);
    let point = |_| {
        let on = DVec2::from_angle(s.between(0.0, std::f64::consts::TAU)) * DVec2::new(2.0, 1.0);
        on + DVec2::new(s.normal(), s.normal()) * 0.02
    };
    (0..60).map(point).collect()
}

proptest! {
    #![proptest_config(cases(12))]

    #[test]
    fn order_of_contacts_and_exact_turns_do_not_matter(
        contacts in contacts(12..60),
        seed in any::<u64>(),
        turn in exact_isometry(),
    ) {
        let one = SplineSurface::through(&contacts)?;
        let turned = |c: &ContactSample| ContactSample {
            point: turn * c.point,
            normal: Direction::new_unchecked(turn * c.normal.get()),
        };
        let moved: Vec<ContactSample> = shuffled(&contacts, seed).iter().map(turned).collect();
        let other = SplineSurface::through(&moved)?;
        for d in directions() {
            let difference = turn * one.point(d) - other.point(turn * d);
            prop_assert!(difference.length() <= ROUNDED * AXES.x, "{}", difference);
        }
    }

    #[test]
    fn grown_contacts_have_a_grown_spline_to_the_last_bit(contacts in contacts(12..60), exponent in -300..300_i32) {
        let factor = 2_f64.powi(exponent);
        let one = SplineSurface::through(&contacts)?;
        let grown = contacts.iter().map(|c| ContactSample { point: c.point * factor, ..*c });
        let grown = SplineSurface::through(&grown.collect::<Vec<_>>())?;
        for d in directions() {
            prop_assert_eq!(one.point(d) * factor, grown.point(d));
        }
    }

    #[test]
    fn the_same_holds_of_principal_curves(seed in any::<u64>(), exponent in -300..300_i32) {
        let points = scattered(seed);
        let one = PrincipalCurve::of(&points, None)?;
        let factor = 2_f64.powi(exponent);
        let grown = PrincipalCurve::of(&points.iter().map(|p| *p * factor).collect::<Vec<_>>(), None)?;
        prop_assert_eq!(one.scatter() * factor, grown.scatter());
        // Turned by a quarter and mixed.
        let turned: Vec<DVec2> = shuffled(&points, seed).iter().map(|p| p.perp()).collect();
        let turned = PrincipalCurve::of(&turned, None)?;
        for d in directions().map(|d| d.truncate()) {
            prop_assert_eq!(one.curve().point(d) * factor, grown.curve().point(d));
            let difference = one.curve().point(d).perp() - turned.curve().point(d.perp());
            prop_assert!(difference.length() <= 1e-3 * one.scatter(), "{}", difference);
        }
    }
}
