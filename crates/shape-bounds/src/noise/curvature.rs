//! Bounds from noisy contacts on a body whose radii of curvature are limited.

use super::model::{NoiseError, NoisyContact};
use super::pose::bound;
use super::quantile;
use super::windows::{LONGEST, Window, windows};
use crate::curvature::{CurvatureError, SharpBounds};
use contact_kinematics::CurvatureRadii;
use glam::DVec3;

/// Fewest contacts or means that bounds are made from.
const FEWEST: usize = 4;

impl SharpBounds {
    /// Bounds between which a convex body whose principal radii of curvature lie within `radii` lies with at least the stated
    /// `confidence`; `curves` as for [`ShapeBounds::from_noisy_curves`](crate::ShapeBounds::from_noisy_curves).
    ///
    /// With `p_k = x_k - rho_min n_k`, the ball of radius `rho_min` about `p_k` is in the body, and so is one smaller by the
    /// error of `p_k` about the measured one. The body is an intersection of balls of radius `rho_max`, so it holds their
    /// ball hull. The points whose ball of radius `rho_min` is in the body lie within `rho_max - rho_min` of each
    /// `q_k = x_k - rho_max n_k`, so within that and its error of the measured one. Both are true of means over neighbouring
    /// contacts as well, because balls are convex. Of means over 1, 2, 4 ... contacts those are taken that leave the
    /// smallest gap; the margins hold for all of them together.
    ///
    /// # Errors
    /// [`NoiseError`] as for contacts without limits on the curvature, [`NoiseError::Curvature`] for limits that are none
    /// or that contacts contradict, and [`NoiseError::NoLowerBound`] where the error of a ball's centre exceeds its
    /// radius.
    pub fn from_noisy_curves(
        curves: &[Vec<NoisyContact>],
        radii: CurvatureRadii,
        confidence: f64,
    ) -> Result<Self, NoiseError> {
        NoiseError::check_confidence(confidence)?;
        NoiseError::check_contacts(curves)?;
        let CurvatureRadii { min, max } = radii;
        if !(0.0 <= min && min < max && max.is_finite()) {
            return Err(CurvatureError::Radii { min, max }.into());
        }
        let lists = windows(curves, LONGEST);
        let count: usize = lists.iter().map(Vec::len).sum();
        let alpha = 0.5 * (1.0 - confidence);
        let poses = quantile::length6(alpha / curves.iter().map(Vec::len).sum::<usize>().max(1) as f64);
        let quantile = quantile::length3(alpha / (2 * count.max(1)) as f64);
        let mut best: Option<(f64, Self)> = None;
        let mut first_error = None;
        for list in lists.iter().filter(|list| list.len() >= FEWEST) {
            match of_list(list, radii, quantile, poses) {
                Ok(bounds) => {
                    let gap = bounds.upper().volume() - bounds.lower().volume();
                    if best.as_ref().is_none_or(|(smallest, _)| gap < *smallest) {
                        best = Some((gap, bounds));
                    }
                }
                Err(NoiseError::Curvature(error)) => return Err(by_contact(error, list).into()),
                Err(error) => first_error = first_error.or(Some(error)),
            }
        }
        match best {
            Some((_, bounds)) => Ok(bounds),
            None => Err(first_error.unwrap_or(NoiseError::NoLowerBound)),
        }
    }
}

/// A contradiction between means, told by their first contacts.
fn by_contact(error: CurvatureError, list: &[Window]) -> CurvatureError {
    match error {
        CurvatureError::Contradicted { sample, other, excess, min, max } => {
            let first = |k: usize| list.get(k).map_or(k, |w| w.first);
            CurvatureError::Contradicted { sample: first(sample), other: first(other), excess, min, max }
        }
        error => error,
    }
}

fn of_list(
    list: &[Window],
    radii: CurvatureRadii,
    quantile: f64,
    poses: f64,
) -> Result<SharpBounds, NoiseError> {
    let CurvatureRadii { min, max } = radii;
    let centres = |rho: f64| list.iter().map(|w| w.inside(rho)).collect::<Vec<DVec3>>();
    let error = |rho: f64| list.iter().map(|w| w.error(rho, quantile, poses)).fold(0.0, f64::max);
    let (inner, outer) = (error(min), error(max));
    if inner >= min && inner > 0.0 {
        return Err(NoiseError::NoLowerBound);
    }
    // Larger by both errors, so that all measured centres are within it of each other.
    let reach = (max - min) + inner + outer + ROUNDING * max;
    Ok(SharpBounds::around(&centres(min), &centres(max), reach, min - inner, radii)?)
}

/// Rounding of the centres, relative to the largest radius.
const ROUNDING: f64 = 1e-12;

impl Window {
    /// Mean of the centres of the balls of radius `rho` that touch the body from inside.
    fn inside(&self, rho: f64) -> DVec3 {
        self.point - self.normal.get() * (self.shrink * rho)
    }

    /// How far that may be from the true mean.
    fn error(&self, rho: f64, quantile: f64, poses: f64) -> f64 {
        let independent = (bound(self.covariance) + (rho * self.normal_sd).powi(2)).sqrt();
        let second_order = 0.5 * rho * (quantile * self.single_normal_sd).powi(2);
        // The centre lies rho further in than the point.
        let pose = bound(self.pose_of_point).sqrt() + self.turning.sqrt() * rho;
        quantile * independent + poses * pose + second_order + self.pose_second_order(poses, rho)
    }
}
