use super::arc;
use crate::planar::distance::on_segment;
use exact_hull::planar::{Direction, Hull, PointsError};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The hull of discs of equal radius: the hull of their centres, grown by the radius.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedHull {
    core: Hull,
    corners: Vec<DVec2>,
    radius: f64,
}

impl RoundedHull {
    /// The hull of discs of the given radius (m) about `centres`.
    ///
    /// # Errors
    /// Those of [`Hull::of`].
    pub fn of(centres: &[DVec2], radius: f64) -> Result<Self, PointsError> {
        let core = Hull::of(centres)?;
        let corners = core.corner_points(centres);
        Ok(Self { core, corners, radius })
    }

    /// The hull of the centres.
    #[must_use]
    pub fn core(&self) -> &Hull {
        &self.core
    }

    /// Its corners, counter-clockwise.
    pub(super) fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// Radius of the discs in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Length of the core's outline; a segment has two sides.
    fn core_perimeter(&self) -> f64 {
        match self.corners[..] {
            [_] => 0.0,
            [a, b] => 2.0 * a.distance(b),
            _ => self.core.polygon().map_or(0.0, |polygon| polygon.shape().perimeter()),
        }
    }

    /// Area in m^2, exact by Steiner's formula `A + L rho + pi rho^2`.
    #[must_use]
    pub fn area(&self) -> f64 {
        let core = self.core.polygon().map_or(0.0, |polygon| polygon.shape().area());
        core + self.core_perimeter() * self.radius + PI * self.radius * self.radius
    }

    /// Length of the outline in m: `L + 2 pi rho`.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        self.core_perimeter() + 2.0 * PI * self.radius
    }

    /// Support function in direction `n`, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> f64 {
        self.corners.iter().map(|v| v.dot(n.get())).fold(f64::NEG_INFINITY, f64::max) + self.radius
    }

    /// Points on the outline, counter-clockwise, at most `step` rad (at least a thousandth) of turning apart.
    #[must_use]
    pub fn outline(&self, step: f64) -> Vec<DVec2> {
        let count = self.corners.len();
        let edge = |k: usize| self.corners[(k + 1) % count] - self.corners[k % count];
        let mut points = Vec::new();
        for (k, corner) in self.corners.iter().enumerate() {
            // Outward normals of the edges before and after the corner; about a single one, all round.
            let (from, angle) = if count == 1 {
                (0.0, TAU)
            } else {
                let (before, after) = (edge(k + count - 1), edge(k));
                let angle = before.angle_to(after);
                // Half a turn at the end of a segment has either sign, and next to none may be rounded below zero.
                let angle = if angle < -FRAC_PI_2 { angle + TAU } else { angle.max(0.0) };
                ((-before.perp()).to_angle(), angle)
            };
            points.extend(arc(from, angle, step).map(|u| *corner + u * self.radius));
        }
        points
    }

    /// Whether the point is inside, but for rounding.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        let count = self.corners.len();
        let near = |k: usize| {
            let (a, b) = (self.corners[k], self.corners[(k + 1) % count]);
            on_segment(a, b, point).distance(point) <= self.radius
        };
        self.core.polygon().is_some_and(|p| p.shape().contains(point)) || (0..count).any(near)
    }
}
