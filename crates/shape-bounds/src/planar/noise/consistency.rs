//! How noisy contacts in the plane are, from the contacts themselves.

use super::model::{ContactNoise, NoiseError, NoisyContact};
use crate::noise::consistency::{FEWEST, deviation, raise};
use crate::planar::ContactSample;
use glam::{DMat2, DVec3};

/// Contacts with the noise that they themselves show, curve by curve, each in the order in which it was traced: the twin
/// of [`crate::estimate_noise`], which says how.
///
/// # Errors
/// [`NoiseError`] for an impossible confidence, a curve of fewer than 30 contacts, and a point that is not finite.
pub fn estimate_noise(
    curves: &[Vec<ContactSample>],
    confidence: f64,
) -> Result<Vec<Vec<NoisyContact>>, NoiseError> {
    NoiseError::check_confidence(confidence)?;
    let z = raise(confidence, curves.len());
    curves.iter().enumerate().map(|(index, curve)| of_curve(index, curve, z)).collect()
}

fn of_curve(index: usize, curve: &[ContactSample], z: f64) -> Result<Vec<NoisyContact>, NoiseError> {
    if curve.len() < FEWEST {
        return Err(NoiseError::TooFewToJudge { curve: index, found: curve.len(), needed: FEWEST });
    }
    if let Some(contact) = curve.iter().position(|c| !c.point.is_finite()) {
        return Err(NoiseError::NotFinite { curve: index, index: contact, point: curve[contact].point });
    }
    let points: Vec<DVec3> = curve.iter().map(|c| c.point.extend(0.0)).collect();
    let normals: Vec<DVec3> = curve.iter().map(|c| c.normal.get().extend(0.0)).collect();
    let across = deviation(&points, &normals, z, |n, d| vec![n.dot(d)]);
    let along = |n: DVec3, d: DVec3| vec![DVec3::Z.cross(n).dot(d)];
    let tangential = deviation(&points, &normals, z, along);
    let normal = deviation(&normals, &normals, z, along);
    let noise = |c: &ContactSample| {
        let n = c.normal.get();
        let outer = DMat2::from_cols(n * n.x, n * n.y);
        let tangent = (DMat2::IDENTITY - outer) * (tangential * tangential);
        ContactNoise {
            point: outer * (across * across) + tangent,
            normal,
            ..ContactNoise::isotropic(0.0, 0.0)
        }
    };
    Ok(curve.iter().map(|c| NoisyContact { contact: *c, noise: noise(c) }).collect())
}
