//! Contacts with palms of any shape and pose: independent of the search that finds them, and at the edge of what it can do.

use contact_kinematics::{
    BodyPlace, ContactError, Direction, Ellipsoid, MotionLaw, MotionPart, PalmSurface, PolynomialSupport,
    PoseTable, Sphere, SupportFunction, SurfaceContact, SurfaceError, SurfaceMotion, SurfacePose,
};
use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;

fn unit() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0f64)
        .prop_map(DVec3::from_array)
        .prop_filter("not zero", |v| v.length() > 0.1)
        .prop_map(DVec3::normalize)
}

fn rotation() -> impl Strategy<Value = DQuat> {
    (unit(), -3.0..3.0f64).prop_map(|(axis, angle)| DQuat::from_axis_angle(axis, angle))
}

fn semi_axes() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(0.3..1.5f64).prop_map(DVec3::from_array)
}

fn moving(pose: SurfacePose) -> SurfaceMotion {
    // Each part is at zero at t = 0, where the palm stands in its pose.
    let law = |frequency: f64, phase: f64| MotionLaw::Sinusoid {
        mean: -0.2 * phase.sin(),
        amplitude: 0.2,
        frequency,
        phase,
    };
    SurfaceMotion::Parts {
        pose,
        parts: vec![
            MotionPart::Turn { pivot: DVec3::new(0.2, -0.1, 0.4), axis: Direction::X, law: law(1.3, 0.2) },
            MotionPart::Shift { direction: Direction::Y, law: law(2.1, 1.0) },
            MotionPart::Turn { pivot: DVec3::ZERO, axis: Direction::Z, law: law(0.7, 2.0) },
        ],
    }
}

/// A palm of each kind whose contact with the body has the given body-frame normal and gap.
fn touching(
    kind: usize,
    radius: f64,
    (body, place): (&Ellipsoid, &BodyPlace),
    u_W: DVec3,
    gap: f64,
) -> (PalmSurface, SurfacePose) {
    let n_O = Direction::new(place.R_WO.transpose() * u_W).unwrap();
    let c = place.p_WCm + place.R_WO * body.jet(n_O).point;
    let z = DQuat::from_rotation_arc(DVec3::Z, -u_W);
    let pose = |p_WP| SurfacePose::new(p_WP, z).unwrap();
    match kind {
        0 => (PalmSurface::Plane, pose(c + gap * u_W)),
        1 => (PalmSurface::Sphere { radius }, pose(c + (radius + gap) * u_W)),
        2 => {
            let radius = radius + body.curvature_radii().max * 1.05;
            (PalmSurface::Cup { radius }, pose(c - (radius - gap) * u_W))
        }
        _ => (PalmSurface::Cylinder { radius }, pose(c + (radius + gap) * u_W + z * DVec3::X * 3.0)),
    }
}

proptest! {
    #[test]
    fn the_contact_is_found_from_no_guess(
        axes in semi_axes(), q in rotation(), u in unit(), p in unit(), radius in 0.05..2.0f64, gap in -0.02..0.5f64, kind in 0..4usize,
    ) {
        let body = Ellipsoid::new(axes).unwrap();
        let place = BodyPlace { p_WCm: p, R_WO: DMat3::from_quat(q) };
        // In a cup the nearest point is the only stationary one as long as the gap leaves it wider than the body is flat.
        let gap = if kind == 2 { gap.min(0.02 * body.curvature_radii().max) } else { gap };
        let (surface, pose) = touching(kind, radius, (&body, &place), u, gap);
        let contact = SurfaceContact::new(&body, &place, surface, &pose.at_rest(), None).unwrap();
        prop_assert!((contact.gap - gap).abs() < 1e-12, "gap {} for {gap}", contact.gap);
        prop_assert!((contact.n + u).length() < 1e-10, "{:.1e}", (contact.n + u).length());
        prop_assert!((contact.t[0].cross(contact.t[1]) - contact.n).length() < 1e-14);
    }

    #[test]
    fn rates_are_those_of_differences(
        axes in semi_axes(), q in rotation(), u in unit(), v in unit(), w in unit(), radius in 0.1..1.0f64, gap in -0.01..0.1f64, kind in 0..4usize,
    ) {
        let body = Ellipsoid::new(axes).unwrap();
        let start = BodyPlace { p_WCm: DVec3::ZERO, R_WO: DMat3::from_quat(q) };
        let (surface, pose) = touching(kind, radius, (&body, &start), u, gap.min(0.01));
        let motion = moving(pose);
        let at = |t: f64| {
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(w * t));
            let place = BodyPlace { p_WCm: v * t, R_WO: turn * start.R_WO };
            let palm = motion.at(t);
            let contact = SurfaceContact::new(&body, &place, surface, &palm, None).unwrap();
            (contact, contact.rates(&palm, v, w).unwrap())
        };
        let h = 1e-5;
        let ((before, r0), (now, rates), (after, r1)) = (at(-h), at(0.0), at(h));
        // Where curvatures nearly match the path over the palm bends quickly: the differences are worth less.
        let scale = 1.0 + rates.p_dot_WC.length().powi(3) + rates.n_dot.length().powi(3);
        let near = |a: DVec3, b: DVec3, tolerance: f64| (a - b).length() < tolerance * scale;
        let difference = |a: f64, b: f64| (a - b) / (2.0 * h);
        prop_assert!((difference(after.gap, before.gap) - rates.gap_rate).abs() < 1e-8 * scale);
        prop_assert!(near((after.p_WC - before.p_WC) / (2.0 * h), rates.p_dot_WC, 1e-6));
        prop_assert!(near((after.n - before.n) / (2.0 * h), rates.n_dot, 1e-6));
        // The body is not accelerated: what is left of the second rates are the biases.
        prop_assert!(near((r1.slip - r0.slip) / (2.0 * h), rates.slip_bias, 1e-6));
        prop_assert!((difference(r1.gap_rate, r0.gap_rate) - rates.gap_bias).abs() < 1e-6 * scale);
        prop_assert!((now.n.dot(rates.slip) - rates.gap_rate).abs() < 1e-14);
    }

    #[test]
    fn parts_of_a_motion_have_the_derivatives_of_their_poses(p in unit(), q in rotation(), t in -2.0..2.0f64) {
        let motion = moving(SurfacePose::new(p, q).unwrap());
        let h = 1e-5;
        let (before, now, after) = (motion.at(t - h), motion.at(t), motion.at(t + h));
        let rate = |a: DVec3, b: DVec3| (a - b) / (2.0 * h);
        prop_assert!((rate(after.p_WP, before.p_WP) - now.v_WP).length() < 1e-9);
        prop_assert!((rate(after.v_WP, before.v_WP) - now.a_WP).length() < 1e-9);
        prop_assert!((rate(after.w_WP, before.w_WP) - now.alpha_WP).length() < 1e-9);
        let turn = (after.R_WP - before.R_WP) * (0.5 / h) * now.R_WP.transpose();
        prop_assert!((DVec3::new(turn.y_axis.z, turn.z_axis.x, turn.x_axis.y) - now.w_WP).length() < 1e-9);
    }
}

#[test]
fn a_table_follows_a_motion_to_its_order() {
    let motion = moving(SurfacePose::new(DVec3::new(0.3, 0.1, -0.2), DQuat::from_rotation_y(0.4)).unwrap());
    let error = |rows: u32| {
        let pose = |t: f64| {
            let state = motion.at(t);
            (t, SurfacePose::new(state.p_WP, DQuat::from_mat3(&state.R_WP)).unwrap())
        };
        let poses: Vec<_> = (0..=rows).map(|k| pose(f64::from(k) * 2.0 / f64::from(rows))).collect();
        let table = PoseTable::new(&poses).unwrap();
        let (mut position, mut acceleration) = (0.0_f64, 0.0_f64);
        for k in 0..997 {
            let t = f64::from(k) * 2.0 / 997.0;
            let (a, b) = (table.at(t), motion.at(t));
            position = position.max((a.p_WP - b.p_WP).length()).max((a.R_WP.x_axis - b.R_WP.x_axis).length());
            acceleration =
                acceleration.max((a.alpha_WP - b.alpha_WP).length()).max((a.a_WP - b.a_WP).length());
        }
        [position, acceleration]
    };
    let (coarse, fine) = (error(40), error(80));
    let order = [0, 1].map(|i| (coarse[i] / fine[i]).log2());
    assert!((3.6..4.6).contains(&order[0]) && (1.7..2.6).contains(&order[1]), "{order:?} {fine:?}");
}

#[test]
fn curvatures_that_nearly_match_cost_digits_and_then_are_an_error() {
    let body = Sphere::new(1.0).unwrap();
    let place = BodyPlace { p_WCm: DVec3::ZERO, R_WO: DMat3::IDENTITY };
    let pose = |excess: f64| SurfacePose::new(DVec3::Z * excess, DQuat::IDENTITY).unwrap();
    for excess in [1e-2, 1e-5, 1e-8] {
        let (surface, palm) = (PalmSurface::Cup { radius: 1.0 + excess }, pose(excess).at_rest());
        assert!(surface.check(body.curvature_radii()).is_ok());
        let contact = SurfaceContact::new(&body, &place, surface, &palm, None).unwrap();
        assert!(contact.gap.abs() < 1e-15, "{excess}: gap {:.1e}", contact.gap);
        // The contact is where the centres' line leaves the ball: rounding of it grows as 1 / excess.
        assert!((contact.n - DVec3::Z).length() < 4e-15 / excess, "{excess}: {:?}", contact.n);
        let rates = contact.rates(&palm, DVec3::X, DVec3::ZERO).unwrap();
        // Centres a distance `excess` apart: the line turns at v / excess.
        assert!((rates.n_dot.length() * excess - 1.0).abs() < 1e-6 + 1e-15 / excess, "{excess}");
    }
    let (surface, palm) = (PalmSurface::Cup { radius: 1.0 + 1e-12 }, pose(1e-12).at_rest());
    let result = SurfaceContact::new(&body, &place, surface, &palm, Some(-Direction::Z))
        .and_then(|contact| contact.rates(&palm, DVec3::X, DVec3::ZERO));
    assert!(
        matches!(result, Err(ContactError::Matching { .. } | ContactError::NotFound { .. })),
        "{result:?}"
    );
    let equal = PalmSurface::Cup { radius: 1.0 };
    assert!(matches!(equal.check(body.curvature_radii()), Err(SurfaceError::CupTooSmall { .. })));
}

/// Unit vectors spread evenly over the sphere.
fn spread(count: u32) -> impl Iterator<Item = DVec3> + Clone {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(count);
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
    })
}

/// In a cup no point of the body is nearer to it than the contact, wherever the body is: by a scan of its surface.
fn check_farthest(body: &impl SupportFunction, centres: &[DVec3]) {
    let points: Vec<DVec3> = spread(4000).map(|u| body.point(Direction::new(u).unwrap())).collect();
    let radius = 1.05 * body.curvature_radii().max;
    let place = BodyPlace { p_WCm: DVec3::ZERO, R_WO: DMat3::IDENTITY };
    for &centre in centres {
        let palm = SurfacePose::new(centre, DQuat::IDENTITY).unwrap().at_rest();
        let contact = SurfaceContact::new(body, &place, PalmSurface::Cup { radius }, &palm, None).unwrap();
        // Whatever the search starts from.
        for guess in [Direction::X, -Direction::Z] {
            let cup = PalmSurface::Cup { radius };
            let again = SurfaceContact::new(body, &place, cup, &palm, Some(guess)).unwrap();
            assert!((again.gap - contact.gap).abs() < 1e-12, "{} {}", again.gap, contact.gap);
        }
        let farthest = points.iter().map(|x| (*x - centre).length()).fold(0.0, f64::max);
        let missed = farthest - (radius - contact.gap);
        assert!(missed < 1e-12, "{missed:.1e} of {farthest} about {centre}");
    }
}

#[test]
fn in_a_cup_the_farthest_point_is_found() {
    let centres: Vec<DVec3> =
        spread(150).zip(spread(13).cycle()).map(|(u, v)| u * (0.5 + 0.5 * v.z)).collect();
    for axes in [DVec3::new(1.0, 0.99, 0.5), DVec3::new(1.0, 0.4, 0.41), DVec3::new(1.0, 1.0, 0.7)] {
        check_farthest(&Ellipsoid::new(axes).unwrap(), &centres);
    }
    // Three and four corners almost equally far.
    let corners = |k: usize, share: f64| {
        let mut harmonics: Vec<Vec<f64>> = (0..=k).map(|l| vec![0.0; 2 * l + 1]).collect();
        harmonics[0][0] = 1.0;
        harmonics[k][k] = share;
        harmonics[k][0] = share * 0.7;
        harmonics[k][2 * k] = -share * 0.4;
        PolynomialSupport::from_harmonics(&harmonics).unwrap()
    };
    for body in [corners(3, 0.05), corners(4, 0.025), corners(5, 0.015)] {
        assert!(body.curvature_radii().min > 0.0);
        check_farthest(&body, &centres);
    }
}

#[test]
fn bad_palms_are_named() {
    let radii = Sphere::new(1.0).unwrap().curvature_radii();
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(PalmSurface::Sphere { radius }.check(radii), Err(SurfaceError::Radius { .. })));
    }
    assert!(matches!(
        SurfacePose::new(DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 1.1)),
        Err(SurfaceError::NoRotation { .. })
    ));
    assert!(matches!(
        SurfacePose::new(DVec3::NAN, DQuat::IDENTITY),
        Err(SurfaceError::PoseNotFinite { what: "position", .. })
    ));
    let pose = SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).unwrap();
    assert!(matches!(PoseTable::new(&[(0.0, pose); 4]), Err(SurfaceError::Table { row: 1, .. })));
    let far = SurfacePose { p_WP: pose.p_WP + DVec3::X, ..pose };
    let over = SurfacePose { R_WP: DQuat::from_rotation_y(3.1) * pose.R_WP, ..pose };
    for (other, metres, degrees) in [(far, 1.0, 0.0), (over, 0.0, 3.1_f64.to_degrees())] {
        let rows = [pose, pose, other, other, other];
        let rows: Vec<_> = (0..5).map(|k| (1e-3 * f64::from(k), rows[k as usize])).collect();
        let Err(SurfaceError::Jump { row: 2, seconds, distance, degrees: turn, .. }) = PoseTable::new(&rows)
        else {
            panic!("taken")
        };
        assert!((seconds - 1e-3).abs() < 1e-15 && (distance - metres).abs() < 1e-12);
        assert!((turn - degrees).abs() < 1e-5);
    }
    assert!(matches!(PoseTable::new(&[(0.0, pose)]), Err(SurfaceError::Table { rows: 1, .. })));
    // A fingertip whose centre is inside of the body.
    let (body, palm) = (Sphere::new(1.0).unwrap(), pose.at_rest());
    let place = BodyPlace { p_WCm: DVec3::new(0.2, 0.0, 0.0), R_WO: DMat3::IDENTITY };
    let inside = SurfaceContact::new(&body, &place, PalmSurface::Sphere { radius: 0.1 }, &palm, None);
    assert!(
        matches!(inside, Err(ContactError::CentreInside { depth }) if (depth - 0.8).abs() < 1e-12),
        "{inside:?}"
    );
}
