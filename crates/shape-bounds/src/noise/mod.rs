//! Bounds that hold at a stated confidence when contacts are measured with noise.

pub(crate) mod consistency;
mod curvature;
mod lower;
mod model;
pub(crate) mod outliers;
pub(crate) mod quantile;
mod roughness;
#[cfg(test)]
mod tests;
mod upper;
mod windows;

pub use consistency::estimate_noise;
pub use model::{ContactNoise, NoiseError, NoisyContact};
pub use outliers::{Outlier, without_outliers};

use crate::bounds::ShapeBounds;
use lower::certain_points;
use upper::certain_half_spaces;
use windows::windows;

impl ShapeBounds {
    /// Bounds between which a convex body lies with at least the stated `confidence` (say 0.95), for both bounds and all
    /// contacts together.
    ///
    /// `curves` are the measured contacts, each curve in the order in which it was traced: means over neighbours carry
    /// less noise and are used wherever they prove more. A single list of unordered contacts is sound too, only wider.
    /// Half-spaces are moved outwards and the hull is eroded by margins from the union bound over all contacts and
    /// means, so no assumption on how errors of the pose are correlated is needed.
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
        let half_spaces = certain_half_spaces(&lists, alpha)?;
        let points = certain_points(&lists, alpha);
        if points.is_empty() {
            return Err(NoiseError::NoLowerBound);
        }
        Ok(Self::from_parts(&points, &half_spaces)?)
    }
}
