//! Bodies drawn between the bounds.
//!
//! Between neighbouring contacts a body is in the triangle of both points and the corner where their tangents meet, and is tangent to
//! both sides. So is a conic arc with that control triangle, for any weight `w > 0`: from near the chord to near the corner. A body of such arcs
//! passes through every contact with its normal, and all of it lies between the bounds.

use super::balance::RollingBody;
use super::gain::Cell;
use crate::random::Source;
use contact_kinematics::planar::{RadiusBounds, RadiusFunction, RadiusJet};
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

/// Radii of curvature below this share of the body's, or above its inverse, are corners and flats: predicted motions take them for arcs.
const BENT: f64 = 0.1;

impl DrawnBody {
    /// On the arc from `p` to `q` with corner `v`: `x = ((1-t)^2 p + 2 w t (1-t) v + t^2 q) / (...)`, whose tangent at `t` joins
    /// the points that divide both sides at `t` (de Casteljau). It is at right angles to `n` where, with `a = n . (v - p)`, `b = n . (v - q)` and
    /// `k = t / (1 - t)`: `w b k^2 + (b - a) k - w a = 0`. The cell and its weight, and `1 - t` and `t`; none where the arc is a point.
    fn on_arc(&self, theta: f64) -> Option<(&Cell, f64, [f64; 2])> {
        let (index, _) = cell_at(&self.cells, theta);
        let (cell, w) = (self.cells.get(index)?, self.weights[index]);
        let (n, [p, q], v) = (DVec2::from_angle(theta), cell.points, cell.corner);
        // Rounding may put a tangent's own direction below zero.
        let (a, b) = (n.dot(v - p).max(0.0), n.dot(v - q).max(0.0));
        let root = ((a - b).powi(2) + 4.0 * a * b * w * w).sqrt();
        // Of both forms the one that does not cancel; up to a common factor these are t and 1 - t.
        let (t, u) = if a >= b { (a - b + root, 2.0 * w * b) } else { (2.0 * w * a, b - a + root) };
        let parts = (t + u > 0.0).then(|| [u / (t + u), t / (t + u)]);
        Some((cell, w, parts.unwrap_or([1.0, 0.0])))
    }

    /// Radius of curvature in m, within what motions are predicted with: `|x'|^3 / |x' x x''|` over the parameter of the arc.
    fn bent(&self, theta: f64) -> f64 {
        let Some((cell, w, [u, t])) = self.on_arc(theta) else { return f64::NAN };
        let ([p, q], v) = (cell.points, cell.corner);
        let (n0, d0) = (p * (u * u) + v * (2.0 * w * t * u) + q * (t * t), u * u + 2.0 * w * t * u + t * t);
        let (n1, d1) = (2.0 * (q * t - p * u + v * (w * (u - t))), 2.0 * (t - u + w * (u - t)));
        let (n2, d2) = (2.0 * (p + q - v * (2.0 * w)), 4.0 * (1.0 - w));
        let x = n0 / d0;
        let x1 = (n1 - x * d1) / d0;
        let x2 = (n2 - x1 * (2.0 * d1) - x * d2) / d0;
        let size = cell.points[0].distance(self.centre);
        let bent = x1.length().powi(3) / x1.perp_dot(x2).abs();
        if bent.is_finite() { bent.clamp(BENT * size, size / BENT) } else { size / BENT }
    }
}

impl RollingBody for DrawnBody {
    fn farthest(&self, theta: f64) -> DVec2 {
        let Some((cell, w, [u, t])) = self.on_arc(theta) else { return DVec2::NAN };
        let ([p, q], v) = (cell.points, cell.corner);
        let weights = [u * u, 2.0 * w * t * u, t * t];
        (p * weights[0] + v * weights[1] + q * weights[2]) / weights.iter().sum::<f64>()
    }

    fn centre(&self) -> DVec2 {
        self.centre
    }
}

impl RadiusFunction for DrawnBody {
    fn jet(&self, theta: f64) -> RadiusJet {
        let (x, (sin, cos)) = (self.farthest(theta) - self.centre, theta.sin_cos());
        RadiusJet { r: x.x * cos + x.y * sin, d: x.x * sin - x.y * cos, rho: self.bent(theta) }
    }

    /// What [`Self::jet`] gives is held within these.
    fn radius_bounds(&self) -> RadiusBounds {
        let far = |c: &Cell| c.points[0].distance(self.centre);
        let (near, far) =
            self.cells.iter().map(far).fold((f64::INFINITY, 0.0_f64), |(a, b), r| (a.min(r), b.max(r)));
        RadiusBounds { min: BENT * near, max: far / BENT }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arc of a circle is the conic with the weight of half its turn, and the slope of any body's contact is its radius of curvature.
    #[test]
    fn curvature_is_that_of_the_contact() {
        let half = 0.4_f64;
        let ends = [-half, half];
        let cell = Cell {
            from: -half,
            to: half,
            points: ends.map(|a| DVec2::from_angle(a) * 2.0),
            corner: DVec2::X * (2.0 / half.cos()),
            real: [true; 2],
            area: 1.0,
        };
        let body = |weight: f64| DrawnBody {
            cells: Arc::new(vec![cell]),
            weights: vec![weight],
            centre: DVec2::ZERO,
        };
        let (circle, conic) = (body(half.cos()), body(0.4));
        for k in -7..=7 {
            let theta = 0.05 * f64::from(k);
            assert!((circle.jet(theta).rho - 2.0).abs() < 1e-12, "{:?}", circle.jet(theta));
            let slope = (conic.farthest(theta + 1e-6) - conic.farthest(theta - 1e-6)).length() / 2e-6;
            assert!((conic.jet(theta).rho / slope - 1.0).abs() < 1e-6, "{theta} {slope}");
        }
    }
}
