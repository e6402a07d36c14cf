//! What is certainly inside: hulls of noisy points, eroded.

use super::quantile;
use super::windows::Window;
use crate::halfspaces::Intersection;
use crate::hull::Hull;
use crate::sample::HalfSpace;
use contact_kinematics::Direction;
use glam::DVec3;

/// Corners of convex regions that lie in the body if no point is off by more than its margin, which fails with
/// probability `alpha` at most.
///
/// A body that holds points within `e_k(u)` of `x_k`, seen along `u`, has `h(u) >= max_k (x_k . u - e_k(u))`. The hull of
/// the `x_k` with each facet moved in by the largest `e_k` of its corners stays below that in every direction: there,
/// `u` is a positive combination of facet normals around one corner, with weights that sum to at least 1, and `e_k` is a
/// norm, hence convex. Each length of window gives one such region; the body, being convex, holds the hull of all.
pub(super) fn certain_points(lists: &[Vec<Window>], alpha: f64) -> Vec<DVec3> {
    let count: usize = lists.iter().map(Vec::len).sum();
    let quantile = quantile::length3(alpha / (2 * count.max(1)) as f64);
    lists.iter().flat_map(|list| eroded(list, quantile)).collect()
}

fn eroded(list: &[Window], quantile: f64) -> Vec<DVec3> {
    let points: Vec<DVec3> = list.iter().map(|w| w.point).collect();
    let Ok(Hull::Solid(hull)) = Hull::of(&points) else { return Vec::new() };
    let mut half_spaces = Vec::with_capacity(hull.triangles().len());
    for (facet, corners) in hull.triangles().iter().enumerate() {
        let [a, b, c] = hull.corners(facet);
        let Ok(normal) = Direction::new((b - a).cross(c - a)) else { continue };
        let margin = corners
            .iter()
            .map(|v| {
                let w = &list[hull.sources()[*v as usize] as usize];
                let u = normal.get();
                let independent = u.dot(w.covariance * u).max(0.0).sqrt();
                quantile * (independent + w.pose_translation + w.pose_rotation * w.point.length())
            })
            .fold(0.0, f64::max);
        half_spaces.push(HalfSpace { point: a, normal, margin: -margin });
    }
    match Intersection::of(&half_spaces) {
        Ok(Intersection::Bounded(polyhedron)) => polyhedron.vertices().to_vec(),
        // Nothing is left at this length.
        _ => Vec::new(),
    }
}
