//! Planar fits: derivatives, exact recovery, consistent covariances, choice, refusals.

mod refusal;

use super::*;
use crate::generators::Source;
use crate::planar::ContactSample;
use contact_kinematics::planar::FourierBody;
use exact_hull::planar::Direction;
use std::f64::consts::TAU;

fn measured(body: &dyn RadiusFunction, angles: &[f64], noise: f64, s: &mut Source) -> Vec<NoisyContact> {
    angles
        .iter()
        .map(|angle| {
            let point = body.point(*angle) + DVec2::new(s.normal(), s.normal()) * noise;
            let contact = ContactSample { point, normal: Direction::from_angle(angle + s.normal() * noise) };
            NoisyContact { contact, noise: ContactNoise::isotropic(noise.max(1e-3), noise.max(1e-3)) }
        })
        .collect()
}

fn scattered(count: usize, s: &mut Source) -> Vec<f64> {
    (0..count).map(|_| s.between(0.0, TAU)).collect()
}

fn fit(contacts: &[NoisyContact], family: OutlineFamily) -> Result<OutlineFit, FitError> {
    OutlineFit::of(contacts, family, &FitOptions::default())
}

fn bodies() -> Vec<(Box<dyn RadiusFunction>, OutlineFamily, DVector<f64>)> {
    let ellipse = DVector::from_column_slice(&[0.1, -0.3, 1.4, 0.3, 0.8]);
    let waves = DVector::from_column_slice(&[1.0, 0.1, 0.2, 0.08, -0.05, 0.03, 0.02, -0.01, 0.015]);
    let circle = DVector::from_column_slice(&[0.4, -0.2, 0.9]);
    [
        (OutlineFamily::Circle, circle),
        (OutlineFamily::Ellipse, ellipse),
        (OutlineFamily::Fourier { order: 4 }, waves),
    ]
    .into_iter()
    .map(|(family, theta)| {
        let body: Box<dyn RadiusFunction> = Box::new(family::outline(family, &theta).unwrap());
        (body, family, theta)
    })
    .collect()
}

#[test]
fn derivatives_agree_with_differences() {
    let mut s = Source::new(1);
    for (body, family, theta) in bodies() {
        let own = model(family);
        let mut columns = vec![DVec2::ZERO; own.count()];
        for angle in scattered(30, &mut s) {
            own.columns(&theta, angle, &mut columns).unwrap();
            for (i, column) in columns.iter().enumerate() {
                let at = |h: f64| {
                    let mut theta = theta.clone();
                    theta[i] += h;
                    own.body(&theta).unwrap().point(angle)
                };
                assert!(((at(1e-6) - at(-1e-6)) / 2e-6 - *column).length() < 1e-8, "{}", own.name(i));
            }
            let slope = (body.point(angle + 1e-6) - body.point(angle - 1e-6)) / 2e-6;
            assert!((slope - DVec2::from_angle(angle).perp() * body.jet(angle).rho).length() < 1e-8);
            assert!((body.jet(angle).r - body.point(angle).dot(DVec2::from_angle(angle))).abs() < 1e-14);
        }
    }
}

#[test]
fn exact_contacts_give_the_outline_back_and_noisy_ones_true_covariances() {
    for (body, family, theta) in bodies() {
        let mut s = Source::new(2);
        let angles = scattered(25, &mut s);
        let found = fit(&measured(body.as_ref(), &angles, 0.0, &mut s), family).unwrap();
        assert!((found.parameters() - &theta).amax() < 1e-10, "{family} {}", found.parameters());
        let noise = 3e-3;
        let mut bound = measured(body.as_ref(), &angles, 0.0, &mut s);
        bound.iter_mut().for_each(|c| c.noise = ContactNoise::isotropic(noise, noise));
        let bound = fit(&bound, family).unwrap().covariance().clone().try_inverse().unwrap();
        let (mut nees, mut efficiency) = (0.0, 0.0);
        let runs = 400;
        for _ in 0..runs {
            let fit = fit(&measured(body.as_ref(), &angles, noise, &mut s), family).unwrap();
            assert_eq!(fit.statistics().active_constraints, 0);
            let error = fit.parameters() - &theta;
            nees += error.dot(&fit.covariance().clone().cholesky().unwrap().solve(&error));
            efficiency += error.dot(&(&bound * &error));
        }
        let terms = (runs * theta.len()) as f64;
        // Four standard deviations of a mean of chi-squares.
        let band = 4.0 * (2.0 / terms).sqrt();
        assert!((nees / terms - 1.0).abs() < band, "{family}: {}", nees / terms);
        assert!((efficiency / terms - 1.0).abs() < band, "{family}: {}", efficiency / terms);
    }
}

#[test]
fn the_true_family_is_chosen() {
    let families = [
        OutlineFamily::Circle,
        OutlineFamily::Ellipse,
        OutlineFamily::Fourier { order: 2 },
        OutlineFamily::Fourier { order: 3 },
        OutlineFamily::Fourier { order: 4 },
        OutlineFamily::Fourier { order: 5 },
        OutlineFamily::Fourier { order: 8 },
    ];
    let runs = crate::few_or_all(20, 50);
    for (body, family, _) in bodies() {
        let hits = (0..runs)
            .filter(|seed| {
                let mut s = Source::new(*seed);
                let angles = scattered(60, &mut s);
                let contacts = measured(body.as_ref(), &angles, 2e-3, &mut s);
                let chosen = OutlineFit::choose(&contacts, &families, &FitOptions::default()).unwrap();
                chosen.best.family() == family
            })
            .count();
        assert!(10 * hits >= 9 * runs as usize, "{family}: {hits} of {runs}");
    }
}

#[test]
fn waves_are_held_convex() {
    // Contacts on half of a flat ellipse, with noise: free waves bend inwards elsewhere.
    let body = TurnedEllipse::new(DVec2::ZERO, [1.0, 0.0, 0.25]).unwrap();
    let mut held = 0;
    for seed in 0..20 {
        let mut s = Source::new(seed);
        let angles: Vec<f64> = (0..60).map(|_| s.between(0.0, 3.5)).collect();
        let contacts = measured(&body, &angles, 1e-2, &mut s);
        let options = FitOptions { smallest_radius: Some(0.05), ..FitOptions::default() };
        let Ok(fit) = OutlineFit::of(&contacts, OutlineFamily::Fourier { order: 4 }, &options) else {
            continue;
        };
        held += usize::from(fit.statistics().active_constraints > 0);
        assert!(fit.radius_bounds().min >= 0.05);
    }
    assert!(held > 3, "{held}");
}

#[test]
fn open_parameters_and_bad_values_are_named() {
    let body = FourierBody::new(&[1.0, 0.0, 0.1], &[0.0, 0.0, 0.0]).unwrap();
    let mut s = Source::new(4);
    let arc: Vec<f64> = (0..40).map(|i| 0.01 * f64::from(i)).collect();
    let short = measured(&body, &arc, 1e-3, &mut s);
    assert!(matches!(fit(&short, OutlineFamily::Fourier { order: 6 }), Err(FitError::Undetermined { .. })));
    let two = &short[..2];
    assert!(matches!(fit(two, OutlineFamily::Ellipse), Err(FitError::TooFew { found: 2, needed: 3, .. })));
    let mut bad = short.clone();
    bad[3].contact.point.x = f64::NAN;
    assert!(matches!(fit(&bad, OutlineFamily::Circle), Err(FitError::NotFinite { index: 3, .. })));
    let mut bad = short.clone();
    bad[5].noise.normal = f64::NAN;
    assert!(matches!(
        fit(&bad, OutlineFamily::Circle),
        Err(FitError::Noise { index: 5, name: "normal", .. })
    ));
    bad[5].noise = ContactNoise::isotropic(0.0, 1.0);
    assert!(matches!(fit(&bad, OutlineFamily::Circle), Err(FitError::Noise { index: 5, name: "point", .. })));
    assert!(matches!(fit(&[short[0]; 4], OutlineFamily::Circle), Err(FitError::NoExtent { found: 4 })));
}
