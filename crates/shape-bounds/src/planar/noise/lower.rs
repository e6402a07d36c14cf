//! What is certainly inside: hulls of noisy points, eroded.

use super::windows::Window;
use crate::noise::quantile;
use crate::planar::{Direction, HalfPlane, Hull, Intersection};
use glam::DVec2;

/// Corners of convex regions that lie in the body if no point is off by more than its margin, which fails with
/// probability `alpha` at most: the hull with each edge moved in by the larger margin of its ends.
pub(super) fn certain_points(lists: &[Vec<Window>], alpha: f64) -> Vec<DVec2> {
    let count: usize = lists.iter().map(Vec::len).sum();
    let quantile = quantile::length2(alpha / (2 * count.max(1)) as f64);
    lists.iter().flat_map(|list| eroded(list, quantile)).collect()
}

fn eroded(list: &[Window], quantile: f64) -> Vec<DVec2> {
    let points: Vec<DVec2> = list.iter().map(|w| w.point).collect();
    let Ok(Hull::Polygon(hull)) = Hull::of(&points) else { return Vec::new() };
    let sources = hull.sources();
    let edges = hull.shape().edges().enumerate();
    let half_planes: Vec<HalfPlane> = edges
        .filter_map(|(k, (a, b))| {
            let normal = Direction::new(-(b - a).perp()).ok()?;
            let u = normal.get();
            let margin = [sources[k], sources[(k + 1) % sources.len()]]
                .iter()
                .map(|i| {
                    let w = &list[*i as usize];
                    let independent = u.dot(w.covariance * u).max(0.0).sqrt();
                    quantile * (independent + w.pose_translation + w.pose_rotation * w.point.length())
                })
                .fold(0.0, f64::max);
            Some(HalfPlane { point: a, normal, margin: -margin })
        })
        .collect();
    match Intersection::of(&half_planes) {
        Ok(Intersection::Bounded(region)) => region.shape().vertices().to_vec(),
        // Nothing is left at this length.
        _ => Vec::new(),
    }
}
