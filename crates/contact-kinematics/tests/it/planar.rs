//! Planar shapes and contacts: one suite over every shape.

use contact_kinematics::planar::*;
use glam::DVec2;
use proptest::prelude::*;
use std::f64::consts::TAU;

fn shapes() -> Vec<(&'static str, Box<dyn RadiusFunction>)> {
    let corners = [(-0.03, -0.02), (0.04, -0.025), (0.045, 0.02), (0.0, 0.04), (-0.04, 0.01)];
    let corners = corners.map(|(x, y)| DVec2::new(x, y));
    vec![
        ("circle", Box::new(Circle::new(0.04, DVec2::new(0.004, -0.002)).unwrap())),
        ("ellipse", Box::new(Ellipse::new(0.05, 0.035, DVec2::new(0.004, -0.002)).unwrap())),
        (
            "fourier",
            Box::new(
                FourierBody::new(&[0.04, 0.003, 0.0045, 0.0006], &[0.0, -0.002, 0.001, -0.0008]).unwrap(),
            ),
        ),
        ("polygon", Box::new(RoundedPolygon::new(&corners, 0.006, 0.1).unwrap())),
    ]
}

/// Integral over one turn by the trapezoid rule; `f` is piecewise smooth at worst.
fn turn_integral(f: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    (0..n).map(|i| f(i as f64 * TAU / f64::from(n))).sum::<f64>() * TAU / f64::from(n)
}

#[test]
fn derivatives_agree_with_differences_and_the_outline_closes() {
    for (name, shape) in shapes() {
        let h = 1e-5;
        for i in 0..997 {
            let theta = f64::from(i) * TAU / 997.0;
            let (low, mid, high) = (shape.jet(theta - h), shape.jet(theta), shape.jet(theta + h));
            // Third derivatives are below 4 m, curvature jumps at most 0.4 m: errors below h^2 and h.
            assert!(((low.r - high.r) / (2.0 * h) - mid.d).abs() < 5e-6, "{name} d at {theta}");
            let bounds = shape.radius_bounds();
            assert!((bounds.min..=bounds.max).contains(&mid.rho), "{name} rho at {theta}: {}", mid.rho);
            if low.rho == high.rho || name != "polygon" {
                let rho = mid.r - (high.d - low.d) / (2.0 * h);
                assert!((rho - mid.rho).abs() < 1e-8, "{name} rho at {theta}: {rho} {}", mid.rho);
            }
        }
        let (x, y) =
            (turn_integral(|t| shape.jet(t).rho * t.cos()), turn_integral(|t| shape.jet(t).rho * t.sin()));
        assert!(x.hypot(y) < 1e-4, "{name} does not close: {x} {y}");
    }
}

#[test]
fn rounded_polygon_is_continuous_and_has_its_corners() {
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
    let body = RoundedPolygon::new(&square, 0.1, 0.05).unwrap();
    // In a corner the outline is the arc about the corner.
    let theta = std::f64::consts::FRAC_PI_4;
    assert!((body.point(theta) - DVec2::ONE - 0.1 * DVec2::from_angle(theta)).length() < 1e-15);
    // In the middle of an edge it bulges by the sagitta beyond the disc's radius.
    let sagitta = 2.0 / (2.0 * 0.05_f64.sin()) * (1.0 - 0.05_f64.cos());
    assert!((body.jet(0.0).r - 1.1 - sagitta).abs() < 1e-14);
    for i in 0..100_000 {
        let (a, b) = (f64::from(i) * TAU / 1e5, f64::from(i + 1) * TAU / 1e5);
        let gap = (body.point(b) - body.point(a)).length();
        assert!(gap <= body.radius_bounds().max * (b - a) * (1.0 + 1e-9), "jump of {gap} at {a}");
    }
}

#[test]
fn bad_shapes_and_palms_name_the_value() {
    assert!(matches!(Circle::new(0.0, DVec2::ZERO), Err(ShapeError::Length { value: 0.0, .. })));
    assert!(matches!(Ellipse::new(1.0, f64::NAN, DVec2::ZERO), Err(ShapeError::Length { .. })));
    assert!(matches!(FourierBody::new(&[1.0], &[]), Err(ShapeError::Coefficients { cosines: 1, sines: 0 })));
    // rho = 1 + (1 - 9) a_3 cos 3 theta touches zero at a_3 = 1/8.
    assert!(matches!(
        FourierBody::new(&[1.0, 0.0, 0.0, 0.126], &[0.0; 4]),
        Err(ShapeError::NotConvex { theta: 0.0, .. })
    ));
    assert!(FourierBody::new(&[1.0, 0.0, 0.0, 0.1249], &[0.0; 4]).is_ok());
    assert!(matches!(
        FourierBody::new(&[1.0, 0.0, 0.0, 0.125 * (1.0 - 1e-12)], &[0.0; 4]),
        Err(ShapeError::Unproved { .. })
    ));
    let corners = [DVec2::ZERO, DVec2::Y, DVec2::X];
    assert!(matches!(RoundedPolygon::new(&corners, 0.1, 0.1), Err(ShapeError::Corner { .. })));
    let corners = [DVec2::ZERO, DVec2::X, DVec2::Y];
    assert!(matches!(
        RoundedPolygon::new(&corners[..2], 0.1, 0.1),
        Err(ShapeError::TooFewCorners { found: 2 })
    ));
    assert!(matches!(RoundedPolygon::new(&corners, 0.1, 2.0), Err(ShapeError::Bulge { .. })));
    for phi2 in [0.0, -0.1, std::f64::consts::PI, 4.0] {
        assert!(matches!(PalmPair::new(0.0, phi2), Err(PalmPairError::Wedge { .. })));
    }
    assert!(matches!(PalmPair::new(f64::NAN, 1.0), Err(PalmPairError::NotFinite { what: "phi1", .. })));
}

proptest! {
    /// The contact point on the object and the one on the palm are one point of the world.
    #[test]
    fn contact_points_coincide(phi1 in -0.5..1.2f64, phi2 in 0.2..2.9f64, phi0 in -10.0..10.0f64) {
        let palms = PalmPair::new(phi1, phi2).unwrap();
        for (name, shape) in shapes() {
            let contact = PairContact::new(&shape.as_ref(), &palms, phi0);
            let spin = DVec2::from_angle(phi0);
            for i in 0..2 {
                let on_object = contact.p_WCm + spin.rotate(shape.point(palms.contact_directions(phi0)[i]));
                let on_palm = palms.along()[i] * contact.s[i];
                prop_assert!((on_object - on_palm).length() < 1e-13 / palms.sin(), "{name} palm {i}");
            }
        }
    }

    /// Velocities are the time derivatives of the positions along any motion of object and palms.
    #[test]
    fn velocities_agree_with_differences(phi1 in -0.5..1.2f64, phi2 in 0.5..2.6f64, phi0 in -3.0..3.0f64,
                                         omega in -5.0..5.0f64, w1 in -1.0..1.0f64, w2 in -1.0..1.0f64) {
        let shape = &shapes()[2].1;
        let h = 1e-5;
        let at = |t: f64| {
            let palms = PalmPair::from_absolute(phi1 + w1 * t, phi1 + phi2 + w2 * t).unwrap();
            PairContact::new(&shape.as_ref(), &palms, phi0 + omega * t)
        };
        let motion = PairRates { rates: [w1, w2], accelerations: [0.0; 2] };
        let state = PalmPairState { pair: PalmPair::new(phi1, phi2).unwrap(), motion };
        let velocity = at(0.0).velocity(&state, omega);
        let (low, high) = (at(-h), at(h));
        prop_assert!(((high.p_WCm - low.p_WCm) / (2.0 * h) - velocity.v_WCm).length() < 1e-6);
        for i in 0..2 {
            prop_assert!(((high.s[i] - low.s[i]) / (2.0 * h) - velocity.s_rates[i]).abs() < 1e-6);
        }
    }
}
