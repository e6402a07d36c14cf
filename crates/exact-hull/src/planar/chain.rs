//! The convex polygon of points in the plane.

use crate::predicates::turn;
use glam::DVec2;

/// Indices of the strictly convex corners of `points`, anticlockwise from the lexicographically least; exact.
///
/// Andrew's monotone chain, of the points that are not plainly inside. One index for coincident points, two for collinear ones.
pub(crate) fn convex_corners(points: &[DVec2]) -> Vec<u32> {
    let ring = ring(points);
    let mut order: Vec<u32> =
        (0..points.len() as u32).filter(|i| !is_within(&ring, points[*i as usize])).collect();
    // Adding zero makes -0 and 0 one value for the total order.
    let at = |i: u32| points[i as usize] + DVec2::ZERO;
    order.sort_unstable_by(|&i, &j| {
        (at(i).x.total_cmp(&at(j).x)).then(at(i).y.total_cmp(&at(j).y)).then(i.cmp(&j))
    });
    order.dedup_by(|j, i| at(*i) == at(*j));
    if order.len() < 3 {
        return order;
    }
    let mut corners = half_chain(order.iter().copied(), at);
    corners.pop();
    let upper = half_chain(order.iter().rev().copied(), at);
    corners.extend_from_slice(&upper[..upper.len() - 1]);
    corners
}

/// Directions in which the farthest points are looked for, anticlockwise: rounded numbers, as any points will do.
const AROUND: [[f64; 2]; 16] = [
    [1.0, 0.0],
    [0.92, 0.38],
    [0.71, 0.71],
    [0.38, 0.92],
    [0.0, 1.0],
    [-0.38, 0.92],
    [-0.71, 0.71],
    [-0.92, 0.38],
    [-1.0, 0.0],
    [-0.92, -0.38],
    [-0.71, -0.71],
    [-0.38, -0.92],
    [0.0, -1.0],
    [0.38, -0.92],
    [0.71, -0.71],
    [0.92, -0.38],
];
/// Fewer points are sorted as soon as looked through.
const MANY: usize = 64;

/// Some of the points that lie far out, all around; none of few points.
fn ring(points: &[DVec2]) -> Vec<DVec2> {
    if points.len() < MANY {
        return Vec::new();
    }
    let mut farthest = [(f64::NEG_INFINITY, points[0]); AROUND.len()];
    for p in points {
        for ((most, at), [x, y]) in farthest.iter_mut().zip(AROUND) {
            let along = x * p.x + y * p.y;
            if along > *most {
                (*most, *at) = (along, *p);
            }
        }
    }
    let mut ring: Vec<DVec2> = farthest.into_iter().map(|(_, at)| at).collect();
    ring.dedup();
    ring
}

/// Whether a point is left of every edge of a ring, exactly: then each edge goes round it anticlockwise, so the ring does, and a closed line
/// goes round nothing outside of the hull of its points. It is no corner, whatever the ring (Akl and Toussaint, "A fast convex hull algorithm", 1978).
fn is_within(ring: &[DVec2], point: DVec2) -> bool {
    let next = ring.iter().cycle().skip(1);
    ring.len() > 2 && ring.iter().zip(next).all(|(a, b)| a == b || turn(*a, *b, point) > 0.0)
}

/// The chain that turns left all along `order`, from its first to its last point.
fn half_chain(order: impl Iterator<Item = u32>, at: impl Fn(u32) -> DVec2) -> Vec<u32> {
    let mut chain: Vec<u32> = Vec::new();
    for i in order {
        while let [.., a, b] = chain[..]
            && turn(at(a), at(b), at(i)) <= 0.0
        {
            chain.pop();
        }
        chain.push(i);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_strict_corners_remain() {
        let square =
            [(0.0, 0.0), (1.0, 0.0), (0.5, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.5), (0.5, 0.5), (1.0, 1.0)];
        let points: Vec<DVec2> = square.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
        assert_eq!(convex_corners(&points), [0, 1, 3, 4]);
    }

    #[test]
    fn signed_zeros_are_one_point() {
        let points = [DVec2::new(0.0, 0.0), DVec2::new(-0.0, 0.0), DVec2::new(0.0, -0.0)];
        assert_eq!(convex_corners(&points).len(), 1);
    }

    #[test]
    fn collinear_and_coincident_points() {
        let line: Vec<DVec2> = (0..5).map(|i| DVec2::new(f64::from(i), 2.0 * f64::from(i))).collect();
        assert_eq!(convex_corners(&line), [0, 4]);
        assert_eq!(convex_corners(&[DVec2::ONE; 3]), [0]);
    }
}
