//! Places on a closed line by the way along it.

use glam::DVec2;
use object_dynamics::pushing::ClosedLine;

/// Ways along a closed line from its first corner, m.
pub(super) struct Arcs {
    /// To each corner.
    pub(super) before: Vec<f64>,
    length: f64,
}

impl Arcs {
    pub(super) fn new(line: &ClosedLine) -> Self {
        let mut length = 0.0;
        let mut before = Vec::new();
        for (a, b) in line.edges() {
            before.push(length);
            length += a.distance(b);
        }
        Self { before, length }
    }

    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// Way to the point of the line that is nearest to another one.
    pub(super) fn of(&self, line: &ClosedLine, point: DVec2) -> f64 {
        let near = line.nearest(point);
        self.before[near.edge] + near.point.distance(line.corners()[near.edge])
    }

    /// Point and outward normal after a way.
    pub(super) fn at(&self, line: &ClosedLine, way: f64) -> (DVec2, DVec2) {
        let way = way.rem_euclid(self.length);
        let edge = self.before.partition_point(|b| *b <= way).saturating_sub(1);
        let corners = line.corners();
        let along = (corners[(edge + 1) % corners.len()] - corners[edge]).normalize_or_zero();
        (corners[edge] + along * (way - self.before[edge]), -along.perp())
    }

    /// The shorter way from one place to another, counter-clockwise positive.
    pub(super) fn between(&self, from: f64, to: f64) -> f64 {
        let way = (to - from).rem_euclid(self.length);
        if way > 0.5 * self.length { way - self.length } else { way }
    }

    /// Ways to the nearest end of a span, clockwise and counter-clockwise.
    pub(super) fn to_ends(&self, at: f64, spans: &[[f64; 2]]) -> [f64; 2] {
        let ways = spans.iter().flatten().map(|end| (end - at).rem_euclid(self.length));
        ways.fold([self.length; 2], |[back, on], way| [back.min(self.length - way), on.min(way)])
    }

    /// Way to the nearest span; 0 on one.
    pub(super) fn to_spans(&self, at: f64, spans: &[[f64; 2]]) -> f64 {
        let on = |[from, to]: &[f64; 2]| {
            let (whole, part) = (self.between(*from, *to), self.between(*from, at));
            part * whole >= 0.0 && part.abs() <= whole.abs()
        };
        if spans.iter().any(on) {
            return 0.0;
        }
        let [back, ahead] = self.to_ends(at, spans);
        back.min(ahead)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_go_around() {
        let line = ClosedLine::new(vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y]).unwrap();
        let arcs = Arcs::new(&line);
        assert_eq!(arcs.length(), 4.0);
        assert_eq!(arcs.of(&line, DVec2::new(1.3, 0.25)), 1.25);
        assert_eq!(arcs.at(&line, 5.25).0, DVec2::new(1.0, 0.25));
        assert_eq!(arcs.between(3.75, 0.25), 0.5);
        assert_eq!(arcs.to_ends(0.0, &[[3.5, 3.75], [1.0, 1.5]]), [0.25, 1.0]);
        assert_eq!(arcs.to_spans(3.9, &[[3.5, 0.25]]), 0.0);
        assert_eq!(arcs.to_spans(0.5, &[[3.5, 0.25]]), 0.25);
    }
}
