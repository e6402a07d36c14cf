//! Outlines that their contacts refute.

use super::*;
use crate::fit::levenberg::LINEAR;
use crate::fit::{NoiseLevel, Refutation};
use contact_kinematics::planar::RoundedPolygon;

const UNKNOWN: FitOptions = FitOptions { noise_level: NoiseLevel::Estimated, smallest_radius: None };

/// A square with sides of 1 m and corners of 0.2 m: no circle, no ellipse, and no waves of low order.
fn rounded_square() -> RoundedPolygon {
    let corners = [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]].map(DVec2::from_array);
    RoundedPolygon::new(&corners, 0.2, 0.02).unwrap()
}

/// Contacts with the noise that they have stated.
fn noisy(body: &dyn RadiusFunction, count: usize, noise: f64, s: &mut Source) -> Vec<NoisyContact> {
    let angles = scattered(count, s);
    let mut contacts = measured(body, &angles, noise, s);
    contacts.iter_mut().for_each(|c| c.noise = ContactNoise::isotropic(noise, noise));
    contacts
}

#[test]
fn an_outline_of_no_family_is_refused_by_name_whether_the_noise_is_known_or_not() {
    let small = [OutlineFamily::Circle, OutlineFamily::Ellipse, OutlineFamily::Fourier { order: 3 }];
    for seed in 40..45 {
        let contacts = noisy(&rounded_square(), 120, 1e-3, &mut Source::new(seed));
        for family in small {
            let refused = fit(&contacts, family).unwrap_err();
            assert!(
                matches!(refused, FitError::Refuted { family: f, by: Refutation::ChiSquared { .. } } if f == family),
                "{refused}"
            );
            let refused = OutlineFit::of(&contacts, family, &UNKNOWN).unwrap_err();
            assert!(
                matches!(refused, FitError::Refuted { family: f, by: Refutation::Likeness { .. } } if f == family),
                "{refused}"
            );
            assert!(refused.to_string().contains("refuted by the contacts: residuals of"), "{refused}");
        }
        match OutlineFit::choose(&contacts, &small, &FitOptions::default()) {
            Err(FitError::NoneFits { candidates }) => assert_eq!(candidates.len(), 3),
            other => panic!("{seed} {other:?}"),
        }
        assert_eq!(
            OutlineFit::choose(&contacts, &small[..1], &UNKNOWN).unwrap_err(),
            OutlineFit::of(&contacts, small[0], &UNKNOWN).unwrap_err()
        );
    }
    assert_eq!(OutlineFit::choose(&[], &[], &UNKNOWN).unwrap_err(), FitError::NoFamily);
}

#[test]
fn an_exact_ellipse_is_called_one_and_nothing_larger_is_tried() {
    let body = TurnedEllipse::new(DVec2::new(0.1, -0.3), [1.0, 0.2, 0.6]).unwrap();
    for count in [12, 600] {
        let mut s = Source::new(44);
        let angles = scattered(count, &mut s);
        let contacts = measured(&body, &angles, 0.0, &mut s);
        let choice = OutlineFit::choose(&contacts, &OutlineFamily::candidates(count), &UNKNOWN).unwrap();
        assert_eq!(choice.best.family(), OutlineFamily::Ellipse);
        for candidate in &choice.candidates[2..] {
            let needless = FitError::Needless { family: candidate.family, exact: OutlineFamily::Ellipse };
            assert_eq!(candidate.outcome, Err(needless));
        }
    }
}

/// At a significance of one in ten thousand, three times a hundred fits of the right family are not refused.
#[test]
fn right_outlines_are_not_refused() {
    for (body, family, _) in bodies() {
        for seed in 0..100 {
            let count = [12, 60][seed % 2];
            let contacts =
                noisy(body.as_ref(), count, [1e-3, 1e-2][seed / 2 % 2], &mut Source::new(seed as u64 + 7100));
            for options in [FitOptions::default(), UNKNOWN] {
                match OutlineFit::of(&contacts, family, &options) {
                    Ok(fit) => assert!(3 * fit.statistics().iterations <= LINEAR, "{seed}"),
                    Err(error) => panic!("{seed}: {error}"),
                }
            }
        }
    }
}

/// Contacts as near one another as their noise: those that are measured nearest have alike errors, which is not the shape's.
#[test]
fn dense_contacts_of_a_right_outline_are_not_refused() {
    let body = TurnedEllipse::new(DVec2::ZERO, [1.0, 0.2, 0.6]).unwrap();
    for seed in 0..20 {
        let contacts = noisy(&body, 600, 3e-2, &mut Source::new(seed + 7300));
        let fit = OutlineFit::of(&contacts, OutlineFamily::Ellipse, &UNKNOWN);
        assert!(fit.is_ok(), "{seed}: {}", fit.unwrap_err());
    }
}
