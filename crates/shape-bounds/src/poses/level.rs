//! The noise level of poses above a plane, from their own consistency.

use super::{BodyPose, Observation, PoseError, PoseRule, intersect};
use crate::median::{OF_NORMAL, median};
use exact_hull::Polyhedron;

/// Touching poses needed for a share of them to be a quantile, up to 98 %.
pub(super) const FEWEST: usize = 50;
/// Halvings of the bracket for the level: a ten-thousandth of the body's size, then a ten-thousandth of that.
const HALVINGS: usize = 16;
/// Frames at the end of a run that are taken for rest.
pub(super) const RESTING: usize = 5;
/// A frame touches when it is accelerated upwards by more than in flight downwards, and by more than so many standard
/// deviations of the tracking noise.
const NOISE_DEVIATIONS: f64 = 5.0;

/// The largest second difference of the position at the frame and its neighbours, in m.
pub(super) fn roughness(poses: &[BodyPose], frame: usize) -> f64 {
    (frame.saturating_sub(1)..=frame + 1).map(|k| second_difference(poses, k).length()).fold(0.0, f64::max)
}

fn second_difference(poses: &[BodyPose], frame: usize) -> glam::DVec3 {
    let k = frame.clamp(1, poses.len() - 2);
    poses[k - 1].p_WO - 2.0 * poses[k].p_WO + poses[k + 1].p_WO
}

/// The downward second difference in flight, in m: the strongest tenth of those of a run is flight, whatever share of
/// the run is rest.
pub(super) fn flight_scale(poses: &[BodyPose]) -> f64 {
    let mut falls: Vec<f64> =
        (1..poses.len() - 1).map(|k| -second_difference(poses, k).z).filter(|a| *a > 0.0).collect();
    falls.sort_unstable_by(f64::total_cmp);
    falls.get(falls.len() * 9 / 10).copied().unwrap_or(0.0)
}

/// Standard deviation of the second differences from tracking noise alone, in m: what is seen sideways, where in flight and
/// at rest nothing pushes, with impacts left to the median.
pub(super) fn noise_scale(runs: &[Vec<BodyPose>]) -> f64 {
    let sideways = |poses: &'_ Vec<BodyPose>, k: usize| {
        let d = second_difference(poses, k);
        [d.x.abs(), d.y.abs()]
    };
    let mut sizes: Vec<f64> =
        runs.iter().flat_map(|poses| (1..poses.len() - 1).flat_map(move |k| sideways(poses, k))).collect();
    median(&mut sizes) / OF_NORMAL
}

/// Whether the body touches the plane: at rest at the end of its run, or pushed upwards by more than flight (`flight`) or
/// noise of standard deviation `noise` would let it seem.
pub(super) fn touches(poses: &[BodyPose], frame: usize, flight: f64, noise: f64) -> bool {
    let pushed = flight.max(NOISE_DEVIATIONS * noise);
    frame + RESTING >= poses.len() || (frame > 0 && second_difference(poses, frame).z > pushed)
}

/// The smallest level at which the trusted share of the touching poses are consistent with all poses: the bound,
/// inflated by it, reaches as far as the touching half-space deflated by it.
pub(super) fn consistent_level(observations: &[Observation], rule: &PoseRule) -> Result<f64, PoseError> {
    let size = observations.iter().map(|o| o.half_space.point.length()).fold(0.0, f64::max);
    let consistent = |level: f64| -> Result<bool, PoseError> {
        let bound = intersect(observations, level)?;
        let touching = observations.iter().filter(|o| o.touching).count();
        let wrong = inconsistent(observations, &bound, level).len();
        Ok(wrong as f64 <= (1.0 - rule.trusted) * touching as f64)
    };
    // At a level of the body's size everything is consistent. Half-spaces that contradict each other, so that nothing is
    // left, are inconsistent too.
    let (mut low, mut high) = (0.0, size);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match consistent(middle) {
            Ok(true) => high = middle,
            Ok(false) | Err(PoseError::HalfSpaces(_)) => low = middle,
            Err(error) => return Err(error),
        }
    }
    Ok(high)
}

/// Touching poses that the bound, with this level in its margins, cuts off by more than level and gap.
pub(super) fn inconsistent(
    observations: &[Observation],
    bound: &Polyhedron,
    level: f64,
) -> Vec<(usize, usize)> {
    let mut caps = bound.caps();
    observations
        .iter()
        .filter(|o| o.touching && -caps.height(&o.half_space) > level + o.gap)
        .map(|o| o.at)
        .collect()
}
