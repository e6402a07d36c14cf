//! Distance from a point to a convex body that is known by its support points.
//!
//! Gilbert, Johnson and Keerthi (1988), written with the stopping rule that a bound needs: the direction that is
//! returned certifies a distance by itself, whatever the iteration did.
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::distance::nearest;
//!
//! // From a point beside a cube of edge 2 about the origin: what is nearest is on a face, and nothing is nearer than 2.
//! let corner = |d: DVec3| DVec3::ONE.copysign(d);
//! let found = nearest(DVec3::new(3.0, 0.25, 0.5), &[], corner);
//! assert!((found.point - DVec3::new(1.0, 0.25, 0.5)).length() < 1e-12);
//! assert!((found.certified - 2.0).abs() < 1e-12);
//! ```

use glam::DVec3;

/// The part of the distance by which the certified distance may fall short before the iteration stops.
const RELATIVE: f64 = 1e-13;
/// Iterations at most; some ten suffice for a polytope.
const ITERATIONS: usize = 200;

/// The nearest point of a body, as far as found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// A point of the body; its distance is at least the true one.
    pub point: DVec3,
    /// Unit vector from the body to the query; zero if the query is in the body.
    pub direction: DVec3,
    /// The body has no point nearer than this in m: the query's height over the supporting plane across `direction`.
    pub certified: f64,
}

/// Nearest point to `query` of the body whose farthest point along `d` is `support(d)`; `start` are one to three of its points,
/// the nearer the better: from one alone that is near beside the nearest, the first direction is along the surface. All in m.
///
/// Without a start, the support point along the x axis is one.
pub fn nearest(query: DVec3, start: &[DVec3], mut support: impl FnMut(DVec3) -> DVec3) -> Nearest {
    let mut simplex: Vec<DVec3> = start.iter().map(|p| *p - query).collect();
    if simplex.is_empty() {
        simplex.push(support(DVec3::X) - query);
    }
    let mut closest = reduce(&mut simplex);
    let mut best = Nearest { point: closest + query, direction: DVec3::ZERO, certified: 0.0 };
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
        if distance - best.certified <= RELATIVE * distance {
            break;
        }
        simplex.push(candidate);
        let mut next = reduce(&mut simplex);
        if next.length_squared() >= closest.length_squared() {
            // Corners that nearly coincide make the simplex degenerate. The segment from the nearest point so far to the
            // candidate holds a nearer one, unless rounding is all that is left.
            simplex = vec![closest, candidate];
            next = reduce(&mut simplex);
            if next.length_squared() >= closest.length_squared() {
                break;
            }
        }
        closest = next;
    }
    Nearest { point: closest + query, ..best }
}

/// The point of the simplex nearest to the origin, with the simplex cut down to the corners that carry it.
///
/// Points are means of corners with weights of at least zero, so that they are in the simplex however degenerate it is.
fn reduce(simplex: &mut Vec<DVec3>) -> DVec3 {
    let (point, kept) = match simplex[..] {
        [a, b] => on_segment(a, b),
        [a, b, c] => on_triangle(a, b, c),
        [a, b, c, d] => on_tetrahedron([a, b, c, d]),
        _ => (simplex[0], vec![0]),
    };
    *simplex = kept.into_iter().map(|k| simplex[k]).collect();
    point
}

fn on_tetrahedron(corners: [DVec3; 4]) -> (DVec3, Vec<usize>) {
    let [a, b, c, d] = corners;
    let volume = |p: DVec3, q: DVec3, r: DVec3, s: DVec3| (q - p).cross(r - p).dot(s - p);
    let origin = DVec3::ZERO;
    let weights =
        [volume(origin, b, d, c), volume(origin, a, c, d), volume(origin, a, d, b), volume(origin, a, b, c)];
    let inside = mean(corners, weights).map(|point| (point, vec![0, 1, 2, 3]));
    let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]].into_iter().map(|face| {
        let (point, kept) = on_triangle(corners[face[0]], corners[face[1]], corners[face[2]]);
        (point, kept.into_iter().map(|k| face[k]).collect())
    });
    nearer(faces.chain(inside)).unwrap_or((a, vec![0]))
}

fn on_triangle(a: DVec3, b: DVec3, c: DVec3) -> (DVec3, Vec<usize>) {
    let normal = (b - a).cross(c - a);
    let weight = |p: DVec3, q: DVec3| p.cross(q).dot(normal);
    let inside = mean([a, b, c], [weight(b, c), weight(c, a), weight(a, b)]);
    let edges = [([a, b], [0, 1]), ([b, c], [1, 2]), ([c, a], [2, 0])].into_iter().map(|([p, q], names)| {
        let (point, kept) = on_segment(p, q);
        (point, kept.into_iter().map(|k| names[k]).collect::<Vec<_>>())
    });
    nearer(edges.chain(inside.map(|point| (point, vec![0, 1, 2])))).unwrap_or((a, vec![0]))
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

/// The mean with weights that are all of one sign; `None` where they are not, or all zero.
fn mean<const N: usize>(corners: [DVec3; N], weights: [f64; N]) -> Option<DVec3> {
    let sum: f64 = weights.iter().sum();
    let shares = weights.map(|w| w / sum);
    let valid = shares.iter().all(|w| *w >= 0.0);
    valid.then(|| corners.iter().zip(shares).map(|(c, w)| *c * w).sum())
}

fn nearer(found: impl Iterator<Item = (DVec3, Vec<usize>)>) -> Option<(DVec3, Vec<usize>)> {
    found.min_by(|x, y| x.0.length_squared().total_cmp(&y.0.length_squared()))
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
            let found = nearest(query, &corners[..1], |d| support(&corners, d));
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
                let found = nearest(query, &points[..1], |d| support(&points, d));
                let reached = found.point.distance(query);
                assert!(reached - found.certified <= 1e-12 * size, "{kind:?} {reached} {found:?}");
            }
        }
    }

    #[test]
    fn corners_that_nearly_coincide_do_not_mislead() {
        let mut s = Source::new(5);
        let spread = |s: &mut Source, p: DVec3| p + s.normal3() * 10.0_f64.powf(s.between(-16.0, -11.0));
        let points: Vec<DVec3> = InputKind::Curves
            .points(300, 2)
            .iter()
            .flat_map(|p| [(); 6].map(|()| spread(&mut s, *p)))
            .collect();
        let Ok(exact_hull::Hull::Solid(hull)) = exact_hull::Hull::of(&points) else { panic!("flat") };
        for _ in 0..2000 {
            let middle = points[s.below(points.len())].lerp(points[s.below(points.len())], s.unit());
            let query = middle * s.between(1.0, 3.0);
            let found = nearest(query, &[points[s.below(points.len())]], |d| support(&points, d));
            let reached = found.point.distance(query);
            assert!(reached - found.certified <= 1e-11, "{query} {reached} {found:?}");
            assert!(reached >= hull.excess(query) - 1e-11, "{query} {reached} {}", hull.excess(query));
            let height =
                points.iter().map(|p| (*p - query).dot(found.direction)).fold(f64::NEG_INFINITY, f64::max);
            assert!((height + found.certified).abs() < 1e-14 || reached < 1e-11, "{height} {found:?}");
        }
    }
}
