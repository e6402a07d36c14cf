//! Bodies drawn between the bounds.
//!
//! Between neighbouring contacts a body is in the triangle of both points and the corner where their tangents meet, and is tangent to
//! both sides. So is a conic arc with that control triangle, for any weight `w > 0`: from near the chord to near the corner. A body of such arcs
//! passes through every contact with its normal, and all of it lies between the bounds.

use super::balance::RollingBody;
use super::gain::Cell;
use crate::random::Source;
use glam::DVec2;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A smooth convex body of conic arcs.
#[derive(Clone, Debug)]
pub struct DrawnBody {
    cells: Arc<Vec<Cell>>,
    weights: Vec<f64>,
    centre: DVec2,
}

/// Standard deviation of the logarithm of an arc's weight over that of a circle's.
const SPREAD: f64 = 0.7;

impl DrawnBody {
    /// Weights are those of circular arcs, `cos` of half the turn, times a log-normal number.
    pub(super) fn draw(cells: &Arc<Vec<Cell>>, source: &mut Source) -> Self {
        let weight = |cell: &Cell| {
            let half = 0.5 * (cell.to - cell.from);
            half.cos().max(0.05) * (SPREAD * source.normal()).exp()
        };
        let weights = cells.iter().map(weight).collect();
        let mut body = Self { cells: Arc::clone(cells), weights, centre: DVec2::ZERO };
        body.centre = body.centroid();
        body
    }

    /// The same with another centre of mass (m).
    pub(super) fn with_centre(self, centre: DVec2) -> Self {
        Self { centre, ..self }
    }

    /// Centroid of the polygon of all ends of arcs and their middles.
    fn centroid(&self) -> DVec2 {
        let middles = self.cells.iter().map(|c| (c.points[0], self.farthest(0.5 * (c.from + c.to))));
        let ring: Vec<DVec2> = middles.flat_map(|(a, b)| [a, b]).collect();
        let Some(origin) = ring.first().copied() else { return DVec2::ZERO };
        let (mut area, mut moment) = (0.0, DVec2::ZERO);
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let cross = (*a - origin).perp_dot(*b - origin);
            area += cross;
            moment += (*a + *b - 2.0 * origin) * cross;
        }
        if area > 0.0 { origin + moment / (3.0 * area) } else { origin }
    }
}

/// The cell that holds the direction `theta` (rad), and `theta` in its range.
pub(super) fn cell_at(cells: &[Cell], theta: f64) -> (usize, f64) {
    let start = cells.first().map_or(0.0, |c| c.from);
    let theta = start + (theta - start).rem_euclid(TAU);
    let after = cells.partition_point(|c| c.from <= theta);
    (after.max(1) - 1, theta)
}

impl RollingBody for DrawnBody {
    /// On the arc from `p` to `q` with corner `v`: `x = ((1-t)^2 p + 2 w t (1-t) v + t^2 q) / (...)`, whose tangent at `t` joins
    /// the points that divide both sides at `t` (de Casteljau). It is at right angles to `n` where, with `a = n . (v - p)`, `b = n . (v - q)` and
    /// `k = t / (1 - t)`: `w b k^2 + (b - a) k - w a = 0`.
    fn farthest(&self, theta: f64) -> DVec2 {
        let (index, _) = cell_at(&self.cells, theta);
        let Some(cell) = self.cells.get(index) else { return DVec2::NAN };
        let (n, w) = (DVec2::from_angle(theta), self.weights[index]);
        let ([p, q], v) = (cell.points, cell.corner);
        // Rounding may put a tangent's own direction below zero.
        let (a, b) = (n.dot(v - p).max(0.0), n.dot(v - q).max(0.0));
        let root = ((a - b).powi(2) + 4.0 * a * b * w * w).sqrt();
        // Of both forms the one that does not cancel; up to a common factor these are t and 1 - t.
        let (t, u) = if a >= b { (a - b + root, 2.0 * w * b) } else { (2.0 * w * a, b - a + root) };
        if t + u <= 0.0 {
            return p;
        }
        let (t, u) = (t / (t + u), u / (t + u));
        let weights = [u * u, 2.0 * w * t * u, t * t];
        (p * weights[0] + v * weights[1] + q * weights[2]) / weights.iter().sum::<f64>()
    }

    fn centre(&self) -> DVec2 {
        self.centre
    }
}
