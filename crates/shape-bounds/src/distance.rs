//! Distance from a point to a convex body that is known by its support points.
//!
//! Gilbert, Johnson and Keerthi (1988), written with the stopping rule that a bound needs: the direction that is
//! returned certifies a distance by itself, whatever the iteration did.

use glam::DVec3;

/// The part of the squared distance by which the certified distance may fall short before the iteration stops.
const RELATIVE: f64 = 1e-14;
/// Iterations at most; some ten suffice for a polytope.
const ITERATIONS: usize = 200;

/// The nearest point of a body, as far as found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    /// A point of the body.
    pub(crate) point: DVec3,
    /// Unit vector from the body to the query; zero if the query is in the body.
    pub(crate) direction: DVec3,
    /// The body has no point nearer than this in m: the query's height over the supporting plane across `direction`.
    pub(crate) certified: f64,
}

/// Nearest point to `query` of the body whose farthest point along `d` is `support(d)`; `start` is any of its points.
pub(crate) fn nearest(query: DVec3, start: DVec3, mut support: impl FnMut(DVec3) -> DVec3) -> Nearest {
    let mut simplex = vec![start - query];
    let mut closest = simplex[0];
    let mut best = Nearest { point: start, direction: DVec3::ZERO, certified: 0.0 };
    for _ in 0..ITERATIONS {
        let distance = closest.length();
        if distance == 0.0 {
            break;
        }
        let direction = -closest / distance;
        let candidate = support(direction) - query;
        let certified = -direction.dot(candidate);
        if certified > best.certified {
            best = Nearest { point: closest + query, direction, certified };
        }
        if distance - certified <= RELATIVE * distance || simplex.contains(&candidate) {
            break;
        }
        simplex.push(candidate);
        let Some(next) = reduce(&mut simplex) else {
            return Nearest { point: query, direction: DVec3::ZERO, certified: 0.0 };
        };
        if next.length_squared() >= closest.length_squared() {
            break;
        }
        closest = next;
    }
    Nearest { point: closest + query, ..best }
}

/// The point of the simplex nearest to the origin, with the simplex cut down to the corners that carry it; `None` if
/// the origin is inside.
fn reduce(simplex: &mut Vec<DVec3>) -> Option<DVec3> {
    let (point, kept) = match simplex[..] {
        [a, b] => on_segment(a, b),
        [a, b, c] => on_triangle(a, b, c),
        [a, b, c, d] => {
            if holds_origin([a, b, c, d]) {
                return None;
            }
            [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
                .into_iter()
                .map(|face| {
                    let (point, kept) = on_triangle(simplex[face[0]], simplex[face[1]], simplex[face[2]]);
                    (point, kept.into_iter().map(|k| face[k]).collect())
                })
                .min_by(|x: &(DVec3, Vec<usize>), y| x.0.length_squared().total_cmp(&y.0.length_squared()))?
        }
        _ => (simplex[0], vec![0]),
    };
    *simplex = kept.into_iter().map(|k| simplex[k]).collect();
    Some(point)
}

fn holds_origin([a, b, c, d]: [DVec3; 4]) -> bool {
    let side = |p: DVec3, q: DVec3, r: DVec3, s: DVec3| {
        let normal = (q - p).cross(r - p);
        normal.dot(-p) * normal.dot(s - p) > 0.0
    };
    side(a, b, c, d) && side(a, b, d, c) && side(a, c, d, b) && side(b, c, d, a)
}

fn on_segment(a: DVec3, b: DVec3) -> (DVec3, Vec<usize>) {
    let along = b - a;
    let t = -a.dot(along);
    let length = along.length_squared();
    if t <= 0.0 || length == 0.0 {
        (a, vec![0])
    } else if t >= length {
        (b, vec![1])
    } else {
        (a + along * (t / length), vec![0, 1])
    }
}

fn on_triangle(a: DVec3, b: DVec3, c: DVec3) -> (DVec3, Vec<usize>) {
    let normal = (b - a).cross(c - a);
    let inside = |p: DVec3, q: DVec3| (q - p).cross(-p).dot(normal) > 0.0;
    if normal != DVec3::ZERO && inside(a, b) && inside(b, c) && inside(c, a) {
        return (normal * (a.dot(normal) / normal.length_squared()), vec![0, 1, 2]);
    }
    [([a, b], [0, 1]), ([b, c], [1, 2]), ([c, a], [2, 0])]
        .into_iter()
        .map(|([p, q], names)| {
            let (point, kept) = on_segment(p, q);
            (point, kept.into_iter().map(|k| names[k]).collect::<Vec<_>>())
        })
        .min_by(|x, y| x.0.length_squared().total_cmp(&y.0.length_squared()))
        .unwrap_or((a, vec![0]))
}

/// Distance of `query` from a triangle, which may be flat.
pub(crate) fn distance_to_triangle(query: DVec3, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| p - query);
    on_triangle(a, b, c).0.length()
}

/// The first of `points` that is farthest along `d`.
pub(crate) fn farthest_of(points: &[DVec3], d: DVec3) -> DVec3 {
    let mut best = (DVec3::ZERO, f64::NEG_INFINITY);
    for p in points {
        let height = p.dot(d);
        if height > best.1 {
            best = (*p, height);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::{InputKind, Source};

    fn support(points: &[DVec3], d: DVec3) -> DVec3 {
        points.iter().copied().max_by(|p, q| p.dot(d).total_cmp(&q.dot(d))).unwrap()
    }

    #[test]
    fn a_box_has_its_known_distances() {
        let corners: Vec<DVec3> = (0..8)
            .map(|i| {
                DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - DVec3::ONE
            })
            .collect();
        let mut s = Source::new(3);
        for _ in 0..500 {
            let query = s.normal3() * 2.0;
            let found = nearest(query, corners[0], |d| support(&corners, d));
            let expected = query - query.clamp(DVec3::NEG_ONE, DVec3::ONE);
            assert!((found.certified - expected.length()).abs() < 1e-14, "{query} {found:?}");
            assert!((query - found.point - expected).length() < 1e-13);
        }
    }

    #[test]
    fn on_random_hulls_the_certified_and_the_reached_distance_agree() {
        let mut s = Source::new(4);
        for kind in
            [InputKind::Curves, InputKind::Lattice, InputKind::Thin6, InputKind::Small, InputKind::Planar]
        {
            let points = kind.points(200, 1);
            let size = points.iter().map(|p| p.length()).fold(0.0, f64::max);
            for _ in 0..50 {
                let query = s.normal3() * size * 3.0;
                let found = nearest(query, points[0], |d| support(&points, d));
                let reached = found.point.distance(query);
                assert!(reached - found.certified <= 1e-12 * size, "{kind:?} {reached} {found:?}");
            }
        }
    }
}
