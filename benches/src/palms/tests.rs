//! What the study takes for granted: bodies are what their support functions say, and palms differ by their curvature alone.

use super::*;
use exploration::generators::Family;
use exploration::{Heading, Source};
use recon::contact_kinematics::{BodyPlace, Direction, SupportFunction, SurfaceContact, principal_radii};
use recon::object_dynamics::PalmDrive;

type Failure = Box<dyn std::error::Error>;

#[test]
fn bodies_are_of_one_size_round_enough_and_about_their_centre_of_mass() -> Result<(), Failure> {
    for family in Family::ALL {
        let body = palm_body(family, 7)?;
        let lattice = Direction::spread(3000);
        let mean = lattice.iter().map(|u| body.shape.value(*u)).sum::<f64>() / 3000.0;
        assert!((mean / SIZE - 1.0).abs() < 1e-3, "{family:?} {mean}");
        let radii = body.shape.curvature_radii();
        assert!(radii.min > 0.0 && radii.max <= 1.03 * FLATTEST * SIZE, "{family:?} {radii:?}");
        // The first moment over another lattice than it was found with.
        let first: glam::DVec3 = lattice
            .iter()
            .map(|u| {
                let jet = body.shape.jet(*u);
                let [a, b] = principal_radii(jet.hessian, *u);
                jet.point * (jet.value * a * b)
            })
            .sum();
        let moment = first / 3000.0 / (4.0 * SIZE.powi(3));
        assert!(moment.length() < 2e-3 * SIZE, "{family:?} {moment}");
    }
    Ok(())
}

#[test]
fn points_and_hessians_are_the_derivatives_of_the_support_functions() -> Result<(), Failure> {
    let mut source = Source::new(2);
    for family in Family::ALL {
        let body = palm_body(family, 3)?;
        for _ in 0..20 {
            let n = source.direction();
            let jet = body.shape.jet(n);
            let (a, b) = n.tangent_basis();
            for t in [a, b] {
                let at = |s: f64| Direction::new(n.get() + t * s).map(|n| body.shape.jet(n));
                let (before, after) = (at(-1e-5)?, at(1e-5)?);
                let slope = (after.value - before.value) / 2e-5;
                assert!((slope - jet.point.dot(t)).abs() < 1e-8, "{family:?} {slope}");
                let bend = (after.point - before.point) / 2e-5;
                assert!((bend - jet.hessian * t).length() < 1e-6, "{family:?} {bend}");
            }
            assert!(
                (jet.hessian * n.get()).length() < 1e-12
                    && (jet.point.dot(n.get()) - jet.value).abs() < 1e-14
            );
        }
    }
    Ok(())
}

#[test]
fn all_kinds_start_at_the_same_contacts_and_move_the_same() -> Result<(), Failure> {
    let body = palm_body(Family::Superquadric, 5)?;
    let (flat, start) = held(&body, PalmKind::Flat, &MOTION, 5)?;
    for kind in PalmKind::ALL {
        let (scene, other) = held(&body, kind, &MOTION, 5)?;
        assert_eq!(start, other);
        for (k, (a, b)) in flat.palms().iter().zip(scene.palms()).enumerate() {
            let (PalmDrive::Prescribed(a), PalmDrive::Prescribed(b)) = (&a.drive, &b.drive) else {
                return Err("a palm that is not driven".into());
            };
            for t in [0.0, 0.3, 0.7, 1.9, 4.0] {
                let (a, b) = (a.at(t), b.at(t));
                // One rigid motion: the same turn, and the same velocity of the material at any point.
                let far = glam::DVec3::new(0.1, -0.2, 0.3);
                assert!(
                    (a.w_WP - b.w_WP).length() < 1e-12 && (a.R_WP.x_axis - b.R_WP.x_axis).length() < 1e-12
                );
                assert!((a.material_velocity(far) - b.material_velocity(far)).length() < 1e-12);
            }
            let place = BodyPlace { p_WCm: start.p_WCm, R_WO: glam::DMat3::from_quat(start.R_WO) };
            let touch = |scene: &Held<'_>| {
                let palm = scene.0.palm_state(k, 0.0, &scene.0.palms_at_start()[k]);
                SurfaceContact::new(scene.0.body(), &place, scene.0.palms()[k].surface, &palm, None)
            };
            let (a, b) = (touch(&(flat.clone(), start))?, touch(&(scene.clone(), start))?);
            assert!(b.gap.abs() < 1e-12 && (a.p_WC - b.p_WC).length() < 1e-9 && (a.n - b.n).length() < 1e-8);
        }
    }
    Ok(())
}

#[test]
fn a_body_that_is_held_is_seen_more_and_more() -> Result<(), Failure> {
    let body = palm_body(Family::Ellipsoid, 150_000)?;
    let short = Motion { count: 2, ..MOTION };
    let run = palm_run(&body, PalmKind::Concave(5.0), &short, 150_000, false)?;
    assert_eq!(run.end, End::Held);
    assert!(run.looks.windows(2).all(|w| w[0][0] <= w[1][0] && w[0][1] >= w[1][1] - 1e-12));
    assert!(run.looks[LOOKS - 1][0] > 0.04 && run.touched > 2.0);
    Ok(())
}
