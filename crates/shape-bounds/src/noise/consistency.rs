//! How noisy contacts are, from the contacts themselves: the roughness of curves that are smooth.

use super::model::{ContactNoise, NoiseError, NoisyContact};
use super::quantile;
use super::traced::{FEWEST, Part, Traced};
use crate::sample::ContactSample;

/// Orders of differences that are tried: a low one still holds a part of the curve, a high one amplifies the noise of the
/// estimate. Each overestimates the noise by what it leaves of the curve, so that the smallest is right.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=5;

/// Contacts with the noise that they themselves show, curve by curve, each in the order in which it was traced.
///
/// Differences of order 2 to 5 along a curve take away a smooth curve and leave its noise. Their median absolute values
/// give standard deviations of the point across and along the surface and of the normal, which a few outliers do not
/// change. Being estimates, they are raised so far that the true ones are below them at the stated `confidence`. One level is
/// found for a curve; [`with_noise_as_found`](crate::noise::with_noise_as_found) raises it where a part of the curve is rougher. What
/// neighbours have in common, as the error of a pose that drifts, is not seen: state it in
/// [`ContactNoise::pose`].
///
/// # Errors
/// [`NoiseError`] for an impossible confidence, a curve of fewer than 30 contacts, and a point that is not finite.
pub fn estimate_noise(
    curves: &[Vec<ContactSample>],
    confidence: f64,
) -> Result<Vec<Vec<NoisyContact>>, NoiseError> {
    NoiseError::check_confidence(confidence)?;
    let of_curve = |(index, curve): (usize, &Vec<ContactSample>)| {
        if curve.len() < FEWEST {
            return Err(NoiseError::TooFewToJudge { curve: index, found: curve.len(), needed: FEWEST });
        }
        if let Some(contact) = curve.iter().position(|c| !c.point.is_finite()) {
            return Err(NoiseError::NotFinite { curve: index, index: contact, point: curve[contact].point });
        }
        let exact = |contact: &ContactSample| NoisyContact {
            contact: *contact,
            noise: ContactNoise::isotropic(0.0, 0.0),
        };
        Ok(estimated(curve.iter().map(exact).collect(), 3, raise(confidence, curves.len())))
    };
    curves.iter().enumerate().map(of_curve).collect()
}

/// By how many of its standard deviations each of three estimates a curve is raised, so that all are above the truth.
pub(crate) fn raise(confidence: f64, curves: usize) -> f64 {
    let each = (1.0 - confidence) / (3 * curves.max(1)) as f64;
    quantile::normal(each.min(0.1))
}

/// A curve of contacts, with the noise of each raised to the one that all show, and by `z` standard deviations of the estimate.
pub(crate) fn estimated(mut contacts: Vec<NoisyContact>, dimension: usize, z: f64) -> Vec<NoisyContact> {
    let curve = Traced { contacts: &contacts, dimension };
    let levels = Part::ALL.map(|part| {
        let of_order = |order| {
            let (deviation, relative) = curve.deviation(part, order, 1);
            deviation * (1.0 + z * relative)
        };
        ORDERS.map(of_order).fold(f64::INFINITY, f64::min)
    });
    for contact in &mut contacts {
        Part::ALL.iter().zip(levels).for_each(|(part, level)| part.raise(contact, dimension, level));
    }
    contacts
}
