//! In which directions an intersection of half-spaces has no end.

use crate::hull::Hull;
use crate::predicates::{above, drop_axis, projection_axis, turn};
use crate::sample::HalfSpace;
use contact_kinematics::Direction;
use glam::DVec3;

/// Directions that generate the cone of all unbounded directions `{ d : n_k . d <= 0 for all k }`; empty when bounded.
///
/// The cone is the polar of the cone of normals, so its generators are the outward normals of those facets of the hull of
/// the normals and the origin that contain the origin; a line in the cone is given by both its directions.
pub(super) fn unbounded_directions(half_spaces: &[HalfSpace]) -> Vec<Direction> {
    let mut points: Vec<DVec3> = half_spaces.iter().map(|h| h.normal.get()).collect();
    let origin = points.len();
    points.push(DVec3::ZERO);
    let mut generators = match Hull::of(&points) {
        Ok(Hull::Solid(solid)) => (0..solid.triangles().len())
            .map(|f| solid.corners(f))
            .filter(|[a, b, c]| above(*a, *b, *c, DVec3::ZERO) >= 0.0)
            .map(|[a, b, c]| (b - a).cross(c - a))
            .collect(),
        Ok(Hull::Polygon(corners)) => planar_cone(&points, &corners, origin),
        Ok(Hull::Segment(ends)) => linear_cone(&points, ends),
        // Unit normals and the origin are not one point, and have no extreme coordinates.
        Ok(Hull::Point(_)) | Err(_) => Vec::new(),
    };
    let mut directions: Vec<Direction> = Vec::new();
    for generator in generators.drain(..) {
        if let Ok(d) = Direction::new(generator)
            && directions.iter().all(|e| e.get().distance(d.get()) > 1e-12)
        {
            directions.push(d);
        }
    }
    directions
}

/// Normals in one plane: both sides of the plane are unbounded, and what the normals leave open in the plane.
fn planar_cone(points: &[DVec3], corners: &[usize], origin: usize) -> Vec<DVec3> {
    let at = |k: usize| points[corners[k % corners.len()]];
    let normal = (at(1) - at(0)).cross(at(2) - at(0));
    let mut generators = vec![normal, -normal];
    let Some((axis, sense)) = projection_axis(at(0), at(1), at(2)) else { return generators };
    for k in 0..corners.len() {
        let [a, b, o] = [at(k), at(k + 1), points[origin]].map(|p| drop_axis(p, axis));
        if turn(a, b, o) * sense <= 0.0 {
            generators.push((at(k + 1) - at(k)).cross(normal));
        }
    }
    generators
}

/// Normals on one line: the plane across it, and the free side if there is one.
fn linear_cone(points: &[DVec3], ends: [usize; 2]) -> Vec<DVec3> {
    let [a, b] = ends.map(|i| points[i]);
    let along = b - a;
    let (u, v) = along.normalize().any_orthonormal_pair();
    let mut generators = vec![u, -u, v, -v];
    if a == DVec3::ZERO {
        generators.push(-along);
    } else if b == DVec3::ZERO {
        generators.push(along);
    }
    generators
}
