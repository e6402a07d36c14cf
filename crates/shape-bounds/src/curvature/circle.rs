//! Circles in which two spheres of one radius meet, and where a third ball cuts them.

use glam::DVec3;
use std::f64::consts::TAU;

/// The circle of points at distance `radius` from two centres, with its axis from the first to the second.
#[derive(Clone, Copy)]
pub(super) struct Circle {
    pub(super) middle: DVec3,
    pub(super) axis: DVec3,
    pub(super) radius: f64,
    /// Square of half the distance of the centres.
    half_squared: f64,
}

/// How a ball treats an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cut {
    /// All of the arc is in the ball.
    Kept,
    /// None of the arc is in the ball.
    Gone,
    /// The arc leaves the ball here and ends outside.
    Leaves(DVec3),
    /// The arc begins outside and enters here.
    Enters(DVec3),
    /// The arc leaves and comes back.
    Interrupted(DVec3, DVec3),
    /// The arc comes in and leaves again.
    Visits(DVec3, DVec3),
}

impl Cut {
    /// The same for the arc in the opposite sense.
    pub(super) fn reversed(self) -> Self {
        match self {
            Self::Leaves(p) => Self::Enters(p),
            Self::Enters(p) => Self::Leaves(p),
            Self::Interrupted(p, q) => Self::Interrupted(q, p),
            Self::Visits(p, q) => Self::Visits(q, p),
            same => same,
        }
    }
}

impl Circle {
    /// The circle of spheres of radius `rho` about `a` and `b`.
    pub(super) fn between(a: DVec3, b: DVec3, rho: f64) -> Self {
        let half = (b - a) / 2.0;
        let half_squared = half.length_squared();
        Self {
            middle: a + half,
            axis: half / half_squared.sqrt(),
            radius: (rho * rho - half_squared).max(0.0).sqrt(),
            half_squared,
        }
    }

    /// The angle from `start` to `end`, right-handed about the axis, in (0, tau]; tau if they coincide.
    pub(super) fn angle(&self, start: DVec3, end: DVec3) -> f64 {
        let (s, e) = (start - self.middle, end - self.middle);
        // Differences keep the digits of short arcs.
        let sine = self.axis.dot(s.cross(end - start));
        let angle = sine.atan2(s.dot(e));
        if angle <= 0.0 { angle + TAU } else { angle }
    }

    /// The point at `angle` from `start`.
    pub(super) fn at(&self, start: DVec3, angle: f64) -> DVec3 {
        let s = start - self.middle;
        self.middle + s * angle.cos() + self.axis.cross(s) * angle.sin()
    }

    /// Cuts the arc from `start` to `end` (right-handed) with the ball of the same `rho` about `centre`; `outside` tells
    /// for a point whether it is beyond the ball, and decides for the ends.
    pub(super) fn cut(
        &self,
        start: DVec3,
        end: DVec3,
        centre: DVec3,
        outside: impl Fn(DVec3) -> bool,
    ) -> Cut {
        let (first_out, last_out) = (outside(start), outside(end));
        let whole = |out| if out { Cut::Gone } else { Cut::Kept };
        let w = self.middle - centre;
        let across = w - self.axis * w.dot(self.axis);
        let reach = 2.0 * self.radius * across.length();
        // On the circle, |y - centre|^2 - rho^2 = |w|^2 - half^2 + reach cos(phi).
        let cosine = (self.half_squared - w.length_squared()) / reach;
        // Not a number where the third centre is on the axis.
        let crosses = cosine.abs() < 1.0;
        if !crosses {
            return match (first_out, last_out) {
                (false, true) => Cut::Leaves(end),
                (true, false) => Cut::Enters(start),
                (out, _) => whole(out),
            };
        }
        let far = across.normalize() * self.radius;
        if !first_out && !last_out && !self.passes(start, end, far) {
            return Cut::Kept;
        }
        let side = self.axis.cross(far) * (1.0 - cosine * cosine).sqrt();
        let (entry, exit) = (self.middle + far * cosine + side, self.middle + far * cosine - side);
        // Right-handed, the circle is outside from `exit` over `far` to `entry`.
        match (first_out, last_out) {
            (false, true) => Cut::Leaves(exit),
            (true, false) => Cut::Enters(entry),
            (false, false) => Cut::Interrupted(exit, entry),
            (true, true) if self.passes(start, end, -far) => Cut::Visits(entry, exit),
            (out, _) => whole(out),
        }
    }

    /// Whether the arc from `start` to `end` (right-handed, all around if they coincide) passes the direction `d` from the
    /// middle.
    fn passes(&self, start: DVec3, end: DVec3, d: DVec3) -> bool {
        if start == end {
            return true;
        }
        let (s, e) = (start - self.middle, end - self.middle);
        let left_of = |p: DVec3, q: DVec3| self.axis.dot(p.cross(q)) > 0.0;
        let (after_start, before_end) = (left_of(s, d), left_of(d, e));
        // The difference of the ends keeps the sense of short arcs.
        if self.axis.dot(s.cross(end - start)) > 0.0 {
            after_start && before_end
        } else {
            after_start || before_end
        }
    }
}
