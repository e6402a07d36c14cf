use super::*;
use crate::body::ConvexBody;
use crate::bounds::ShapeBounds;
use crate::generators::{AXES, Source, curve_contacts, ellipsoid_contacts, ellipsoid_support};
use exact_hull::HullCertificate;
use std::f64::consts::PI;

/// Radii of curvature of the test ellipsoid: from c^2 / a to a^2 / c.
const RADII: CurvatureRadii = CurvatureRadii { min: 0.4, max: 6.25 };

fn hull_about(points: &[DVec3], radius: f64) -> BallHull {
    // Any point near the middle of the ball's other side is in all balls about points of a small body.
    let touching: Vec<DVec3> = points.iter().map(|p| *p - p.normalize() * radius).collect();
    BallHull::of_dual(BallIntersection::build(points, &touching, radius, f64::INFINITY).0, 0.0)
}

#[test]
fn a_spindle_has_the_volume_of_its_profile() {
    // Two points 2 s apart and balls of radius r: the profile's height over the axis is sqrt(r^2 - z^2) - sqrt(r^2 - s^2).
    for (s, r) in [(0.9, 1.0), (0.6, 1.0), (0.3, 1.0), (1.0, 50.0), (1.0, 1e4)] {
        let hull = hull_about(&[DVec3::X * s, -DVec3::X * s], r);
        let depth = |z: f64| {
            let (p, q) = ((r * r - z * z).sqrt(), (r * r - s * s).sqrt());
            (s - z) * (s + z) / (p + q)
        };
        let count = 4000;
        let simpson: f64 = (0..=count)
            .map(|k| {
                let weight = if k == 0 || k == count { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
                weight * PI * depth(s * (2.0 * f64::from(k) / f64::from(count) - 1.0)).powi(2)
            })
            .sum::<f64>()
            * (2.0 * s / f64::from(count) / 3.0);
        assert!((hull.volume() / simpson - 1.0).abs() < 1e-11, "{s} {r}: {} {simpson}", hull.volume());
    }
}

/// The measures of hull and dual, computed from their surfaces, against duality: two formulations.
#[test]
fn measures_agree_with_duality() {
    let mut s = Source::new(5);
    for case in 0..200 {
        let count = 2 + s.below(60);
        let points: Vec<DVec3> = (0..count).map(|_| s.direction() * s.between(0.5, 1.0)).collect();
        let rho = s.between(1.0, 4.0);
        let touching = vec![DVec3::ZERO; count];
        let (dual, _) = BallIntersection::build(&points, &touching, rho, f64::INFINITY);
        assert_eq!(dual.skipped(), 0);
        let k = dual.measures();
        let hull = BallHull::of_dual(dual, 0.0).measures();
        let ball = 4.0 / 3.0 * PI * rho * rho * rho;
        let dual_volume = ball - rho * rho * k.mean_curvature + rho * k.area - k.volume;
        assert!((hull.volume - dual_volume).abs() < 1e-13 * ball, "case {case}: {hull:?} {dual_volume}");
        let area = 4.0 * PI * rho * rho - 2.0 * rho * k.mean_curvature + k.area;
        assert!((hull.area - area).abs() < 1e-13 * ball, "case {case}: {hull:?} {area}");
        let curvature = 4.0 * PI * rho - k.mean_curvature;
        assert!((hull.mean_curvature - curvature).abs() < 1e-13 * ball, "case {case}: {hull:?} {curvature}");
    }
}

/// As the radius grows, the ball hull becomes the hull, by a part that falls with the radius: where duality has lost all
/// digits, the sum of parts has not.
#[test]
fn with_a_large_radius_the_ball_hull_tends_to_the_hull() {
    let points: Vec<DVec3> = ellipsoid_contacts(60, 3).iter().map(|c| c.point).collect();
    let flat = RoundedHull::of(&points, 0.0).unwrap().volume();
    let gained: Vec<f64> = [1e3, 1e4, 1e5, 1e6]
        .iter()
        .map(|rho| (hull_about(&points, *rho).volume() / flat - 1.0) * rho)
        .collect();
    for pair in gained.windows(2) {
        assert!((pair[1] / pair[0] - 1.0).abs() < 2e-3, "{gained:?}");
    }
}

#[test]
fn sharp_bounds_lie_between_the_body_and_all_others() {
    let size = AXES.max_element();
    let mut s = Source::new(6);
    for seed in 0..12 {
        let contacts = if seed % 2 == 0 { curve_contacts(200, seed) } else { ellipsoid_contacts(60, seed) };
        let plain = ShapeBounds::from_contacts(&contacts).unwrap();
        let tight = CurvatureBounds::from_contacts(&contacts, RADII).unwrap();
        let sharp = SharpBounds::from_contacts(&contacts, RADII).unwrap();
        assert_eq!((sharp.lower().skipped(), sharp.upper().core().skipped()), (0, 0));
        for _ in 0..50 {
            let n = s.direction();
            let truth = ellipsoid_support(n);
            let n = Direction::new(n).unwrap();
            let ((a, b), (d, c), (e, f)) = (plain.support(n), tight.support(n), sharp.support(n));
            let chain = [a, d, e, truth, f, c, b];
            assert!(chain.windows(2).all(|w| w[0] <= w[1] + 1e-12 * size), "seed {seed}: {chain:?}");
            let inside = s.direction() * s.between(0.0, 1.0);
            let inside = sharp.upper().core().interior() + inside * 3.0;
            assert!(!sharp.lower().contains(inside) || sharp.upper().contains(inside));
        }
        let truth = 4.0 / 3.0 * PI * AXES.element_product();
        let volumes = [
            tight.lower().volume(),
            sharp.lower().volume(),
            truth,
            sharp.upper().volume(),
            tight.upper().volume(),
        ];
        assert!(volumes.windows(2).all(|w| w[0] < w[1]), "seed {seed}: {volumes:?}");
    }
}

/// Sharp: both bounds have every contact themselves.
#[test]
fn both_sharp_bounds_are_bodies_with_the_same_contacts() {
    for contacts in [curve_contacts(90, 2), ellipsoid_contacts(50, 2)] {
        let sharp = SharpBounds::from_contacts(&contacts, RADII).unwrap();
        for c in &contacts {
            let height = c.normal.get().dot(c.point);
            let (lower, upper) = sharp.support(c.normal);
            assert!((lower - height).abs() < 1e-13 * RADII.max && (upper - height).abs() < 1e-13 * RADII.max);
            assert!(sharp.upper().contains(c.point - c.normal.get() * 1e-12));
            assert!(sharp.lower().contains(c.point - c.normal.get() * 1e-12));
            assert!(!sharp.upper().contains(c.point + c.normal.get() * 1e-9));
            assert!(!sharp.lower().contains(c.point + c.normal.get() * 1e-9));
        }
    }
}

#[test]
fn limits_that_the_contacts_contradict_name_a_pair() {
    let contacts = ellipsoid_contacts(300, 1);
    let with = |min, max| SharpBounds::from_contacts(&contacts, CurvatureRadii { min, max });
    assert_eq!(with(0.5, 0.5), Err(CurvatureError::Radii { min: 0.5, max: 0.5 }));
    // Each of the limits may be met by itself and both together not: the pair of balls shows it.
    for (min, max) in [(0.4, 5.0), (0.8, 6.25), (0.5, 5.8)] {
        match with(min, max).unwrap_err() {
            CurvatureError::Contradicted { sample, other, excess, .. } => {
                let at = |k: usize, r: f64| contacts[k].point - contacts[k].normal.get() * r;
                let found = at(sample, min).distance(at(other, max)) - (max - min);
                assert!((found - excess).abs() < 1e-12 && excess > 0.0, "{found} {excess}");
            }
            error => panic!("{error}"),
        }
    }
    assert!(matches!(SharpBounds::from_contacts(&[], RADII), Err(CurvatureError::Points(_))));
}

/// What is gained: the gap between the sharp bounds is well below half of that between hull and half-spaces.
#[test]
fn the_sharp_gap_on_three_curves_is_below_half() {
    for seed in 0..8 {
        let contacts = curve_contacts(300, seed);
        let plain = ShapeBounds::from_contacts(&contacts).unwrap();
        let sharp = SharpBounds::from_contacts(&contacts, RADII).unwrap();
        let ratio =
            (sharp.upper().volume() - sharp.lower().volume()) / (plain.upper_volume() - plain.lower_volume());
        assert!(ratio < 0.5, "seed {seed}: {ratio}");
    }
}

#[test]
fn contacts_that_coincide_but_for_rounding_change_nothing() {
    let radii = CurvatureRadii { min: 0.8, max: 1.3 };
    let mut s = crate::generators::Source::new(8);
    let single: Vec<ContactSample> = (0..200)
        .map(|_| s.direction())
        .map(|n| ContactSample { point: n, normal: Direction::new(n).unwrap() })
        .collect();
    let nudged = |c: &ContactSample, s: &mut crate::generators::Source| {
        let n = c.point + s.normal3() * 10.0_f64.powf(s.between(-17.0, -15.5));
        ContactSample { point: n, normal: Direction::new_unchecked(n) }
    };
    let double: Vec<ContactSample> =
        single.iter().map(|c| nudged(c, &mut s)).chain(single.iter().copied()).collect();
    let [one, two] = [single, double].map(|contacts| SharpBounds::from_contacts(&contacts, radii).unwrap());
    for (a, b) in [(one.lower().volume(), two.lower().volume()), (one.upper().volume(), two.upper().volume())]
    {
        assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
    }
}

/// Meshes of all curved bounds: the inner one in the body and the outer one around it, within the tolerance, closed and
/// outward, with volumes that enclose the exact one.
#[test]
fn polytopes_enclose_every_curved_bound() {
    let contacts = ellipsoid_contacts(30, 4);
    let tight = CurvatureBounds::from_contacts(&contacts, RADII).unwrap();
    let sharp = SharpBounds::from_contacts(&contacts, RADII).unwrap();
    let tolerance = 2e-2;
    let faceted = [
        (tight.lower().faceted(tolerance), tight.lower().volume()),
        (tight.upper().faceted(tolerance), tight.upper().volume()),
        (sharp.lower().faceted(tolerance), sharp.lower().volume()),
        (sharp.upper().faceted(tolerance), sharp.upper().volume()),
    ];
    for (which, (polytopes, volume)) in faceted.into_iter().enumerate() {
        let polytopes = polytopes.unwrap_or_else(|e| panic!("{which}: {e}"));
        assert!(polytopes.largest_gap().unwrap().distance <= tolerance);
        let inner = polytopes.lower().solid().unwrap().mesh();
        let outer = polytopes.upper().bounded().unwrap();
        let (low, high) = (inner.moments().volume, outer.mesh().moments().volume);
        assert!(
            low < volume && volume < high && high - low < 0.06 * volume,
            "{which}: {low} {volume} {high}"
        );
        assert!(HullCertificate::of(&inner, &inner.vertices).unwrap().holds());
        let hold = |p: DVec3| match which {
            0 => tight.lower().contains(p),
            1 => tight.upper().contains(p),
            2 => sharp.lower().contains(p),
            _ => sharp.upper().contains(p),
        };
        let centre = polytopes.lower().solid().unwrap().moments().centroid;
        assert!(inner.vertices.iter().all(|v| hold(centre + (*v - centre) * (1.0 - 1e-12))), "{which}");
        assert!(outer.vertices().iter().all(|v| !hold(centre + (*v - centre) * (1.0 + 1e-9))), "{which}");
    }
    assert!(matches!(tight.upper().faceted(-1.0), Err(crate::FacetError::Tolerance { .. })));
    // A rod of no thickness has no interior.
    let rod = RoundedHull::of(&[DVec3::ZERO, DVec3::X], 0.0).unwrap();
    assert!(matches!(rod.faceted(0.1), Err(crate::FacetError::Bounds(_))));
}

/// Contacts on the caps of a capsule, with balls so large that its side is nearly flat: many planes around the upper bound pass
/// through its corners and edges, some of them twice.
#[test]
fn polytopes_around_sharp_edges_have_no_corner_beyond_their_planes() {
    for seed in 0..4 {
        let mut s = Source::new(700 + seed);
        let contacts: Vec<ContactSample> = (0..200)
            .map(|_| s.direction())
            .map(|n| ContactSample {
                point: 0.5 * n + DVec3::Z.copysign(DVec3::splat(n.z)) * DVec3::Z,
                normal: Direction::new(n).unwrap(),
            })
            .collect();
        let radii = CurvatureRadii { min: 0.0, max: 1000.0 };
        let bounds = SharpBounds::from_contacts(&contacts, radii).unwrap();
        for tolerance in [0.1, 0.03, 3e-3, 1e-3] {
            let polytopes = bounds.upper().faceted(tolerance).unwrap();
            let outer = polytopes.upper().bounded().unwrap();
            let excess = outer.vertices().iter().map(|v| outer.excess(*v)).fold(0.0, f64::max);
            assert!(excess < 1e-14, "seed {seed}, tolerance {tolerance}: {excess:.1e}");
            assert!(polytopes.lower_volume() < bounds.upper().volume());
            assert!(bounds.upper().volume() < outer.volume());
        }
    }
}
