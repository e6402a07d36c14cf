use glam::DVec3;
use unit_direction::Direction;

/// The half-space `{ y : normal . (y - point) <= margin }`.
///
/// Point and margin are kept apart, rather than summed to one offset, because neighbouring half-spaces of a dense curve
/// differ by less than the rounding of such a sum.
///
/// One to a cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct HalfSpace {
    /// A point of the plane when the margin is zero, in m.
    pub point: DVec3,
    /// Outward unit normal.
    pub normal: Direction,
    /// How far the plane is moved outwards, in m.
    pub margin: f64,
}

impl HalfSpace {
    /// Signed distance of `y` beyond the plane, in m; at most zero inside.
    #[must_use]
    #[inline]
    pub fn excess(&self, y: DVec3) -> f64 {
        self.normal.get().dot(y - self.point) - self.margin
    }

    /// The half-space with its plane `outwards` (m) further out.
    #[must_use]
    #[inline]
    pub fn moved(&self, outwards: f64) -> Self {
        Self { margin: self.margin + outwards, ..*self }
    }
}
