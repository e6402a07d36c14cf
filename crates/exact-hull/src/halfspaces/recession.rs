//! In which directions an intersection of half-spaces has no end.

use crate::HalfSpace;
use crate::hull::{Hull, PointsError, SolidHull};
use crate::predicates::{above, drop_axis, projection_axis, turn};
use crate::twofold::cross_of_differences;
use glam::DVec3;
use std::collections::HashSet;
use unit_direction::Direction;

/// A direction is open if no normal rises along it by more than this: what normals with six printed digits are off by. Less
/// than that is no limit to speak of: it would be met at a distance of half a million times the size.
pub(crate) const OPEN: f64 = 2e-6;
/// Above this length a product of differences of unit vectors, in twofold precision, has its direction right to a millionth.
const CERTAIN: f64 = 1e-25;
/// Directions closer to each other than this are given once.
const SAME: f64 = 1e-9;

/// Directions that generate the cone of all unbounded directions `{ d : n_k . d <= 0 for all k }`, up to [`OPEN`]; empty when
/// bounded.
///
/// The cone is the polar of the cone of normals, so its generators are the outward normals of those facets of the hull of
/// the normals and the origin that contain the origin; a line in the cone is given by both its directions. Normals that were
/// meant to lie in a plane through the origin, but are rounded, have a thin hull, which may hold the origin or not: its
/// facets that come as near to the origin as that are taken for ones that contain it.
pub(super) fn unbounded_directions(half_spaces: &[HalfSpace]) -> Result<Vec<Direction>, PointsError> {
    let mut points: Vec<DVec3> = half_spaces.iter().map(|h| h.normal.get()).collect();
    let along = points[0];
    let generators = if points.iter().all(|n| n.cross(along).length() <= OPEN) {
        linear_cone(along, points.iter().any(|n| n.dot(along) < 0.0))
    } else {
        let origin = points.len();
        points.push(DVec3::ZERO);
        match Hull::of(&points)? {
            Hull::Solid(solid) => facet_normals(&solid, &points),
            Hull::Polygon(corners) => planar_cone(&points, &corners, origin),
            // Normals that are not on one line do not have such a hull.
            Hull::Segment(_) | Hull::Point(_) => Vec::new(),
        }
    };
    let mut places = HashSet::new();
    let mut is_new = |d: &Direction| places.insert((d.get() / SAME).round().to_array().map(|x| x as i64));
    Ok(generators.into_iter().filter_map(|g| Direction::new(g).ok()).filter(&mut is_new).collect())
}

/// The outward normals of the facets that come near to the origin.
fn facet_normals(hull: &SolidHull, points: &[DVec3]) -> Vec<DVec3> {
    let one = |f: usize| {
        // Facets between nearly parallel normals are slivers.
        let [a, b, c] = hull.corners(f);
        let across = cross_of_differences(a, b, c);
        let outward = across.try_normalize()?;
        let is_near = above(a, b, c, DVec3::ZERO) >= 0.0 || outward.dot(a) <= OPEN;
        let is_exact = across.length() > CERTAIN;
        (is_near && (is_exact || points.iter().all(|n| n.dot(outward) <= OPEN))).then_some(outward)
    };
    (0..hull.triangles().len()).filter_map(one).collect()
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
fn linear_cone(along: DVec3, both_sides: bool) -> Vec<DVec3> {
    let (u, v) = along.any_orthonormal_pair();
    let mut generators = vec![u, -u, v, -v];
    if !both_sides {
        generators.push(-along);
    }
    generators
}
