//! Bounds that hold at a stated confidence when contacts are measured with noise: the twin of those in space, which say
//! why.

mod consistency;
mod lift;
mod lower;
mod model;
mod outliers;
#[cfg(test)]
mod tests;
mod upper;
mod windows;

pub use consistency::{correlated_noise, estimate_noise, independence_is_tested, with_noise_as_found};
pub use model::{ContactNoise, NoiseError, NoisyContact};
pub use outliers::without_outliers;

use super::{BoundsError, ShapeBounds};
use exact_hull::planar::Hull;
use glam::DVec2;
use lower::certain_points;
use upper::certain_half_planes;
use windows::{Window, windows};

/// The lower one of [`ShapeBounds::from_noisy_curves`] alone, for contacts that leave a side open.
///
/// # Errors
/// As there, but for [`NoiseError::NoUpperBound`].
pub fn certain_lower_bound(curves: &[Vec<NoisyContact>], confidence: f64) -> Result<Hull, NoiseError> {
    let (lists, alpha) = checked(curves, confidence)?;
    Ok(Hull::of(&points(&lists, alpha)?).map_err(BoundsError::from)?)
}

/// Means over contacts, and what may go wrong of one bound.
fn checked(curves: &[Vec<NoisyContact>], confidence: f64) -> Result<(Vec<Vec<Window>>, f64), NoiseError> {
    NoiseError::check_confidence(confidence)?;
    NoiseError::check_contacts(curves)?;
    let contacts: Vec<_> = curves.iter().flatten().map(|c| c.contact).collect();
    ShapeBounds::check(&contacts)?;
    Ok((windows(curves), (1.0 - confidence) / 2.0))
}

fn points(lists: &[Vec<Window>], alpha: f64) -> Result<Vec<DVec2>, NoiseError> {
    let points = certain_points(lists, alpha);
    if points.is_empty() { Err(NoiseError::NoLowerBound) } else { Ok(points) }
}

impl ShapeBounds {
    /// Bounds between which a convex outline lies with at least the stated `confidence` (say 0.95), for both bounds and all
    /// contacts together.
    ///
    /// `curves` are the measured contacts, each curve in the order in which it was traced: means over neighbours carry
    /// less noise and are used wherever they prove more. Half-planes are moved outwards and the hull is eroded by margins
    /// from the union bound over all contacts and means.
    ///
    /// # Errors
    /// [`NoiseError`] for an impossible confidence or noise, noise that leaves nothing certain inside or nothing finite
    /// certain outside, and contacts that contradict each other by more than the stated noise can explain.
    pub fn from_noisy_curves(curves: &[Vec<NoisyContact>], confidence: f64) -> Result<Self, NoiseError> {
        let (lists, alpha) = checked(curves, confidence)?;
        let half_planes = certain_half_planes(&lists, alpha)?;
        Ok(Self::from_parts(&points(&lists, alpha)?, &half_planes)?)
    }
}
