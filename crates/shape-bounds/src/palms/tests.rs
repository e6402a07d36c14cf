use super::*;
use crate::curvature::BallIntersection;
use crate::generators::{Source, curve_contacts, ellipsoid_contacts, ellipsoid_support};
use std::f64::consts::PI;

fn palms(contacts: &[ContactSample], radius: impl Fn(usize) -> f64) -> Vec<PalmContact> {
    contacts.iter().enumerate().map(|(k, c)| PalmContact { contact: *c, hollow_radius: radius(k) }).collect()
}

/// Palms of one radius: the exact intersection lies between the polytopes.
#[test]
fn equal_palms_enclose_the_exact_volume() {
    let contacts = ellipsoid_contacts(40, 3);
    let exact = BallIntersection::through_contacts(&contacts, 7.0).unwrap();
    let found = PalmIntersection::of(&palms(&contacts, |_| 7.0)).unwrap();
    let mut width = f64::INFINITY;
    for tolerance in [3e-2, 3e-3] {
        let bounds = found.faceted(tolerance).unwrap();
        let (low, high) = (bounds.lower_volume(), bounds.upper_volume());
        assert!(low < exact.volume() && exact.volume() < high, "{low} {high}");
        assert!(bounds.largest_gap().unwrap().distance <= tolerance);
        // Within the tolerance times the area, of which that of a ball around it is more.
        assert!(high - low < tolerance * 4.0 * PI * 9.0 && high - low < 0.2 * width);
        width = high - low;
    }
}

/// Three palms, hollow with two radii and flat, on curves of one body: the body, and each palm's ball, hold.
#[test]
fn mixed_palms_hold_the_body_and_keep_to_every_palm() {
    let contacts = curve_contacts(90, 4);
    let radius = [6.5, 12.0, f64::INFINITY];
    let found = PalmIntersection::of(&palms(&contacts, |k| radius[k % 3])).unwrap();
    let bounds = found.faceted(1e-2).unwrap();
    let mut s = Source::new(8);
    for _ in 0..200 {
        let n = s.direction();
        let (low, high) = bounds.support(Direction::new(n).unwrap());
        assert!(ellipsoid_support(n) <= high && low <= high && high - low <= 1e-2 * (1.0 + 1e-12));
        let point = found.interior + n * s.between(0.5, 3.0);
        let (in_lower, inside) =
            (bounds.lower().solid().unwrap().contains(point), found.excess(point) <= 0.0);
        assert!(!in_lower || inside);
        assert!(!inside || bounds.upper().bounded().unwrap().contains(point));
    }
    let flat = ShapeBounds::from_contacts(&contacts).unwrap();
    assert!(bounds.upper_volume() < flat.upper_volume());
}

#[test]
fn a_large_radius_is_a_plane() {
    let contact = ellipsoid_contacts(1, 1)[0];
    let [hollow, flat] = [1e12, f64::INFINITY].map(|hollow_radius| PalmContact { contact, hollow_radius });
    let mut s = Source::new(2);
    for _ in 0..100 {
        let y = s.normal3();
        assert!((hollow.excess(y) - flat.excess(y)).abs() < 1e-10);
        let inside = contact.point - contact.normal.get() * s.between(0.1, 1.0);
        let d = s.direction();
        for palm in [hollow, flat, PalmContact { contact, hollow_radius: 3.0 }] {
            let exit = palm.exit(inside, d);
            assert!(exit > 0.0 && (exit > 1e6 || palm.excess(inside + d * exit).abs() < 1e-14), "{exit}");
        }
    }
}

#[test]
fn impossible_palms_are_named() {
    let contacts = ellipsoid_contacts(50, 5);
    assert_eq!(PalmIntersection::of(&[]), Err(PalmError::Empty));
    assert!(matches!(
        PalmIntersection::of(&palms(&contacts, |k| if k == 7 { 0.0 } else { 9.0 })),
        Err(PalmError::Value { index: 7, .. })
    ));
    // The body is flatter somewhere than a palm of radius 2 allows.
    match PalmIntersection::of(&palms(&contacts, |k| if k == 3 { 2.0 } else { f64::INFINITY })) {
        Err(PalmError::Behind { other: 3, sample, excess }) => assert!(sample != 3 && excess > 0.0),
        other => panic!("{other:?}"),
    }
    // Half of the sides: no end.
    let half: Vec<ContactSample> = contacts.into_iter().filter(|c| c.normal.get().z > 0.0).collect();
    let open = PalmIntersection::of(&palms(&half, |_| f64::INFINITY)).unwrap();
    assert_eq!(open.faceted(0.1), Err(FacetError::Unbounded));
    assert_eq!(open.faceted(0.0), Err(FacetError::Tolerance { value: 0.0 }));
}

/// One to four hollow palms: their balls have an end on every side, although the tangent planes leave one open.
#[test]
fn a_few_hollow_palms_bound_the_body() {
    let mut s = Source::new(5);
    for case in 0..40 {
        let contacts = ellipsoid_contacts(1 + case % 4, 100 + case as u64);
        let radii: Vec<f64> = contacts.iter().map(|_| s.between(6.3, 20.0)).collect();
        let found = PalmIntersection::of(&palms(&contacts, |k| radii[k])).unwrap();
        let tolerance = 0.3;
        let bounds = found.faceted(tolerance).unwrap_or_else(|e| panic!("case {case}: {e}"));
        assert!(bounds.largest_gap().unwrap().distance <= tolerance);
        let upper = bounds.upper().bounded().unwrap();
        let smallest = radii.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(bounds.lower_volume() < 4.2 * smallest.powi(3), "case {case}");
        for _ in 0..100 {
            let n = s.direction();
            assert!(upper.support(Direction::new(n).unwrap()) >= ellipsoid_support(n) - 1e-9, "case {case}");
            let point = found.interior + n * s.between(0.0, 2.0 * smallest);
            assert!(found.excess(point) > 0.0 || upper.contains(point), "case {case}");
        }
    }
    // Flat palms on one side have no end, however many.
    let flat: Vec<ContactSample> =
        ellipsoid_contacts(60, 1).into_iter().filter(|c| c.normal.get().z > 0.2).collect();
    let open = PalmIntersection::of(&palms(&flat, |_| f64::INFINITY)).unwrap();
    assert_eq!(open.faceted(0.1), Err(crate::FacetError::Unbounded));
}
