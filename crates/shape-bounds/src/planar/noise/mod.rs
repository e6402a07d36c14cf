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

use super::ShapeBounds;
use lower::certain_points;
use upper::certain_half_planes;
use windows::windows;

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
        NoiseError::check_confidence(confidence)?;
        NoiseError::check_contacts(curves)?;
        let contacts: Vec<_> = curves.iter().flatten().map(|c| c.contact).collect();
        Self::check(&contacts)?;
        let lists = windows(curves);
        let alpha = (1.0 - confidence) / 2.0;
        let half_planes = certain_half_planes(&lists, alpha)?;
        let points = certain_points(&lists, alpha);
        if points.is_empty() {
            return Err(NoiseError::NoLowerBound);
        }
        Ok(Self::from_parts(&points, &half_planes)?)
    }
}
