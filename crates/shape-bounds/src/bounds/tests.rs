use super::*;
use crate::generators::{AXES, Source, curve_contacts, ellipsoid_contacts, ellipsoid_support};

#[test]
fn the_ellipsoid_lies_between_its_bounds() {
    let size = AXES.max_element();
    for seed in 0..6 {
        for contacts in [curve_contacts(600, seed), ellipsoid_contacts(100, seed)] {
            let bounds = ShapeBounds::from_contacts(&contacts).unwrap();
            let mut s = Source::new(seed);
            for _ in 0..300 {
                let n = s.direction();
                let truth = ellipsoid_support(n);
                let (lower, upper) = bounds.support(Direction::new(n).unwrap());
                assert!(lower <= truth + 1e-14 * size && truth <= upper, "{lower} {truth} {upper}");
            }
            let truth = 4.0 / 3.0 * std::f64::consts::PI * AXES.element_product();
            assert!(bounds.lower_volume() < truth && truth < bounds.upper_volume());
        }
    }
}

#[test]
fn the_largest_gap_is_the_hausdorff_distance() {
    let bounds = ShapeBounds::from_contacts(&curve_contacts(150, 3)).unwrap();
    let largest = bounds.largest_gap().unwrap();
    // Two independent formulations: nearest points of corners, and the supremum of support function differences.
    assert!((bounds.gap_along(largest.direction) - largest.distance).abs() < 1e-12);
    assert!((largest.outer.distance(largest.inner) - largest.distance).abs() < 1e-12);
    let mut s = Source::new(2);
    for _ in 0..5000 {
        let n = Direction::new(s.direction()).unwrap();
        assert!(bounds.gap_along(n) <= largest.distance + 1e-12);
    }
}

#[test]
fn contacts_on_one_side_leave_the_other_open() {
    let contacts: Vec<ContactSample> =
        ellipsoid_contacts(200, 1).into_iter().filter(|c| c.normal.get().z > 0.3).collect();
    let bounds = ShapeBounds::from_contacts(&contacts).unwrap();
    assert!(bounds.upper_volume().is_infinite() && bounds.largest_gap().is_none());
    assert!(bounds.lower_volume() > 0.0);
    let Intersection::Unbounded(open) = bounds.upper() else { panic!("closed") };
    let down = open.directions().iter().map(|d| d.get()).sum::<DVec3>().normalize();
    assert!(down.z < -0.9, "{down}");
}

#[test]
fn too_few_and_contradictory_contacts_are_named() {
    let contacts = ellipsoid_contacts(50, 1);
    assert_eq!(ShapeBounds::from_contacts(&contacts[..3]), Err(BoundsError::TooFew { found: 3, needed: 4 }));
    let mut wrong = contacts.clone();
    wrong[7].point = -wrong[7].point * 1.5;
    let error = ShapeBounds::from_contacts(&wrong).unwrap_err();
    let BoundsError::Contradiction(found) = &error else { panic!("{error}") };
    assert!([found.contact, found.plane].contains(&7), "{error}");
    let [c, p] = [found.contact, found.plane].map(|k| wrong[k]);
    assert!((p.half_space().excess(c.point) - found.excess).abs() < 1e-14);
    // Nothing is wrong with the rest.
    wrong.remove(7);
    assert_eq!(ShapeBounds::contradiction(&wrong), Ok(None));
}

#[test]
fn raw_contacts_are_checked() {
    use crate::sample::ContactError;
    let good = (DVec3::X, DVec3::X);
    let error = ContactSample::from_raw([good, (DVec3::X, DVec3::X * 2.0)]).unwrap_err();
    assert!(matches!(error, ContactError::Normal { index: 1, .. }), "{error}");
    let error = ContactSample::from_raw([(DVec3::NAN, DVec3::X)]).unwrap_err();
    assert!(matches!(error, ContactError::Point { index: 0, .. }), "{error}");
}

#[test]
fn one_contact_at_a_time_gives_the_bounds_of_all() {
    for contacts in [curve_contacts(240, 4), ellipsoid_contacts(120, 4)] {
        let mut growing = IncrementalBounds::new();
        assert!(growing.is_empty() && growing.bounds().is_err());
        for (k, contact) in contacts.iter().enumerate() {
            growing.insert(contact).unwrap();
            if k % 40 == 39 {
                let (now, all) =
                    (growing.bounds().unwrap(), ShapeBounds::from_contacts(&contacts[..=k]).unwrap());
                assert!((now.lower_volume() - all.lower_volume()).abs() < 1e-12);
                if all.upper_volume().is_finite() {
                    assert!((now.upper_volume() / all.upper_volume() - 1.0).abs() < 1e-11);
                } else {
                    assert!(now.upper_volume().is_infinite());
                }
            }
        }
        assert_eq!(growing.len(), contacts.len());
    }
}

#[test]
fn a_contradictory_contact_is_not_taken() {
    let mut growing = IncrementalBounds::new();
    for contact in ellipsoid_contacts(60, 2) {
        growing.insert(&contact).unwrap();
    }
    let before = growing.bounds().unwrap();
    let wrong = ContactSample { point: DVec3::new(-9.0, 0.0, 0.0), normal: Direction::X };
    let error = growing.insert(&wrong).unwrap_err();
    assert!(
        matches!(&error, BoundsError::HalfSpaces(IntersectionError::Contradiction { conflict, .. }) if conflict.contains(&60)),
        "{error}"
    );
    assert_eq!(growing.bounds().unwrap(), before);
    // One whose half-space goes with all others while its point is beyond some of them is found at the next look.
    let beyond = ContactSample { point: DVec3::new(9.0, 9.0, 0.0), normal: Direction::X };
    growing.insert(&beyond).unwrap();
    assert!(
        matches!(growing.bounds(), Err(BoundsError::Contradiction(found)) if found.contact == 60 && found.excess > 1.0)
    );
}

/// The search in the order of what is possible, against the plain one: every corner, every support point.
#[test]
fn the_largest_gap_is_that_of_all_corners() {
    for contacts in [curve_contacts(240, 3), ellipsoid_contacts(150, 3)] {
        let bounds = ShapeBounds::from_contacts(&contacts).unwrap();
        let plain = bounds.upper().bounded().unwrap().vertices().iter().map(|v| {
            crate::distance::nearest(*v, &bounds.corners[..1], |d| {
                crate::distance::farthest_of(&bounds.corners, d)
            })
        });
        let plain: Vec<f64> = plain.map(|n| n.certified).collect();
        let largest = plain.iter().fold(0.0, |m: f64, d| m.max(*d));
        assert!((bounds.largest_gap().unwrap().distance - largest).abs() < 1e-13);
        let mut found: Vec<f64> = bounds.gaps().iter().map(|g| g.distance).collect();
        assert_eq!(found.len(), plain.len());
        let mut plain = plain;
        found.sort_unstable_by(f64::total_cmp);
        plain.sort_unstable_by(f64::total_cmp);
        assert!(found.iter().zip(&plain).all(|(f, p)| (f - p).abs() < 1e-12));
    }
}

#[test]
fn a_contact_beyond_another_ones_plane_is_named_although_hull_and_half_spaces_exist() {
    let face = |n: DVec3| ContactSample { point: n * 0.5, normal: Direction::new(n).unwrap() };
    let mut cube: Vec<ContactSample> =
        [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|n| [face(n), face(-n)]).collect();
    assert!(ShapeBounds::from_contacts(&cube).is_ok());
    cube.push(ContactSample { point: DVec3::new(3.0, 3.0, 0.0), normal: Direction::X });
    let Err(BoundsError::Contradiction(found)) = ShapeBounds::from_contacts(&cube) else {
        panic!("accepted")
    };
    assert!(found.contact == 6 && [0, 2].contains(&found.plane) && (found.excess - 2.5).abs() < 1e-15);
}

#[test]
fn the_farthest_beyond_is_that_of_all_pairs_whatever_the_dimension() {
    let mut s = Source::new(4);
    for case in 0..60 {
        let stretch = [DVec3::ONE, DVec3::new(1.0, 0.6, 0.0), DVec3::X, DVec3::ZERO][case % 4];
        let contacts: Vec<ContactSample> = (0..5 + case)
            .map(|_| ContactSample {
                point: s.normal3() * stretch,
                normal: Direction::new(s.direction()).unwrap(),
            })
            .collect();
        let mut expected = 0.0_f64;
        for c in &contacts {
            expected = contacts.iter().map(|d| c.half_space().excess(d.point)).fold(expected, f64::max);
        }
        let found = ShapeBounds::contradiction(&contacts).unwrap().map_or(0.0, |worst| worst.excess);
        assert!((found - expected).abs() < 1e-14, "case {case}: {found} {expected}");
    }
}

#[test]
fn contacts_rounded_to_printed_digits_leave_the_lower_bound_in_the_upper_one() {
    for (digits, seed) in [(6, 1), (7, 2), (9, 3), (12, 4)] {
        let unit = 10.0_f64.powi(-digits);
        let rounded = |v: DVec3| (v / unit).round() * unit;
        let contacts: Vec<ContactSample> = ellipsoid_contacts(2000, seed)
            .iter()
            .map(|c| ContactSample {
                point: rounded(c.point),
                normal: Direction::from_unit(rounded(c.normal.get()), 1e-5).unwrap(),
            })
            .collect();
        let bounds = ShapeBounds::from_contacts(&contacts).unwrap();
        let upper = bounds.upper().bounded().unwrap();
        assert!(contacts.iter().all(|c| upper.contains(c.point)), "{digits} digits");
        // Points that stand on their heads by more than printing does are refused.
        let noisy: Vec<ContactSample> = contacts
            .iter()
            .map(|c| ContactSample { point: c.point * (1.0 + 1e-2 * (40.0 * c.point.x).sin()), ..*c })
            .collect();
        assert!(matches!(ShapeBounds::from_contacts(&noisy), Err(BoundsError::Contradiction(_))));
        let bounds = ShapeBounds::from_contradicting_contacts(&noisy).unwrap();
        assert!(noisy.iter().all(|c| bounds.upper().bounded().unwrap().contains(c.point)));
    }
}

#[test]
fn the_largest_gap_of_scattered_contacts_takes_few_searches_and_is_that_of_all_corners() {
    let bounds = ShapeBounds::from_contacts(&ellipsoid_contacts(3000, 1)).unwrap();
    let of_all = bounds.gaps().iter().map(|gap| gap.distance).fold(0.0, f64::max);
    assert!((bounds.largest_gap().unwrap().distance - of_all).abs() < 1e-14);
}
