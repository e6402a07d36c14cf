//! The first simplex, which also decides the dimension of the point set.

use crate::predicates::{above, projection_axis};
use glam::DVec3;

/// The largest simplex that a few greedy scans find, by indices into the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Seed {
    /// All points coincide.
    Point(usize),
    /// All points lie on one line.
    Line,
    /// All points lie in one plane; the axis along which it projects without collapsing.
    Plane { axis: usize },
    /// Four points that span space, the fourth on the inner side of the first three.
    Space([usize; 4]),
}

/// Exact dimension of `points` (not empty), with a simplex of that dimension.
pub(super) fn find_seed(points: &[DVec3]) -> Seed {
    // Far corners make the centre of the simplex a good centre for all that follows.
    let a = farthest(points, |p| -p.x);
    let b = farthest(points, |p| p.distance_squared(points[a]));
    if points[a] == points[b] {
        // The squared distance underflows for tiny sets; equality does not.
        return match points.iter().position(|p| *p != points[a]) {
            None => Seed::Point(a),
            Some(b) => find_from_edge(points, a, b),
        };
    }
    find_from_edge(points, a, b)
}

fn find_from_edge(points: &[DVec3], a: usize, b: usize) -> Seed {
    let along = points[b] - points[a];
    let c = farthest(points, |p| (p - points[a]).cross(along).length_squared());
    let off_line = |c: &usize| projection_axis(points[a], points[b], points[*c]);
    let found = off_line(&c)
        .map(|axis| (c, axis))
        .or_else(|| (0..points.len()).find_map(|c| off_line(&c).map(|axis| (c, axis))));
    let Some((c, (axis, _))) = found else { return Seed::Line };

    let normal = along.cross(points[c] - points[a]);
    let d = farthest(points, |p| (p - points[a]).dot(normal).abs());
    let off_plane = |d: &usize| above(points[a], points[b], points[c], points[*d]);
    let found = if off_plane(&d) != 0.0 { Some(d) } else { (0..points.len()).find(|d| off_plane(d) != 0.0) };
    match found {
        None => Seed::Plane { axis },
        Some(d) if off_plane(&d) < 0.0 => Seed::Space([a, b, c, d]),
        Some(d) => Seed::Space([a, c, b, d]),
    }
}

fn farthest(points: &[DVec3], measure: impl Fn(DVec3) -> f64) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (i, p) in points.iter().enumerate() {
        let m = measure(*p);
        if m > best.1 {
            best = (i, m);
        }
    }
    best.0
}

/// A point strictly inside the tetrahedron, proven by exact signs; `None` where the tetrahedron is so thin that the
/// rounded candidates fall outside of it.
pub(super) fn strict_centre(corners: [DVec3; 4]) -> Option<DVec3> {
    let [a, b, c, d] = corners;
    // The difference form keeps the low bits of a thin tetrahedron far from the origin.
    let candidates = [
        a + ((b - a) + (c - a) + (d - a)) / 4.0,
        d + ((a - d) + (b - d) + (c - d)) / 4.0,
        (a + b) * 0.25 + (c + d) * 0.25,
        a + ((b - a) + (c - a) + (d - a) * 2.0) / 5.0,
    ];
    candidates.into_iter().find(|o| {
        [[a, b, c], [a, d, b], [b, d, c], [c, d, a]].iter().all(|f| above(f[0], f[1], f[2], *o) < 0.0)
    })
}
