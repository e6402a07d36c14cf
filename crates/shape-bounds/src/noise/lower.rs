//! What is certainly inside: hulls of noisy points, eroded.

use super::pose::bound;
use super::quantile;
use super::windows::Window;
use crate::erosion::eroded_hull;
use contact_kinematics::Direction;
use exact_hull::Hull;
use glam::{DMat3, DVec3};

/// Corners of convex regions that lie in the body if no point is off by more than its margin, which fails with
/// probability `alpha` at most.
///
/// Each length of window gives one region by [`eroded_hull`]; the body, being convex, holds the hull of all.
///
/// A single list is one of contacts without noise to speak of; `poses` is the number of deviations that the poses are off by at most.
pub(super) fn certain_points(lists: &[Vec<Window>], alpha: f64, poses: f64) -> Vec<DVec3> {
    let count: usize = lists.iter().map(Vec::len).sum();
    let quantile = quantile::length3(alpha / count.max(1) as f64);
    if let [only] = lists
        && let Some(points) = shrunk(only, quantile, poses)
    {
        return points;
    }
    lists.iter().flat_map(|list| eroded(list, quantile, poses)).collect()
}

/// Whether no point of `list` is off by more than next to nothing beside the size of all: means gain nothing then.
pub(super) fn nearly_exact(list: &[Window], alpha: f64, poses: f64) -> bool {
    let quantile = quantile::length3(alpha / list.len().max(1) as f64);
    let centre = list.iter().map(|w| w.point).sum::<DVec3>() / list.len().max(1) as f64;
    let size = list.iter().map(|w| w.point.distance(centre)).fold(0.0, f64::max);
    list.iter().all(|w| w.largest_error(quantile, poses) <= NEARLY_EXACT * size)
}

/// Errors of points below this share of the size are next to nothing: some three times as much of the volume.
const NEARLY_EXACT: f64 = 1e-5;

/// The hull of the points, made smaller about their mean: with a ball of radius `r` about it in the hull, and no point off by more
/// than `e`, the hull times `1 - e / r` lies in the hull of the true points. It keeps the corners of the hull, where moving the
/// planes of dense contacts by next to nothing makes corners of planes that are next to parallel.
fn shrunk(list: &[Window], quantile: f64, poses: f64) -> Option<Vec<DVec3>> {
    let points: Vec<DVec3> = list.iter().map(|w| w.point).collect();
    let Ok(Hull::Solid(hull)) = Hull::of(&points) else { return None };
    let centre = points.iter().sum::<DVec3>() / points.len() as f64;
    let height = |f: usize| {
        let [a, b, c] = hull.corners(f);
        Direction::new((b - a).cross(c - a)).map_or(f64::INFINITY, |n| n.get().dot(a - centre))
    };
    let radius = (0..hull.triangles().len()).map(height).fold(f64::INFINITY, f64::min);
    let error = list.iter().map(|w| w.largest_error(quantile, poses)).fold(0.0, f64::max);
    let scale = 1.0 - error / radius;
    let kept = hull.vertices().iter().map(|v| centre + (*v - centre) * scale);
    (radius > 0.0 && scale > 0.0).then(|| kept.collect())
}

fn eroded(list: &[Window], quantile: f64, poses: f64) -> Vec<DVec3> {
    let points: Vec<DVec3> = list.iter().map(|w| w.point).collect();
    eroded_hull(&points, |corner, u| list[corner].error_along(u, quantile, poses))
}

/// The same of means over corners.
pub(super) fn points_of_corners(corners: &[Window], alpha: f64, poses: f64) -> Vec<DVec3> {
    eroded(corners, quantile::length3(alpha / corners.len().max(1) as f64), poses)
}

impl Window {
    /// How far the mean point may be off along `u`.
    fn error_along(&self, u: DVec3, quantile: f64, poses: f64) -> f64 {
        let deviation = |m: DMat3| u.dot(m * u).max(0.0).sqrt();
        quantile * deviation(self.covariance)
            + poses * deviation(self.pose_of_point)
            + self.pose_second_order(poses, 0.0)
    }

    /// How far the mean point may be off in any direction.
    fn largest_error(&self, quantile: f64, poses: f64) -> f64 {
        quantile * bound(self.covariance).sqrt()
            + poses * bound(self.pose_of_point).sqrt()
            + self.pose_second_order(poses, 0.0)
    }
}
