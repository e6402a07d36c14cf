//! What is certainly inside: hulls of noisy points, eroded.

use super::quantile;
use super::windows::Window;
use crate::erosion::eroded_hull;
use glam::{DMat3, DVec3};

/// Corners of convex regions that lie in the body if no point is off by more than its margin, which fails with
/// probability `alpha` at most.
///
/// Each length of window gives one region by [`eroded_hull`]; the body, being convex, holds the hull of all.
///
/// `poses` is the number of deviations that the poses are off by at most.
pub(super) fn certain_points(lists: &[Vec<Window>], alpha: f64, poses: f64) -> Vec<DVec3> {
    let count: usize = lists.iter().map(Vec::len).sum();
    let quantile = quantile::length3(alpha / count.max(1) as f64);
    lists.iter().flat_map(|list| eroded(list, quantile, poses)).collect()
}

fn eroded(list: &[Window], quantile: f64, poses: f64) -> Vec<DVec3> {
    let points: Vec<DVec3> = list.iter().map(|w| w.point).collect();
    eroded_hull(&points, |corner, u| {
        let w = &list[corner];
        let deviation = |m: DMat3| u.dot(m * u).max(0.0).sqrt();
        quantile * deviation(w.covariance)
            + poses * deviation(w.pose_of_point)
            + w.pose_second_order(poses, 0.0)
    })
}
