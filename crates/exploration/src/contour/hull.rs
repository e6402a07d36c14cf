//! What is proven of the hull of a body that was followed.

use super::trace::{TraceEnd, Traced};
use glam::DVec2;
use shape_bounds::planar::Direction;

/// Bounds on the hull of a body that was followed once round by a round finger.
///
/// The lower one is the hull of the contacts. The body grown by the finger's disc is what the centre's path goes round, past its start, so that the body's support function is
/// the path's less the radius; between two places the path, whose length is known, is within the ellipse that has them as its foci.
pub struct HullBounds<'a> {
    traced: &'a Traced,
}

impl<'a> HullBounds<'a> {
    /// None of what was not followed to its end.
    #[must_use]
    pub fn of(traced: &'a Traced) -> Option<Self> {
        (traced.end == TraceEnd::Closed).then_some(Self { traced })
    }

    /// Support functions of both along a direction, m: that of the body is between them.
    #[must_use]
    pub fn support(&self, along: Direction) -> (f64, f64) {
        let (u, q) = (along.get(), self.traced.radius);
        let lower = self.traced.touches.iter().map(|t| t.point.dot(u)).fold(f64::NEG_INFINITY, f64::max);
        let centres: Vec<DVec2> = self.traced.touches.iter().map(|t| t.point + t.normal.get() * q).collect();
        let piece = |k: usize| {
            let (from, to) = (centres[k - 1], centres[k]);
            let (middle, half, a) = (0.5 * (from + to), 0.5 * (to - from), 0.5 * self.traced.ways[k]);
            // Support of an ellipse: the root of (a e . u)^2 + (b e' . u)^2 with b^2 = a^2 - |half|^2.
            let minor = (a * a - half.length_squared()).max(0.0);
            middle.dot(u) + (half.dot(u).powi(2) + minor).sqrt()
        };
        let upper = (1..centres.len()).map(piece).fold(f64::NEG_INFINITY, f64::max);
        (lower, upper - q)
    }
}
