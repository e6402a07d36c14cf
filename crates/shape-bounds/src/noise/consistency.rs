//! How noisy contacts are, from the contacts themselves: the roughness of curves that are smooth.

use super::model::{ContactNoise, NoiseError, NoisyContact};
use super::pose::PoseNoise;
use super::quantile;
use crate::median::{OF_NORMAL, median};
use crate::sample::ContactSample;
use glam::{DMat3, DVec3};

/// Orders of differences that are tried: a low one still holds a part of the curve, a high one amplifies the noise of the
/// estimate. Each overestimates the noise by what it leaves of the curve, so that the smallest is right.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=5;
/// Fewest contacts of a curve that its noise is judged from.
pub(crate) const FEWEST: usize = 30;

/// Contacts with the noise that they themselves show, curve by curve, each in the order in which it was traced.
///
/// Differences of order 2 to 5 along a curve take away a smooth curve and leave its noise. Their median absolute values
/// give standard deviations of the point across and along the surface and of the normal, which a few outliers do not
/// change. Being estimates, they are raised so far that the true ones are below them at the stated `confidence`. What
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
    let z = raise(confidence, curves.len());
    curves.iter().enumerate().map(|(index, curve)| of_curve(index, curve, z)).collect()
}

/// By how many of its standard deviations each of three estimates a curve is raised, so that all are above the truth.
pub(crate) fn raise(confidence: f64, curves: usize) -> f64 {
    let each = (1.0 - confidence) / (3 * curves.max(1)) as f64;
    quantile::normal(each.min(0.1))
}

fn of_curve(index: usize, curve: &[ContactSample], z: f64) -> Result<Vec<NoisyContact>, NoiseError> {
    if curve.len() < FEWEST {
        return Err(NoiseError::TooFewToJudge { curve: index, found: curve.len(), needed: FEWEST });
    }
    if let Some(contact) = curve.iter().position(|c| !c.point.is_finite()) {
        return Err(NoiseError::NotFinite { curve: index, index: contact, point: curve[contact].point });
    }
    let points: Vec<DVec3> = curve.iter().map(|c| c.point).collect();
    let normals: Vec<DVec3> = curve.iter().map(|c| c.normal.get()).collect();
    let across = |n: DVec3, d: DVec3| vec![n.dot(d)];
    let along = |n: DVec3, d: DVec3| {
        let (a, b) = n.any_orthonormal_pair();
        vec![a.dot(d), b.dot(d)]
    };
    let across = deviation(&points, &normals, z, across);
    let tangential = deviation(&points, &normals, z, along);
    let normal = deviation(&normals, &normals, z, along);
    let noise = |n: DVec3| {
        let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        let tangent = (DMat3::IDENTITY - outer) * (tangential * tangential);
        ContactNoise { point: outer * (across * across) + tangent, normal, pose: PoseNoise::NONE }
    };
    Ok(curve.iter().map(|c| NoisyContact { contact: *c, noise: noise(c.normal.get()) }).collect())
}

/// Standard deviation of the components of `values` that `components` picks by the normal there; above the true one by
/// `z` standard deviations of the estimate.
pub(crate) fn deviation(
    values: &[DVec3],
    normals: &[DVec3],
    z: f64,
    components: impl Fn(DVec3, DVec3) -> Vec<f64>,
) -> f64 {
    let of_order = |order: usize| {
        let (weights, overlap) = binomials(order);
        let gain = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        let mut sizes: Vec<f64> = values
            .windows(order + 1)
            .zip(&normals[order / 2..])
            .flat_map(|(run, n)| {
                let difference = run.iter().zip(&weights).map(|(x, w)| *x * *w).sum::<DVec3>();
                components(*n, difference)
            })
            .map(f64::abs)
            .collect();
        let (count, middle) = (sizes.len(), median(&mut sizes));
        // The variance of a median of normal deviates is 1.36 / n of theirs; overlapping differences say less.
        let relative = (1.36 * overlap / count as f64).sqrt();
        middle / (OF_NORMAL * gain) * (1.0 + z * relative)
    };
    ORDERS.map(of_order).fold(f64::INFINITY, f64::min)
}

/// Weights of the difference of an order, and the sum of its squared autocorrelations.
pub(super) fn binomials(order: usize) -> (Vec<f64>, f64) {
    let mut weights = vec![1.0];
    for _ in 0..order {
        let shifted = weights.iter().chain(&[0.0]);
        weights = shifted.zip(std::iter::once(&0.0).chain(&weights)).map(|(a, b)| a - b).collect();
    }
    let at = |lag: usize| weights.iter().zip(&weights[lag..]).map(|(a, b)| a * b).sum::<f64>();
    let square = |lag: usize| (at(lag) / at(0)).powi(2);
    let overlap = 1.0 + 2.0 * (1..=order).map(square).sum::<f64>();
    (weights, overlap)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_have_their_binomials_and_overlaps() {
        assert_eq!(binomials(2).0, [1.0, -2.0, 1.0]);
        // C(4 d, 2 d) / C(2 d, d)^2.
        assert!((binomials(2).1 - 70.0 / 36.0).abs() < 1e-14);
        assert!((binomials(5).1 - 184_756.0 / (252.0 * 252.0)).abs() < 1e-13);
    }
}
