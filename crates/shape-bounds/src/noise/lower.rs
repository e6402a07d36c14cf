//! What is certainly inside: hulls of noisy points, eroded.

use super::quantile;
use super::windows::Window;
use crate::erosion::eroded_hull;
use glam::DVec3;

/// Corners of convex regions that lie in the body if no point is off by more than its margin, which fails with
/// probability `alpha` at most.
///
/// Each length of window gives one region by [`eroded_hull`]; the body, being convex, holds the hull of all.
pub(super) fn certain_points(lists: &[Vec<Window>], alpha: f64) -> Vec<DVec3> {
    let count: usize = lists.iter().map(Vec::len).sum();
    let quantile = quantile::length3(alpha / (2 * count.max(1)) as f64);
    lists.iter().flat_map(|list| eroded(list, quantile)).collect()
}

fn eroded(list: &[Window], quantile: f64) -> Vec<DVec3> {
    let points: Vec<DVec3> = list.iter().map(|w| w.point).collect();
    eroded_hull(&points, |corner, u| {
        let w = &list[corner];
        let independent = u.dot(w.covariance * u).max(0.0).sqrt();
        quantile * (independent + w.pose_translation + w.pose_rotation * w.point.length())
    })
}
