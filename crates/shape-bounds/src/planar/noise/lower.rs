//! What is certainly inside: hulls of noisy points, eroded.

use super::windows::Window;
use crate::noise::quantile;
use exact_hull::planar::{Direction, HalfPlane, Hull, Intersection};
use glam::DVec2;

/// Corners of convex regions that lie in the body if no point is off by more than its margin, which fails with
/// probability `alpha` at most: the hull with each edge moved in by the larger margin of its ends along its normal. What is off at a corner along
/// any direction between the normals of its edges is no more than what is off along both. Half of `alpha` is for turns beyond first order.
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
                .map(|i| list[*i as usize].error_along(u, quantile))
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

impl Window {
    /// How far the mean point may be off along the unit vector `u`, in m: an error that is normal has along no `u` more deviation than its
    /// parts together. A turn by `d` moves a point `x` across itself, by `d (u . (z x x))` along `u`, and by `d^2 |x| / 2` beyond first order.
    fn error_along(&self, u: DVec2, quantile: f64) -> f64 {
        let independent = u.dot(self.covariance * u).max(0.0).sqrt();
        let turned = self.pose_rotation * u.perp_dot(self.point).abs() + self.pose_spread;
        let second_order = 0.5 * (quantile * self.most_rotation).powi(2) * self.arm;
        quantile * (independent + self.pose_translation + turned) + second_order
    }
}
