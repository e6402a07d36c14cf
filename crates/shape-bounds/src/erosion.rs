//! What a convex body certainly holds of which points are known roughly.

use contact_kinematics::Direction;
use exact_hull::HalfSpace;
use exact_hull::Hull;
use exact_hull::Intersection;
use glam::DVec3;

/// Corners of a region that lies in every convex body which holds a point near each of `points`: nearer to point `k`, seen
/// along `u`, than `margin(k, u)`, which is a norm of `u` for unit vectors.
///
/// Such a body has `h(u) >= max_k (x_k . u - e_k(u))`. The hull of the `x_k` with each facet moved in by the largest `e_k`
/// of its corners stays below that in every direction: there, `u` is a positive combination of facet normals around one
/// corner, with weights that sum to at least 1, and `e_k` is a norm, hence convex. Empty when nothing is left.
pub(crate) fn eroded_hull(points: &[DVec3], margin: impl Fn(usize, DVec3) -> f64) -> Vec<DVec3> {
    let Ok(Hull::Solid(hull)) = Hull::of(points) else { return Vec::new() };
    let mut half_spaces = Vec::with_capacity(hull.triangles().len());
    for (facet, corners) in hull.triangles().iter().enumerate() {
        let [a, b, c] = hull.corners(facet);
        let Ok(normal) = Direction::new((b - a).cross(c - a)) else { continue };
        let largest = corners
            .iter()
            .map(|v| margin(hull.sources()[*v as usize] as usize, normal.get()))
            .fold(0.0, f64::max);
        half_spaces.push(HalfSpace { point: a, normal, margin: -largest });
    }
    match Intersection::of(&half_spaces) {
        Ok(Intersection::Bounded(polyhedron)) => polyhedron.vertices().to_vec(),
        _ => Vec::new(),
    }
}
