//! Oracles: differences along motions for rates, a fine scan over directions for gaps, the hinged pair for lines.

use super::*;
use crate::MotionLaw;
use crate::planar::{Circle, Ellipse, FourierBody, PairContact, PairRates, PalmPair, PalmPairState};
use crate::planar::{RadiusFunction, RoundedPolygon};
use glam::DVec2;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn fourier() -> FourierBody {
    FourierBody::new(&[0.04, 0.003, 0.0045, 0.0006], &[0.0, -0.002, 0.001, -0.0008]).unwrap()
}

fn shapes() -> Vec<(&'static str, Box<dyn RadiusFunction>)> {
    let corners = [(-0.03, -0.02), (0.04, -0.025), (0.045, 0.02), (0.0, 0.04), (-0.04, 0.01)];
    let corners = corners.map(|(x, y)| DVec2::new(x, y));
    vec![
        ("circle", Box::new(Circle::new(0.04, DVec2::new(0.004, -0.002)).unwrap())),
        ("ellipse", Box::new(Ellipse::new(0.05, 0.008, DVec2::new(0.004, -0.002)).unwrap())),
        ("fourier", Box::new(fourier())),
        ("polygon", Box::new(RoundedPolygon::new(&corners, 0.002, 0.05).unwrap())),
    ]
}

const SURFACES: [PalmSurface; 3] =
    [PalmSurface::Line, PalmSurface::Arc { radius: 0.012 }, PalmSurface::Cup { radius: 0.12 }];

/// A palm that is shifted along a slant and turned about a point off its origin, all at once.
fn moving_palm() -> SurfaceMotion {
    let swing = |amplitude, frequency, phase| MotionLaw::Sinusoid { mean: 0.0, amplitude, frequency, phase };
    SurfaceMotion {
        pose: SurfacePose::new(DVec2::new(0.01, -0.09), 0.2).unwrap(),
        parts: vec![
            MotionPart::Shift { direction: 0.4, law: swing(0.01, 5.0, 0.3) },
            MotionPart::Turn { pivot: DVec2::new(0.03, 0.02), law: swing(0.2, 4.0, 1.0) },
            MotionPart::Turn { pivot: DVec2::new(-0.05, 0.01), law: swing(0.1, 3.0, 2.0) },
        ],
    }
}

#[test]
fn motion_of_a_palm_agrees_with_differences() {
    let (motion, t, h) = (moving_palm(), 0.37, 1e-5);
    let (low, mid, high) = (motion.at(t - h), motion.at(t), motion.at(t + h));
    assert!(((high.p_WP - low.p_WP) / (2.0 * h) - mid.v_WP).length() < 1e-9);
    assert!(((high.v_WP - low.v_WP) / (2.0 * h) - mid.a_WP).length() < 1e-8);
    assert!(((high.angle - low.angle) / (2.0 * h) - mid.w_WP).abs() < 1e-9);
    assert!(((high.w_WP - low.w_WP) / (2.0 * h) - mid.alpha_WP).abs() < 1e-8);
    // Material that rides along keeps its place in the palm.
    let mark = mid.to_world(DVec2::new(0.02, 0.01));
    let ride = |s: &SurfaceState| s.to_world(DVec2::new(0.02, 0.01));
    assert!(((ride(&high) - ride(&low)) / (2.0 * h) - mid.material_velocity(mark)).length() < 1e-9);
    assert!((mid.to_palm(mark) - DVec2::new(0.02, 0.01)).length() < 1e-16);
}

/// Place and velocity of a body on a parabola with constant angular acceleration, at time `t`.
fn body_at(t: f64) -> (BodyPlace, DVec2, f64) {
    let (p, v, a) = (DVec2::new(0.02, 0.005), DVec2::new(0.3, -0.2), DVec2::new(-1.0, 2.0));
    let place = BodyPlace { p_WCm: p + v * t + 0.5 * a * t * t, phi0: 0.7 + 3.0 * t - 4.0 * t * t };
    (place, v + a * t, 3.0 - 8.0 * t)
}

#[test]
fn rates_agree_with_differences_off_contact_too() {
    let (shape, motion, h) = (fourier(), moving_palm(), 1e-5);
    for surface in SURFACES {
        for t in [0.0, 0.11, 0.23] {
            let at = |t: f64| {
                let (place, v, omega) = body_at(t);
                let palm = motion.at(t);
                let contact = SurfaceContact::new(&shape, &place, surface, &palm, None).unwrap();
                let rates = contact.rates(&palm, v, omega).unwrap();
                (contact, rates)
            };
            let ((low, low_rates), (mid, rates), (high, high_rates)) = (at(t - h), at(t), at(t + h));
            assert!(mid.gap.abs() > 1e-4, "{surface:?} touches by chance");
            let close = |what: &str, a: DVec2, b: DVec2, tolerance: f64| {
                assert!(((b - a) / (2.0 * h)).length() < tolerance, "{what} of {surface:?} at {t}: {a} {b}");
            };
            let two_h = 2.0 * h;
            let gap_rate = (high.gap - low.gap) / two_h;
            assert!((gap_rate - rates.gap_rate).abs() < 1e-8, "{surface:?} {gap_rate} {}", rates.gap_rate);
            close("contact", low.p_WC + two_h * rates.p_dot_WC, high.p_WC, 1e-7);
            close("normal", low.n + two_h * rates.n_dot, high.n, 1e-6);
            let (a, alpha) = (DVec2::new(-1.0, 2.0), -8.0);
            let slip_rate = a + alpha * mid.b_W.perp() + rates.slip_bias;
            close("slip", low_rates.slip + two_h * slip_rate, high_rates.slip, 1e-6);
            let second = (high_rates.gap_rate - low_rates.gap_rate) / two_h;
            let expected = mid.n.dot(a + alpha * mid.b_W.perp()) + rates.gap_bias;
            assert!((second - expected).abs() < 1e-6, "{surface:?}: {second} {expected}");
        }
    }
}

#[test]
fn lines_through_the_hinge_are_the_hinged_pair() {
    let (shape, phi0, omega0) = (fourier(), 0.4, 2.0);
    let pair = PalmPair::new(0.3, 1.2).unwrap();
    let state = PalmPairState { pair, motion: PairRates { rates: [0.7, -0.4], accelerations: [0.0; 2] } };
    let contact = PairContact::new(&shape, &pair, phi0);
    let velocity = contact.velocity(&state, omega0);
    let place = BodyPlace { p_WCm: contact.p_WCm, phi0 };
    for i in 0..2 {
        // Palm 2 is seen from its other side: its line runs towards the hinge.
        let angle = pair.angles()[i] + if i == 1 { PI } else { 0.0 };
        let palm = SurfaceState {
            w_WP: state.motion.rates[i],
            ..SurfacePose::new(DVec2::ZERO, angle).unwrap().at_rest()
        };
        let here = SurfaceContact::new(&shape, &place, PalmSurface::Line, &palm, None).unwrap();
        assert!(here.gap.abs() < 1e-16 && (here.n - pair.normals()[i]).length() < 1e-15);
        assert!((here.p_WC - pair.along()[i] * contact.s[i]).length() < 1e-16);
        let rates = here.rates(&palm, velocity.v_WCm, omega0).unwrap();
        assert!(rates.gap_rate.abs() < 1e-15);
        let along = rates.p_dot_WC.dot(pair.along()[i]);
        assert!((along - velocity.s_rates[i]).abs() < 1e-15, "{along} {}", velocity.s_rates[i]);
    }
}

#[test]
fn curvatures_that_nearly_match_keep_their_digits_and_matching_ones_are_refused() {
    let (radius, place) = (0.04, BodyPlace { p_WCm: DVec2::new(0.0, -1e-3), phi0: 0.3 });
    let disc = Circle::new(radius, DVec2::ZERO).unwrap();
    // A disc in a cup 1 mm wider: its centre goes round the cup's on a circle of 1 mm, its contact 41 times as fast.
    let (cup, palm) = (PalmSurface::Cup { radius: radius + 1e-3 }, SurfaceState::default());
    let contact = SurfaceContact::new(&disc, &place, cup, &palm, None).unwrap();
    assert!(contact.gap.abs() < 1e-16 && (contact.n - DVec2::Y).length() < 1e-13);
    let rates = contact.rates(&palm, DVec2::new(0.1, 0.0), 0.0).unwrap();
    assert!((rates.p_dot_WC - DVec2::new(4.1, 0.0)).length() < 1e-11, "{}", rates.p_dot_WC);
    // Centripetal: v^2 / 1 mm.
    assert!((rates.gap_bias + 0.1 * 0.1 / 1e-3).abs() < 1e-11, "{}", rates.gap_bias);
    // Off contact the distance of the far point may be the body's own radius: no single contact.
    let centred = BodyPlace { p_WCm: DVec2::new(0.0, -1e-14), phi0: 0.0 };
    let contact = SurfaceContact::new(&disc, &centred, cup, &palm, None).unwrap();
    assert!((contact.gap - 1e-3).abs() < 1e-13);
    assert!(matches!(contact.rates(&palm, DVec2::X, 0.0), Err(ContactError::Matching { .. })));
}

#[test]
fn bad_palms_are_named() {
    let bounds = Ellipse::new(0.05, 0.04, DVec2::ZERO).unwrap().radius_bounds();
    assert_eq!(PalmSurface::Arc { radius: -1.0 }.check(bounds), Err(SurfaceError::Radius { radius: -1.0 }));
    assert_eq!(
        PalmSurface::Cup { radius: 0.06 }.check(bounds),
        Err(SurfaceError::CupTooSmall { radius: 0.06, largest: bounds.max })
    );
    assert!(
        PalmSurface::Cup { radius: 0.063 }.check(bounds).is_ok() && PalmSurface::Line.check(bounds).is_ok()
    );
    assert!(matches!(
        SurfacePose::new(DVec2::new(0.0, f64::NAN), 0.0),
        Err(SurfaceError::Parameter { what: "y of the position", .. })
    ));
    let still = MotionLaw::Ramp { height: 0.1, start: 0.0, duration: 0.0 };
    let parts = vec![MotionPart::Turn { pivot: DVec2::ZERO, law: still }];
    let motion = SurfaceMotion { pose: SurfacePose::default(), parts };
    assert_eq!(motion.check(), Err(SurfaceError::Parameter { what: "duration", value: 0.0 }));
    let (disc, palm) = (Circle::new(0.1, DVec2::ZERO).unwrap(), SurfaceState::default());
    let place = BodyPlace { p_WCm: DVec2::new(0.06, 0.0), phi0: 0.0 };
    let found = SurfaceContact::new(&disc, &place, PalmSurface::Arc { radius: 0.01 }, &palm, None);
    assert!(matches!(found, Err(ContactError::CentreInside { depth }) if (depth - 0.04).abs() < 1e-15));
    let lost = BodyPlace { p_WCm: DVec2::NAN, phi0: 0.0 };
    let found = SurfaceContact::new(&disc, &lost, PalmSurface::Line, &palm, None);
    assert_eq!(found, Err(ContactError::NotFinite));
}

/// Gap of every point of a fine outline.
fn scanned_gap(
    shape: &dyn RadiusFunction,
    place: &BodyPlace,
    surface: PalmSurface,
    palm: &SurfaceState,
) -> f64 {
    let spin = DVec2::from_angle(place.phi0);
    let gaps = (0..20_000).map(|i| {
        let p = place.p_WCm + spin.rotate(shape.point(f64::from(i) * TAU / 2e4));
        match surface {
            PalmSurface::Line => palm.to_palm(p).y,
            PalmSurface::Arc { radius } => (p - palm.p_WP).length() - radius,
            PalmSurface::Cup { radius } => radius - (p - palm.p_WP).length(),
        }
    });
    gaps.fold(f64::INFINITY, f64::min)
}

#[test]
fn of_two_corners_almost_equally_far_the_farther_is_taken() {
    // Of 128 directions the best one belongs to the wrong corner.
    let palm = SurfacePose::new(DVec2::new(0.09640239681276727, 0.10187999640960906), 0.0).unwrap().at_rest();
    let place = BodyPlace { p_WCm: DVec2::new(0.01, 0.02), phi0: 7.977220753808501 };
    let cup = PalmSurface::Cup { radius: 0.12 };
    let (_, polygon) = shapes().pop().unwrap();
    let found = SurfaceContact::new(polygon.as_ref(), &place, cup, &palm, None).unwrap();
    let scanned = scanned_gap(polygon.as_ref(), &place, cup, &palm);
    assert!(found.gap <= scanned && scanned < found.gap + 1e-8, "{} {scanned}", found.gap);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// The gap is the smallest over the outline, from any start.
    #[test]
    fn gap_is_the_smallest_over_the_outline(x in -0.2..0.2f64, y in -0.2..0.2f64, angle in -10.0..10.0f64,
                                            phi0 in -10.0..10.0f64, guess in -10.0..10.0f64) {
        let palm = SurfacePose::new(DVec2::new(x, y), angle).unwrap().at_rest();
        let place = BodyPlace { p_WCm: DVec2::new(0.01, 0.02), phi0 };
        for (name, shape) in shapes() {
            for surface in SURFACES {
                let warm = SurfaceContact::new(shape.as_ref(), &place, surface, &palm, Some(guess));
                if let Err(ContactError::CentreInside { .. }) = warm {
                    // The fine outline then surrounds the centre; nothing else is told.
                    prop_assert!(surface == PalmSurface::Arc { radius: 0.012 }, "{name}");
                    continue;
                }
                let (warm, gap) = (warm.unwrap(), scanned_gap(shape.as_ref(), &place, surface, &palm));
                let cold = SurfaceContact::new(shape.as_ref(), &place, surface, &palm, None).unwrap();
                prop_assert!((warm.gap - cold.gap).abs() < 1e-14, "{name} {surface:?} {} {}", warm.gap, cold.gap);
                // Half a step `s` of the outline beside the foot: sqrt(d^2 + s^2) - d <= s^2 / (2 d) at a distance d.
                let distance = match surface {
                    PalmSurface::Arc { radius } => (warm.gap + radius).min(1e-3),
                    PalmSurface::Line | PalmSurface::Cup { .. } => 1e-3,
                };
                let slack = 0.5 * (shape.radius_bounds().max * TAU / 4e4).powi(2) / distance + 1e-15;
                prop_assert!(warm.gap <= gap + 1e-15 && gap < warm.gap + slack, "{name} {surface:?} {gap}");
                // The foot on the palm is where the normal says.
                let foot = warm.p_WC - warm.gap * warm.n;
                let off = match surface {
                    PalmSurface::Line => palm.to_palm(foot).y,
                    PalmSurface::Arc { radius } | PalmSurface::Cup { radius } => (foot - palm.p_WP).length() - radius,
                };
                prop_assert!(off.abs() < 1e-13, "{name} {surface:?} {off}");
            }
        }
    }
}
