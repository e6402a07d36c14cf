//! The planar bounds against theory: exactness, closed forms, the chain of bounds, and typed refusals.

use super::curvature::*;
use super::*;
use crate::generators::Source;
use contact_kinematics::planar::{Ellipse, RadiusBounds, RadiusFunction};
use exact_hull::planar::{
    Direction, DirectionError, HalfPlane, Hull, IncrementalHull, Intersection, IntersectionError, PointsError,
};
use glam::DVec2;
use std::f64::consts::{PI, TAU};

fn ellipse() -> Ellipse {
    Ellipse::new(2.0, 1.0, DVec2::new(0.3, -0.2)).unwrap()
}

fn contacts(body: &dyn RadiusFunction, angles: impl IntoIterator<Item = f64>) -> Vec<ContactSample> {
    let contact =
        |angle: f64| ContactSample { point: body.point(angle), normal: Direction::from_angle(angle) };
    angles.into_iter().map(contact).collect()
}

fn scattered(count: usize, s: &mut Source) -> Vec<f64> {
    (0..count).map(|_| s.between(0.0, TAU)).collect()
}

#[test]
fn contradictions_name_a_smallest_conflicting_set() {
    let mut s = Source::new(2);
    for _ in 0..200 {
        let mut planes: Vec<HalfPlane> =
            contacts(&ellipse(), scattered(20, &mut s)).iter().map(ContactSample::half_plane).collect();
        let at = s.below(20);
        planes[at].margin = -6.0;
        match Intersection::of(&planes) {
            Err(IntersectionError::Contradiction { conflict, deficit }) => {
                assert!(conflict.contains(&at) && conflict.len() <= 3 && deficit > 0.0);
                for left_out in 0..conflict.len() {
                    let mut rest = conflict.clone();
                    rest.remove(left_out);
                    let rest: Vec<HalfPlane> = rest.iter().map(|k| planes[*k]).collect();
                    assert!(Intersection::of(&rest).is_ok());
                }
            }
            Ok(Intersection::Unbounded(_)) => {}
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn bounds_hold_the_body_between_them() {
    for seed in 0..500 {
        let mut s = Source::new(seed);
        let count = 3 + s.below(57);
        let body = ellipse();
        let samples = contacts(&body, scattered(count, &mut s));
        let bounds = ShapeBounds::from_contacts(&samples).unwrap();
        let mut incremental = IncrementalBounds::new();
        samples.iter().for_each(|c| incremental.insert(c).unwrap());
        let stepwise = incremental.bounds().unwrap();
        assert!((stepwise.lower_area() - bounds.lower_area()).abs() < 1e-12);
        let curved = CurvatureBounds::from_contacts(&samples, RadiusBounds { min: 0.5, max: 4.0 }).unwrap();
        for angle in scattered(20, &mut s) {
            let n = Direction::from_angle(angle);
            let truth = body.point(angle).dot(n.get());
            let ((a, b), (d, c)) = (bounds.support(n), curved.support(n));
            let chain = [a, d, truth, c, b];
            assert!(chain.windows(2).all(|w| w[0] <= w[1] + 1e-12), "{chain:?}");
            assert!((stepwise.support(n).1 - b).abs() < 1e-9 || b > 1e3);
        }
        let truth = 2.0 * PI;
        let areas =
            [bounds.lower_area(), curved.lower().area(), truth, curved.upper().area(), bounds.upper_area()];
        assert!(areas.windows(2).all(|w| w[0] <= w[1] * (1.0 + 1e-12)), "{areas:?}");
        if let Some(region) = bounds.upper().bounded() {
            assert!(samples.iter().all(|c| region.excess(c.point) <= 0.0));
            // The gap as found by the walk is the one found by trying all edges.
            let Some(hull) = bounds.lower().polygon() else { continue };
            for gap in bounds.gaps() {
                let nearest = hull
                    .shape()
                    .edges()
                    .map(|(a, b)| distance::on_segment(a, b, gap.outer).distance(gap.outer));
                let nearest = nearest.fold(f64::INFINITY, f64::min);
                assert!((nearest - gap.distance).abs() < 1e-12, "{nearest} {}", gap.distance);
            }
        }
    }
}

#[test]
fn both_bounds_converge_with_the_square_of_the_spacing() {
    let errors = |count: usize| {
        let angles = (0..count).map(|k| TAU * k as f64 / count as f64);
        let bounds = ShapeBounds::from_contacts(&contacts(&ellipse(), angles)).unwrap();
        [
            2.0 * PI - bounds.lower_area(),
            bounds.upper_area() - 2.0 * PI,
            bounds.largest_gap().unwrap().distance,
        ]
    };
    let (coarse, fine) = (errors(50), errors(400));
    for k in 0..3 {
        let order = (coarse[k] / fine[k]).log2() / 3.0;
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }
}

#[test]
fn lens_reuleaux_triangle_and_stadium_have_their_areas() {
    for distance in [1.9, 1.0, 1e-3, 1e-6] {
        let centre = |x: f64| Disc { centre: DVec2::new(x, 5.0), radius: 1.0 };
        let lens = DiscIntersection::of(&[centre(0.0), centre(distance)], &[]).unwrap();
        let expected = 2.0 * (distance / 2.0).acos() - distance / 2.0 * (4.0 - distance * distance).sqrt();
        assert!((lens.area() - expected).abs() < 1e-13, "{distance}");
    }
    let side = DVec2::from_angle(PI / 3.0);
    let corners = [DVec2::ZERO, DVec2::X, side];
    let reuleaux: Vec<Disc> = corners.iter().map(|c| Disc { centre: *c, radius: 1.0 }).collect();
    let reuleaux = DiscIntersection::of(&reuleaux, &[]).unwrap();
    assert!((reuleaux.area() - 0.5 * (PI - 3f64.sqrt())).abs() < 1e-15 * 10.0);
    assert_eq!(reuleaux.sides().len(), 3);
    // Half a disc, from a concave and a flat palm; and two discs of which one holds the other.
    let flat = HalfPlane { point: DVec2::ZERO, normal: Direction::from_angle(0.3), margin: 0.0 };
    let disc = Disc { centre: DVec2::ZERO, radius: 2.0 };
    let half = DiscIntersection::of(&[disc], &[flat]).unwrap();
    assert!((half.area() - 2.0 * PI).abs() < 1e-14 && half.sides().len() == 2);
    let larger = Disc { centre: DVec2::X, radius: 4.0 };
    assert!((DiscIntersection::of(&[larger, disc], &[]).unwrap().area() - 4.0 * PI).abs() < 1e-14);
    // Steiner: a segment of length 3 grown by 0.5.
    let stadium = RoundedHull::of(&[DVec2::ZERO, DVec2::new(3.0, 0.0)], 0.5).unwrap();
    assert!((stadium.area() - (3.0 + PI * 0.25)).abs() < 1e-15 * 10.0);
    assert!((stadium.perimeter() - (6.0 + PI)).abs() < 1e-15 * 10.0);
}

#[test]
fn discs_of_any_radii_agree_with_counting_points() {
    let mut s = Source::new(5);
    for _ in 0..20 {
        let discs: Vec<Disc> = (0..6)
            .map(|_| Disc { centre: DVec2::new(s.normal(), s.normal()) * 0.4, radius: s.between(0.9, 3.0) })
            .collect();
        let planes = [HalfPlane {
            point: DVec2::new(0.3, 0.1),
            normal: Direction::from_angle(s.unit() * TAU),
            margin: 0.3,
        }];
        let Ok(body) = DiscIntersection::of(&discs, &planes) else { continue };
        let side = 400;
        let cell = 8.0 / f64::from(side);
        let at = |k: i32| (f64::from(k) + 0.5) * cell - 4.0;
        let inside =
            (0..side * side).filter(|k| body.contains(DVec2::new(at(k % side), at(k / side)))).count();
        // The outline is below 20 m long: so many cells may be wrong, most of which cancel.
        assert!((inside as f64 * cell * cell - body.area()).abs() < 0.02, "{}", body.area());
    }
}

#[test]
fn curvature_limits_that_the_contacts_contradict_name_the_contacts() {
    let samples = contacts(&ellipse(), (0..40).map(|k| TAU * f64::from(k) / 40.0));
    let of = |min, max| CurvatureBounds::from_contacts(&samples, RadiusBounds { min, max }).unwrap_err();
    assert!(matches!(of(0.9, 4.0), CurvatureError::TooRound { .. }));
    assert!(matches!(of(0.1, 2.0), CurvatureError::TooFlat { .. }));
    assert!(matches!(of(2.0, 1.0), CurvatureError::Radii { .. }));
    let apart = [0.0, 5.0].map(|x| Disc { centre: DVec2::new(x, 0.0), radius: 1.0 });
    assert!(matches!(DiscIntersection::of(&apart, &[]), Err(CurvatureError::Empty { count: 2, .. })));
    let bad = Disc { centre: DVec2::ZERO, radius: f64::NAN };
    assert!(matches!(DiscIntersection::of(&[bad], &[]), Err(CurvatureError::Disc { index: 0, .. })));
}

#[test]
fn bad_input_is_named() {
    let raw = |p: DVec2, n: DVec2| ContactSample::from_raw([(DVec2::X, DVec2::X), (p, n)]).unwrap_err();
    assert!(matches!(raw(DVec2::NAN, DVec2::X), ContactError::Point { index: 1, .. }));
    assert!(matches!(
        raw(DVec2::X, DVec2::X * 1.1),
        ContactError::Normal { index: 1, reason: DirectionError::NotUnit { .. } }
    ));
    assert!(matches!(Direction::new(DVec2::ZERO), Err(DirectionError::Zero)));
    assert!(matches!(Hull::of(&[]), Err(PointsError::Empty)));
    assert!(matches!(Hull::of(&[DVec2::new(1e300, 1e-300)]), Err(PointsError::DynamicRange { .. })));
    let two = contacts(&ellipse(), [0.0, 1.0]);
    assert!(matches!(ShapeBounds::from_contacts(&two), Err(BoundsError::TooFew { found: 2, needed: 3 })));
    let mut incremental = IncrementalHull::new();
    assert!(matches!(incremental.insert(DVec2::INFINITY), Err(PointsError::NotFinite { index: 0, .. })));
    assert!(matches!(incremental.insert(DVec2::splat(1e200)), Err(PointsError::DynamicRange { .. })));
}

#[test]
fn contacts_that_no_convex_outline_has_are_named() {
    let mut s = Source::new(6);
    for case in 0..50 {
        let mut wrong = contacts(&ellipse(), scattered(30, &mut s));
        assert!(ShapeBounds::from_contacts(&wrong).is_ok());
        // One moved in by a fifth: its neighbours are beyond its line.
        wrong[case % 30].point = ellipse().point(0.0).lerp(wrong[case % 30].point, 0.8);
        let mut worst = 0.0_f64;
        for c in &wrong {
            worst = wrong.iter().map(|d| c.half_plane().excess(d.point)).fold(worst, f64::max);
        }
        match ShapeBounds::from_contacts(&wrong) {
            Err(BoundsError::Contradiction(found)) => {
                assert!([found.contact, found.plane].contains(&(case % 30)));
                assert!((found.excess - worst).abs() < 1e-15 && worst > 0.0);
            }
            Ok(_) => assert!(worst < 1e-5, "case {case}: {worst}"),
            Err(error) => panic!("{error}"),
        }
    }
    // A limacon, and one whose flat side is pushed in but kept its normals.
    let at = |angle: f64| {
        let r = 1.0 + 0.5 * angle.cos();
        let point = DVec2::from_angle(angle) * r;
        let tangent = DVec2::from_angle(angle).perp() * r - DVec2::from_angle(angle) * (0.5 * angle.sin());
        let normal = Direction::new(-tangent.perp()).unwrap();
        ContactSample { point, normal }
    };
    let limacon: Vec<ContactSample> = (0..60).map(|k| at(f64::from(k) * TAU / 60.0)).collect();
    assert!(ShapeBounds::from_contacts(&limacon).is_ok(), "a limacon with b = a / 2 is convex");
    let dented: Vec<ContactSample> = limacon
        .iter()
        .map(|c| ContactSample { point: DVec2::new(c.point.x.max(-0.2), c.point.y), ..*c })
        .filter(|c| c.point.x > -0.3)
        .collect();
    assert!(matches!(ShapeBounds::from_contacts(&dented), Err(BoundsError::Contradiction(_))));
    // A kidney, touched all around.
    let kidney = |angle: f64| {
        let (out, r) = (DVec2::from_angle(angle), 1.0 + 0.5 * (2.0 * angle).cos());
        let tangent = out.perp() * r - out * (2.0 * angle).sin();
        ContactSample { point: out * r, normal: Direction::new(-tangent.perp()).unwrap() }
    };
    let kidney: Vec<ContactSample> = (0..200).map(|k| kidney(f64::from(k) * TAU / 200.0)).collect();
    assert!(matches!(ShapeBounds::from_contacts(&kidney), Err(BoundsError::Contradiction(_))));
}

#[test]
fn lines_that_are_parallel_but_for_rounding_leave_a_strip_open() {
    let plane = |angle: f64, height: f64| {
        let normal = Direction::from_angle(angle);
        HalfPlane { point: normal.get() * height, normal, margin: 0.0 }
    };
    let mut s = Source::new(3);
    for digits in [1e-16, 1e-12, 1e-7] {
        for _ in 0..50 {
            let axis = s.between(0.0, TAU);
            let planes: Vec<HalfPlane> = (0..12)
                .map(|k| plane(axis + PI * f64::from(k % 2) + digits * s.between(-1.0, 1.0), 1.0))
                .collect();
            let Intersection::Unbounded(open) = Intersection::of(&planes).unwrap() else { panic!("closed") };
            let along = DVec2::from_angle(axis).perp();
            for end in [along, -along] {
                assert!(open.directions().iter().any(|d| d.get().distance(end) < 1e-5));
            }
            assert!(open.within_square(DVec2::ZERO, 3.0).is_ok());
        }
    }
}
