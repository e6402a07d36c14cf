use super::Direction;
use glam::DVec2;

/// The half-plane `{ y : normal . (y - point) <= margin }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// A point of the line when the margin is zero, in m.
    pub point: DVec2,
    /// Outward unit normal.
    pub normal: Direction,
    /// How far the line is moved outwards, in m.
    pub margin: f64,
}

impl HalfPlane {
    /// Signed distance of `y` beyond the line, in m; at most zero inside.
    #[must_use]
    #[inline]
    pub fn excess(&self, y: DVec2) -> f64 {
        self.normal.get().dot(y - self.point) - self.margin
    }
}
