//! Polygons with rounded corners and slightly bulging edges.

use super::circle::{check_length, check_point};
use super::error::ShapeError;
use super::radius::{RadiusBounds, RadiusFunction, RadiusJet, point_jet};
use glam::DVec2;
use std::f64::consts::TAU;

/// A convex polygon whose corners are arcs of radius `corner_radius` and whose edges are arcs that turn by twice the
/// `edge_half_angle`.
///
/// An edge of length `L` becomes an arc of radius `corner_radius + L / (2 sin half_angle)` about the edge's normal.
/// Its chord is the edge, hence the outline closes exactly, and the radius of curvature is piecewise constant: bounded,
/// positive and with jumps, the hard case for an observer that a smooth shape does not show. As the half-angle
/// shrinks the body tends to the polygon grown by a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedPolygon {
    edges: Vec<Edge>,
    corner_radius: f64,
    half_angle: f64,
}

/// Edge from `from` to `to`, with outward normal direction `normal`, the direction `start` at which its arc begins
/// (both in `[0, TAU)`) and the arc's radius without the rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    from: DVec2,
    to: DVec2,
    normal: f64,
    start: f64,
    bulge: f64,
}

impl RoundedPolygon {
    /// From corners (counter-clockwise, m, body axes from the centre of mass), the radius of the rounding (m) and
    /// the half-angle (rad) by which each edge turns on either side of its normal.
    ///
    /// # Errors
    /// [`ShapeError`] names the corner or the number that cannot be used.
    pub fn new(corners: &[DVec2], corner_radius: f64, edge_half_angle: f64) -> Result<Self, ShapeError> {
        check_length("corner radius", corner_radius)?;
        if corners.len() < 3 {
            return Err(ShapeError::TooFewCorners { found: corners.len() });
        }
        for &corner in corners {
            check_point("corner coordinate", corner)?;
        }
        let count = corners.len();
        let mut edges: Vec<Edge> = Vec::with_capacity(count);
        for (i, &from) in corners.iter().enumerate() {
            let to = corners[(i + 1) % count];
            check_length("edge", (to - from).length())?;
            let normal = (from.x - to.x).atan2(to.y - from.y).rem_euclid(TAU);
            edges.push(Edge { from, to, normal, start: normal, bulge: 0.0 });
        }
        let limit = 0.5 * smallest_turn(&edges)?;
        if !(edge_half_angle > 0.0 && edge_half_angle < limit) {
            return Err(ShapeError::Bulge { half_angle: edge_half_angle, limit });
        }
        for edge in &mut edges {
            edge.start = (edge.normal - edge_half_angle).rem_euclid(TAU);
            edge.bulge = (edge.to - edge.from).length() / (2.0 * edge_half_angle.sin());
        }
        edges.sort_by(|a, b| a.start.total_cmp(&b.start));
        Ok(Self { edges, corner_radius, half_angle: edge_half_angle })
    }
}

/// Smallest turn at a corner, and proof that the turns add up to one round.
fn smallest_turn(edges: &[Edge]) -> Result<f64, ShapeError> {
    let (mut smallest, mut total) = (f64::INFINITY, 0.0);
    for (i, edge) in edges.iter().enumerate() {
        let next = (i + 1) % edges.len();
        let mut turn = (edges[next].normal - edge.normal).rem_euclid(TAU);
        if turn > 0.5 * TAU {
            turn -= TAU;
        }
        if turn <= 0.0 {
            return Err(ShapeError::Corner { corner: next, turn });
        }
        smallest = smallest.min(turn);
        total += turn;
    }
    // Each turn is in (0, pi]; a simple convex polygon turns once, a star polygon more often.
    if total > 1.5 * TAU { Err(ShapeError::Corner { corner: 0, turn: total }) } else { Ok(smallest) }
}

impl RadiusFunction for RoundedPolygon {
    fn jet(&self, theta: f64) -> RadiusJet {
        let theta = theta.rem_euclid(TAU);
        // Last edge whose arc has begun at theta, going round.
        let begun = self.edges.partition_point(|e| e.start <= theta);
        let edge = self.edges[(begun + self.edges.len() - 1) % self.edges.len()];
        let into = (theta - edge.start).rem_euclid(TAU);
        let rounding = RadiusJet { r: self.corner_radius, d: 0.0, rho: self.corner_radius };
        if into > 2.0 * self.half_angle {
            return rounding + point_jet(edge.to, theta);
        }
        // x = from + bulge (n(theta) - n(start)): in the frame at theta that is a rotation by `into`.
        let (sin, cos) = into.sin_cos();
        let arc = RadiusJet { r: edge.bulge * (1.0 - cos), d: -edge.bulge * sin, rho: edge.bulge };
        rounding + arc + point_jet(edge.from, theta)
    }

    fn radius_bounds(&self) -> RadiusBounds {
        let bulge = self.edges.iter().fold(0.0_f64, |m, e| m.max(e.bulge));
        RadiusBounds { min: self.corner_radius, max: self.corner_radius + bulge }
    }
}
