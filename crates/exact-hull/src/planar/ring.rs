//! Corners of a convex polygon, found by direction.

use glam::DVec2;
use std::f64::consts::TAU;

/// The corners of a convex polygon in order counter-clockwise (one and two are a point and a segment), with the directions in
/// which each is the farthest: a bisection instead of a walk, because noisy contacts come in any order.
#[derive(Clone, Debug)]
pub struct Ring<'a> {
    corners: &'a [DVec2],
    /// Direction of the outward normal of the first edge, rad.
    first: f64,
    /// Those of all edges from there, in [0, 2 pi), rising but for rounding.
    normals: Vec<f64>,
}

impl<'a> Ring<'a> {
    /// Of corners in order.
    #[must_use]
    pub fn new(corners: &'a [DVec2]) -> Self {
        let count = corners.len();
        let normal = |k: usize| -(corners[(k + 1) % count] - corners[k]).perp();
        let first = if count > 1 { normal(0).to_angle() } else { 0.0 };
        let normals =
            (0..count).map(|k| if k == 0 { 0.0 } else { (normal(k).to_angle() - first).rem_euclid(TAU) });
        Self { corners, first, normals: normals.collect() }
    }

    /// Which corner is the farthest along `n`.
    #[must_use]
    pub fn farthest(&self, n: DVec2) -> usize {
        let count = self.corners.len();
        let angle = (n.to_angle() - self.first).rem_euclid(TAU);
        let mut at = self.normals.partition_point(|normal| *normal < angle) % count.max(1);
        let height = |k: usize| n.dot(self.corners[k]);
        // Angles are rounded, and heights decide.
        while let Some(side) =
            [(at + 1) % count, (at + count - 1) % count].into_iter().find(|side| height(*side) > height(at))
        {
            at = side;
        }
        at
    }

    /// Largest distance from `point` of the part of the polygon in which `excess` is positive: what a half-plane with the outward
    /// normal `n` would cut off.
    #[must_use]
    pub fn reach_beyond(&self, n: DVec2, excess: impl Fn(DVec2) -> f64, point: DVec2) -> f64 {
        let count = self.corners.len();
        let top = self.farthest(n);
        let mut reach = 0.0_f64;
        for step in [1, count - 1] {
            let mut at = top;
            for _ in 0..count {
                let (a, b) = (self.corners[at], self.corners[(at + step) % count]);
                let (from, to) = (excess(a), excess(b));
                if from <= 0.0 {
                    break;
                }
                reach = reach.max(a.distance(point));
                if to < 0.0 {
                    reach = reach.max((a + (b - a) * (from / (from - to))).distance(point));
                }
                at = (at + step) % count;
            }
        }
        reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::Source;
    use crate::planar::{Direction, HalfPlane, Hull};

    #[test]
    fn corners_and_what_lines_cut_off_are_those_of_a_scan() {
        let mut s = Source::new(5);
        for count in [1, 2, 3, 40] {
            let mut place = || DVec2::new(s.normal(), s.normal());
            let points: Vec<DVec2> = (0..count).map(|_| place()).collect();
            let corners = Hull::of(&points).unwrap().corner_points(&points);
            let ring = Ring::new(&corners);
            for _ in 0..200 {
                let (point, normal) = (place() * 0.5, Direction::new(place()).unwrap());
                let n = normal.get();
                let highest = corners.iter().map(|c| c.dot(n)).fold(f64::NEG_INFINITY, f64::max);
                assert!(corners[ring.farthest(n)].dot(n) >= highest);
                let plane = HalfPlane { point, normal, margin: 0.0 };
                let reach = ring.reach_beyond(n, |p| plane.excess(p), point);
                // The part beyond is convex: its farthest point is a corner of the polygon or lies on the line, on an edge.
                let edges = (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]));
                let cut = |(a, b): (DVec2, DVec2)| {
                    let (from, to) = (plane.excess(a), plane.excess(b));
                    let crossing = (from * to < 0.0).then(|| a + (b - a) * (from / (from - to)));
                    crossing.into_iter().chain((from > 0.0).then_some(a))
                };
                let scan = edges.flat_map(cut).map(|p| p.distance(point)).fold(0.0, f64::max);
                assert!((reach - scan).abs() <= 1e-14 * scan, "{count}: {reach} {scan}");
            }
        }
    }
}
