//! How noisy contacts in the plane are, from the contacts themselves.

use super::lift::{lifted, lowered};
use super::model::{ContactNoise, NoiseError, NoisyContact};
use crate::noise::FEWEST;
use crate::noise::assumptions::{NoiseDoubt, as_found, correlated, tested};
use crate::noise::consistency::{estimated, raise};
use crate::planar::ContactSample;

/// Contacts with the noise that they themselves show, curve by curve, each in the order in which it was traced: the twin
/// of [`crate::noise::estimate_noise`], which says how.
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
        let curve: Vec<NoisyContact> = curve.iter().map(exact).collect();
        let z = raise(confidence, curves.len());
        Ok(lowered(&curve, &estimated(lifted(&curve), 2, z)))
    };
    curves.iter().enumerate().map(of_curve).collect()
}

/// `curves` with noise no smaller than they show themselves, and what was stated too small: the twin of
/// [`crate::noise::with_noise_as_found`].
#[must_use]
pub fn with_noise_as_found(curves: &[Vec<NoisyContact>]) -> (Vec<Vec<NoisyContact>>, Vec<NoiseDoubt>) {
    let in_space: Vec<_> = curves.iter().map(|curve| lifted(curve)).collect();
    let (raised, doubts) = as_found(&in_space, 2);
    (curves.iter().zip(&raised).map(|(curve, raised)| lowered(curve, raised)).collect(), doubts)
}

/// Whether the noise of contacts is alike from one to the next, along all curves together.
#[must_use]
pub fn correlated_noise(curves: &[Vec<NoisyContact>]) -> Option<NoiseDoubt> {
    correlated(&curves.iter().map(|curve| lifted(curve)).collect::<Vec<_>>(), 2)
}

/// Whether [`correlated_noise`] would find a random walk: the twin of [`crate::noise::independence_is_tested`].
#[must_use]
pub fn independence_is_tested(curves: &[Vec<NoisyContact>]) -> bool {
    tested(&curves.iter().map(|curve| lifted(curve)).collect::<Vec<_>>(), 2)
}
