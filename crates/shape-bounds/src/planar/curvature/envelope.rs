//! Which disc or half-plane bounds their intersection in which direction, seen from a point inside of it.

use super::Disc;
use exact_hull::planar::HalfPlane;
use glam::DVec2;
use std::f64::consts::TAU;

/// From the angle `start` (rad, in [0, 2 pi)) on to the next piece's the outline is that of a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) start: f64,
    /// Which disc, or the number of discs plus which half-plane.
    pub(super) source: usize,
}

/// Discs and half-planes with a point that is inside of all of them.
pub(super) struct Around<'a> {
    pub(super) discs: &'a [Disc],
    pub(super) half_planes: &'a [HalfPlane],
    pub(super) centre: DVec2,
}

impl Around<'_> {
    /// The outline of the intersection, by divide and conquer: two sources cross at most twice, so that the lower envelope of all
    /// distances along a ray has at most `2 n - 1` pieces (Davenport and Schinzel) and takes time O(n log n).
    pub(super) fn envelope(&self) -> Vec<Piece> {
        let mut pieces = self.of_range(0, self.discs.len() + self.half_planes.len());
        // Twice the same across the angle zero is one piece.
        if pieces.len() > 1 && pieces.first().map(|p| p.source) == pieces.last().map(|p| p.source) {
            pieces.remove(0);
        }
        pieces
    }

    fn of_range(&self, from: usize, to: usize) -> Vec<Piece> {
        if to - from == 1 {
            let only = |source: usize| [Piece { start: 0.0, source }];
            // Where a line is not met the first disc is: of two lines that are met nowhere at once neither would do.
            return if from < self.discs.len() {
                only(from).to_vec()
            } else {
                self.lower(&only(0), &only(from))
            };
        }
        let middle = from.midpoint(to);
        self.lower(&self.of_range(from, middle), &self.of_range(middle, to))
    }

    /// The nearer of two outlines that both begin at the angle zero.
    fn lower(&self, a: &[Piece], b: &[Piece]) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::with_capacity(a.len() + b.len());
        let (mut i, mut j, mut start) = (0, 0, 0.0);
        while start < TAU {
            let next = |pieces: &[Piece], k: usize| pieces.get(k + 1).map_or(TAU, |p| p.start);
            let (end_a, end_b) = (next(a, i), next(b, j));
            let end = end_a.min(end_b);
            self.nearer(a[i].source, b[j].source, [start, end], &mut pieces);
            (i, j) = (i + usize::from(end_a == end), j + usize::from(end_b == end));
            start = end;
        }
        pieces
    }

    /// Adds which of two sources is the nearer one, from angle to angle.
    fn nearer(&self, a: usize, b: usize, [from, to]: [f64; 2], pieces: &mut Vec<Piece>) {
        let mut ends = [from, to, to, to];
        let mut count = 1;
        for crossing in self.crossings(a, b).into_iter().flatten() {
            let angle = (crossing - self.centre).to_angle().rem_euclid(TAU);
            if from < angle && angle < to {
                ends[count] = angle;
                count += 1;
            }
        }
        ends[1..=2].sort_by(f64::total_cmp);
        for k in 0..count {
            let along = DVec2::from_angle(0.5 * (ends[k] + ends[k + 1]));
            let source = if self.distance(b, along) < self.distance(a, along) { b } else { a };
            if pieces.last().is_none_or(|last| last.source != source) {
                pieces.push(Piece { start: ends[k], source });
            }
        }
    }

    /// How far the outline of a source is from the centre along a unit vector, m; infinite if it is not met.
    pub(super) fn distance(&self, source: usize, along: DVec2) -> f64 {
        if let Some(disc) = self.discs.get(source) {
            let offset = disc.centre - self.centre;
            let across = offset.perp_dot(along);
            return offset.dot(along) + ((disc.radius - across) * (disc.radius + across)).max(0.0).sqrt();
        }
        let plane = &self.half_planes[source - self.discs.len()];
        let slope = plane.normal.get().dot(along);
        if slope > 0.0 { -plane.excess(self.centre) / slope } else { f64::INFINITY }
    }

    /// Where the outlines of two sources cross.
    fn crossings(&self, a: usize, b: usize) -> [Option<DVec2>; 2] {
        match (self.discs.get(a), self.discs.get(b)) {
            (Some(one), Some(other)) => {
                let offset = other.centre - one.centre;
                let distance = offset.length();
                if distance == 0.0 {
                    return [None; 2];
                }
                let square = (one.radius - other.radius) * (one.radius + other.radius);
                cut(one, offset / distance, 0.5 * (distance + square / distance))
            }
            (Some(disc), None) => self.cut_by_line(disc, b),
            (None, Some(disc)) => self.cut_by_line(disc, a),
            (None, None) => {
                let [p, q] = [a, b].map(|k| &self.half_planes[k - self.discs.len()]);
                let (n, m) = (p.normal.get(), q.normal.get());
                let turn = n.perp_dot(m);
                let (x, y) = (-p.excess(self.centre), -q.excess(self.centre));
                let corner = self.centre + (m.perp() * -x + n.perp() * y) / turn;
                [corner.is_finite().then_some(corner), None]
            }
        }
    }

    fn cut_by_line(&self, disc: &Disc, line: usize) -> [Option<DVec2>; 2] {
        let plane = &self.half_planes[line - self.discs.len()];
        cut(disc, plane.normal.get(), -plane.excess(disc.centre))
    }
}

/// Where a circle meets the line `normal . (p - its centre) = height`.
fn cut(disc: &Disc, normal: DVec2, height: f64) -> [Option<DVec2>; 2] {
    let square = (disc.radius - height) * (disc.radius + height);
    if square.is_nan() || square < 0.0 {
        return [None; 2];
    }
    let (foot, across) = (disc.centre + normal * height, normal.perp() * square.sqrt());
    [Some(foot + across), Some(foot - across)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::Source;
    use crate::planar::curvature::DiscIntersection;
    use exact_hull::planar::Direction;

    #[test]
    fn pieces_are_the_nearest_of_all_sources() {
        for seed in 0..30 {
            let mut s = Source::new(seed);
            let mut place = |size: f64| DVec2::new(s.normal(), s.normal()) * size;
            let centres: Vec<DVec2> = (0..40).map(|_| place(0.2)).collect();
            let normals: Vec<DVec2> = (0..6).map(|_| place(1.0)).collect();
            // Of one radius, of many, and but for rounding one disc.
            let (spread, shrink) = [(0.0, 1.0), (1.0, 1.0), (0.0, 1e-15)][seed as usize % 3];
            let discs: Vec<Disc> = (centres.iter())
                .map(|c| Disc { centre: *c * shrink, radius: 1.5 + spread * c.x.abs() })
                .collect();
            let half_planes: Vec<HalfPlane> = (normals.iter())
                .map(|n| HalfPlane {
                    point: *n * 0.1,
                    normal: Direction::new(*n).unwrap(),
                    margin: 1.0 + spread,
                })
                .collect();
            let bound = DiscIntersection::of(&discs, &half_planes).unwrap();
            let around = Around { discs: &discs, half_planes: &half_planes, centre: bound.centre() };
            for k in 0..500 {
                let along = DVec2::from_angle(TAU * f64::from(k) / 500.0);
                let least =
                    (0..46).map(|source| around.distance(source, along)).fold(f64::INFINITY, f64::min);
                let (excess, source) = bound.excess(bound.centre() + along * least);
                assert!(
                    around.distance(source, along) - least < 1e-13,
                    "seed {seed}, {k}: {} {least} {source}",
                    around.distance(source, along) - least
                );
                assert!(excess.abs() < 1e-13, "seed {seed}, {k}: {excess}");
            }
            let (first, last) = (bound.sides()[0], bound.sides()[bound.sides().len() - 1]);
            assert!(last.to.distance(first.from) < 1e-13, "seed {seed}");
            for pair in bound.sides().windows(2) {
                assert!(pair[0].to.distance(pair[1].from) < 1e-13, "seed {seed}");
            }
        }
    }
}
