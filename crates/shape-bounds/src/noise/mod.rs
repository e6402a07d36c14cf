//! Bounds that hold at a stated confidence when contacts are measured with noise.
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::ContactSample;
//! use shape_bounds::noise::{CertainBounds, ContactNoise, NoisyContact};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A unit ball, touched at the corners, edges and faces of a cube, with contacts off by 1 mm and normals by 1 mrad.
//! let around = (0..27).filter(|k| *k != 13).map(|k| DVec3::new((k % 3) as f64, (k / 3 % 3) as f64, (k / 9) as f64) - DVec3::ONE);
//! let contacts = ContactSample::from_raw(around.map(DVec3::normalize).map(|n| (n, n)))?;
//! let noise = ContactNoise::isotropic(1e-3, 1e-3);
//! let noisy: Vec<_> = contacts.into_iter().map(|contact| NoisyContact { contact, noise }).collect();
//! let bounds = CertainBounds::from_noisy_curves(&[noisy], 0.95)?.both().ok_or("nothing is certain")?;
//! let ball = 4.0 / 3.0 * std::f64::consts::PI;
//! assert!(bounds.lower_volume() < ball && ball < bounds.upper_volume());
//! # Ok(())
//! # }
//! ```

pub(crate) mod assumptions;
mod chosen;
pub(crate) mod consistency;
mod curvature;
mod levels;
mod lower;
mod model;
pub(crate) mod outliers;
mod polynomial;
mod pose;
pub mod quantile;
mod roughness;
#[cfg(test)]
mod stated_tests;
#[cfg(test)]
mod tests;
mod traced;
mod upper;
mod windows;

pub use assumptions::{NoiseDoubt, correlated_noise, independence_is_tested, with_noise_as_found};
pub use consistency::estimate_noise;
pub use model::{ContactNoise, NoiseError, NoisyContact};
pub use outliers::{Outlier, without_outliers};
pub use pose::PoseNoise;
pub(crate) use traced::FEWEST;

use crate::bounds::{BoundsError, Gap, ShapeBounds};
use crate::features::FeatureOptions;
use chosen::ChosenWindows;
use contact_kinematics::at_once;
use exact_hull::Hull;
use exact_hull::{Intersection, Polyhedron};
use lower::{certain_points, nearly_exact, points_of_corners};
use upper::certain_half_spaces;
use windows::{LONGEST, windows};

/// Share of the odds of a failure that means over all contacts of a corner or face have: they are few, and the others hardly lose.
const SHARE_OF_CHOSEN: f64 = 0.1;

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
        let certain = CertainBounds::from_noisy_curves(curves, confidence)?;
        match (&certain.lower, &certain.upper) {
            (_, None) => Err(NoiseError::NoUpperBound),
            (None, _) => Err(NoiseError::NoLowerBound),
            _ => certain.both().ok_or(NoiseError::NoLowerBound),
        }
    }
}

/// Half of the odds of a failure for the poses of all contacts, each off by so many deviations at most, and the confidence that leaves for the rest.
fn with_poses(curves: &[Vec<NoisyContact>], confidence: f64) -> Result<(f64, f64), NoiseError> {
    NoiseError::check_confidence(confidence)?;
    let alpha = 0.5 * (1.0 - confidence);
    let poses = quantile::length6(alpha / curves.iter().map(Vec::len).sum::<usize>().max(1) as f64);
    Ok((1.0 - alpha, poses))
}

/// What is certain of a convex body: bounds of which each may be missing.
#[derive(Clone, Debug, PartialEq)]
pub struct CertainBounds {
    /// In the body; none where nothing is certain to be.
    pub lower: Option<Hull>,
    /// Around the body; none where nothing finite is certain to be.
    pub upper: Option<Polyhedron>,
}

impl CertainBounds {
    /// As [`ShapeBounds::from_noisy_curves`], with each bound that there is.
    ///
    /// # Errors
    /// [`NoiseError`] for an impossible confidence or noise, and for contacts that contradict each other by more than the
    /// stated noise can explain.
    pub fn from_noisy_curves(curves: &[Vec<NoisyContact>], confidence: f64) -> Result<Self, NoiseError> {
        let (confidence, poses) = with_poses(curves, confidence)?;
        Self::from_curves_of_poses(curves, confidence, poses)
    }

    /// The same for noise that may be alike from one contact to the next, in any way: nothing is gained by means then.
    ///
    /// # Errors
    /// As [`Self::from_noisy_curves`].
    pub fn from_correlated_curves(curves: &[Vec<NoisyContact>], confidence: f64) -> Result<Self, NoiseError> {
        let single: Vec<Vec<NoisyContact>> = curves.iter().flatten().map(|c| vec![*c]).collect();
        Self::from_noisy_curves(&single, confidence)
    }

    /// The same where the errors of all poses together are within `poses` of their standard deviations: bounds that hold with at
    /// least the stated `confidence` whenever that is so. The union bound is then only over the contacts' own noise.
    ///
    /// # Errors
    /// As [`Self::from_noisy_curves`].
    pub fn from_curves_of_poses(
        curves: &[Vec<NoisyContact>],
        confidence: f64,
        poses: f64,
    ) -> Result<Self, NoiseError> {
        Self::from_means(curves, None, confidence, poses)
    }

    /// As [`Self::from_noisy_curves`], with means over all contacts of a corner or face, which carry still less noise. Every other
    /// contact says which those are, and the mean is over the others: the bounds hold whatever is found.
    ///
    /// # Errors
    /// As [`Self::from_noisy_curves`], and for odds that are none.
    pub fn from_features(
        curves: &[Vec<NoisyContact>],
        options: &FeatureOptions,
        confidence: f64,
    ) -> Result<Self, NoiseError> {
        let (confidence, poses) = with_poses(curves, confidence)?;
        Self::from_features_of_poses(curves, options, confidence, poses)
    }

    /// [`Self::from_curves_of_poses`] with means over all contacts of a corner or face, as in [`Self::from_features`].
    ///
    /// # Errors
    /// As [`Self::from_features`].
    pub fn from_features_of_poses(
        curves: &[Vec<NoisyContact>],
        options: &FeatureOptions,
        confidence: f64,
        poses: f64,
    ) -> Result<Self, NoiseError> {
        Self::from_means(curves, Some(options), confidence, poses)
    }

    fn from_means(
        curves: &[Vec<NoisyContact>],
        options: Option<&FeatureOptions>,
        confidence: f64,
        poses: f64,
    ) -> Result<Self, NoiseError> {
        NoiseError::check_confidence(confidence)?;
        NoiseError::check_contacts(curves)?;
        let chosen = options.map(|options| ChosenWindows::of(curves, options)).transpose()?;
        let contacts: Vec<_> = curves.iter().flatten().map(|c| c.contact).collect();
        ShapeBounds::check(&contacts)?;
        let all = (1.0 - confidence) / 2.0;
        // The same whether any are found: the odds must not depend on it.
        let of_chosen = if chosen.is_some() { SHARE_OF_CHOSEN * all } else { 0.0 };
        let alpha = all - of_chosen;
        let ChosenWindows { corners, faces } = &chosen.unwrap_or_default();
        let singles = windows(curves, 1);
        let exact = singles.first().is_some_and(|list| nearly_exact(list, alpha, poses));
        let lists = if exact { singles } else { windows(curves, LONGEST) };
        let upper = || match certain_half_spaces(&lists, faces, [alpha, of_chosen], poses) {
            Ok(half_spaces) => match Intersection::of(&half_spaces).map_err(BoundsError::from)? {
                Intersection::Bounded(upper) => Ok(Some(upper)),
                Intersection::Unbounded(_) => Ok(None),
            },
            Err(NoiseError::NoUpperBound) => Ok(None),
            Err(error) => Err(error),
        };
        let lower = || {
            let mut points = certain_points(&lists, alpha, poses);
            points.extend(points_of_corners(corners, of_chosen, poses));
            let hull = if points.is_empty() { None } else { Some(Hull::of(&points)) };
            hull.transpose().map_err(BoundsError::from)
        };
        let (lower, upper) = at_once(lower, upper);
        let (upper, lower) = (upper?, lower?);
        Ok(Self { lower, upper })
    }

    /// The largest gap between both, as [`ShapeBounds::largest_gap`]; none where one is missing.
    #[must_use]
    pub fn largest_gap(&self) -> Option<Gap> {
        self.both()?.largest_gap()
    }

    /// Both bounds, where there are both and the lower one has a volume.
    #[must_use]
    pub fn both(&self) -> Option<ShapeBounds> {
        ShapeBounds::between(self.lower.clone()?, Intersection::Bounded(self.upper.clone()?))
    }
}
