use super::*;
use crate::body::ConvexBody;
use crate::bounds::ShapeBounds;
use crate::generators::{AXES, Source, curve_contacts, ellipsoid_contacts, ellipsoid_support};
use std::f64::consts::PI;

/// Radii of curvature of the test ellipsoid: from c^2 / a to a^2 / c.
const RADII: CurvatureRadii = CurvatureRadii { min: 0.4, max: 6.25 };

fn contact(point: DVec3, normal: DVec3) -> ContactSample {
    ContactSample { point, normal: Direction::new(normal).unwrap() }
}

#[test]
fn steiner_on_a_box_a_plate_a_rod_and_a_point() {
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    let r = 0.3;
    let ball = 4.0 / 3.0 * PI * r * r * r;
    for (size, expected) in [
        (DVec3::new(1.0, 2.0, 3.0), 6.0 + r * 22.0 + PI * r * r * 6.0 + ball),
        (DVec3::new(1.0, 2.0, 0.0), r * 4.0 + PI * r * r * 3.0 + ball),
        (DVec3::new(2.0, 0.0, 0.0), PI * r * r * 2.0 + ball),
        (DVec3::ZERO, ball),
    ] {
        let centres: Vec<DVec3> = (0..8).map(|i| corner(i) * size).collect();
        let rounded = RoundedHull::of(&centres, r).unwrap();
        assert!((rounded.volume() / expected - 1.0).abs() < 1e-14, "{size}: {} {expected}", rounded.volume());
        // The area is the derivative of the volume with the radius.
        let wider = RoundedHull::of(&centres, r + 1e-5).unwrap().volume();
        let narrower = RoundedHull::of(&centres, r - 1e-5).unwrap().volume();
        assert!(((wider - narrower) / 2e-5 - rounded.area()).abs() < 1e-8);
        assert!(rounded.contains(size + DVec3::X * r) && !rounded.contains(size + DVec3::X * (r + 1e-9)));
    }
}

#[test]
fn a_lens_has_its_closed_volume() {
    // Two unit balls whose centres are d apart: pi (4 + d) (2 - d)^2 / 12.
    for d in [1.9, 1.0, 0.1, 1e-3, 1e-6] {
        let half = d / 2.0;
        let contacts =
            [contact(DVec3::X * (1.0 - half), DVec3::X), contact(-DVec3::X * (1.0 - half), -DVec3::X)];
        let volume = BallIntersection::through_contacts(&contacts, 1.0).unwrap().volume();
        let expected = PI * (4.0 + d) * (2.0 - d) * (2.0 - d) / 12.0;
        assert!((volume / expected - 1.0).abs() < 1e-12, "{d}: {volume} {expected}");
    }
}

#[test]
fn the_reuleaux_tetrahedron_has_its_closed_volume() {
    // Unit balls about the corners of a regular tetrahedron of edge 1.
    let s = 1.0 / 8.0_f64.sqrt();
    let corners = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
        .map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * s);
    // Each ball touches the body where the ray from its centre through the middle leaves it.
    let contacts = corners.map(|c| contact(c - c.normalize(), -c));
    let body = BallIntersection::through_contacts(&contacts, 1.0).unwrap();
    let root = 2.0_f64.sqrt();
    // Harbourne: 8/3 pi - 27/4 acos(1/3) + sqrt(2)/4.
    let expected = 8.0 / 3.0 * PI - 27.0 / 4.0 * (1.0_f64 / 3.0).acos() + root / 4.0;
    assert!((body.volume() - expected).abs() < 1e-12, "{} {expected}", body.volume());
    assert_eq!(body.corners().count(), 4);
    for c in corners {
        // Its width is 1 from each corner to the opposite face.
        let n = Direction::new(c).unwrap();
        assert!((body.support(n) + body.support(-n) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn each_bound_lies_in_the_next() {
    let size = AXES.max_element();
    let mut s = Source::new(6);
    for seed in 0..12 {
        let contacts = if seed % 2 == 0 { curve_contacts(200, seed) } else { ellipsoid_contacts(60, seed) };
        let plain = ShapeBounds::from_contacts(&contacts).unwrap();
        let tight = CurvatureBounds::from_contacts(&contacts, RADII).unwrap();
        assert_eq!(tight.upper().skipped(), 0);
        for _ in 0..100 {
            let n = s.direction();
            let truth = ellipsoid_support(n);
            let n = Direction::new(n).unwrap();
            let ((a, b), (d, c)) = (plain.support(n), tight.support(n));
            let chain = [a, d, truth, c, b];
            assert!(chain.windows(2).all(|w| w[0] <= w[1] + 1e-12 * size), "seed {seed}: {chain:?}");
        }
        let truth = 4.0 / 3.0 * PI * AXES.element_product();
        let volumes = [
            plain.lower_volume(),
            tight.lower().volume(),
            truth,
            tight.upper().volume(),
            plain.upper_volume(),
        ];
        assert!(volumes.windows(2).all(|w| w[0] < w[1]), "seed {seed}: {volumes:?}");
    }
}

#[test]
fn the_gap_on_three_curves_is_about_half() {
    // How much the limits gain depends on the curves; over these eight, the median is just above one half.
    let mut ratios: Vec<f64> = (0..8)
        .map(|seed| {
            let contacts = curve_contacts(300, seed);
            let plain = ShapeBounds::from_contacts(&contacts).unwrap();
            let tight = CurvatureBounds::from_contacts(&contacts, RADII).unwrap();
            (tight.upper().volume() - tight.lower().volume()) / (plain.upper_volume() - plain.lower_volume())
        })
        .collect();
    ratios.sort_unstable_by(f64::total_cmp);
    assert!(ratios[4] < 0.55 && ratios[7] < 0.6, "{ratios:?}");
}

#[test]
fn contradicted_limits_name_the_contacts() {
    let contacts = ellipsoid_contacts(200, 1);
    let with = |min, max| CurvatureBounds::from_contacts(&contacts, CurvatureRadii { min, max });
    assert_eq!(with(1.0, 0.5), Err(CurvatureError::Radii { min: 1.0, max: 0.5 }));
    let outside =
        |a: &ContactSample, b: &ContactSample, r: f64| a.point.distance(b.point - b.normal.get() * r) - r;
    match with(0.4, 3.0).unwrap_err() {
        CurvatureError::TooFlat { sample, other, excess, radius } => {
            assert!((outside(&contacts[sample], &contacts[other], radius) - excess).abs() < 1e-12);
        }
        error => panic!("{error}"),
    }
    match with(0.9, 6.25).unwrap_err() {
        CurvatureError::TooRound { sample, other, excess, radius } => {
            let (c, o) = (&contacts[sample], &contacts[other]);
            let reach = (o.point - o.normal.get() * radius - c.point).dot(c.normal.get()) + radius;
            assert!((reach - excess).abs() < 1e-12 && excess > 0.0);
        }
        error => panic!("{error}"),
    }
}

/// Curves that meet at right angles, every ball with its mirror images: four spheres and more in one corner.
#[test]
fn symmetric_contacts_leave_no_ball_out() {
    let contacts: Vec<ContactSample> = (0..900)
        .map(|k| {
            let (curve, angle) = (k / 300, std::f64::consts::TAU * f64::from(k % 300) / 300.0);
            let (s, c) = angle.sin_cos();
            let lift = 0.4 * (2.0 * angle).sin();
            let n = [DVec3::new(c, s, lift), DVec3::new(lift, c, s), DVec3::new(s, lift, c)][curve as usize];
            contact(n.normalize(), n)
        })
        .collect();
    let radii = CurvatureRadii { min: 0.8, max: 1.3 };
    let sharp = SharpBounds::from_contacts(&contacts, radii).unwrap();
    let (low, high) = (sharp.lower().volume(), sharp.upper().volume());
    let sphere = 4.0 / 3.0 * PI;
    assert!(low < sphere && sphere < high && high - low < 0.4, "{low} {high}");
    assert_eq!((sharp.lower().skipped(), sharp.upper().core().skipped()), (0, 0));
}
