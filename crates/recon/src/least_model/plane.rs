//! The cheapest estimate of a motion in the plane whose stated bound is below the wanted accuracy.

use super::{Accuracy, Choice, LeastEstimate, least_estimate, one_of};
use object_dynamics::planar::{ContactLog, ContactLogError};
use observer::planar::{PlaneEstimate, PlaneEstimateError, PlaneOptions};

/// A motion in the plane and the model that it was estimated by.
#[derive(Clone, Debug)]
pub struct LeastPlaneEstimate {
    /// The estimate, at the samples that it was made from.
    pub estimate: PlaneEstimate,
    /// One of so many samples of the log.
    pub every: usize,
    /// Whether mass and moment of inertia are as stated.
    pub is_of_known_body: bool,
    /// Why.
    pub choice: Choice,
}

/// As [`least_estimate`] of a log in the plane: that it is one is stated, all else is chosen as in space.
///
/// # Errors
/// Those of the log in space, and of the estimator where no model leads to an estimate.
pub fn least_plane_estimate(
    log: &ContactLog,
    options: &PlaneOptions,
    wanted: Accuracy,
) -> Result<LeastPlaneEstimate, PlaneEstimateError> {
    let in_space = log.in_space(&options.friction)?.split_truth().0;
    let LeastEstimate { estimate, every, options, choice } =
        least_estimate(&in_space, &options.in_space()?, wanted)?;
    let estimate = PlaneEstimate::of_space(estimate, &one_of(&in_space, every)?);
    Ok(LeastPlaneEstimate { estimate, every, is_of_known_body: options.body.is_some(), choice })
}

/// The log with its first sample and every `every`-th one after it.
///
/// # Errors
/// Those of a log that is left with less than two samples.
pub fn one_of_plane(log: &ContactLog, every: usize) -> Result<ContactLog, ContactLogError> {
    log.picked(&(0..log.samples().len()).step_by(every.max(1)).collect::<Vec<_>>())
}
