//! Circles in which two spheres of one radius meet.

use glam::DVec3;

/// The circle of points at distance `radius` from two centres, with its axis from the first to the second.
#[derive(Clone, Copy)]
pub(super) struct Circle {
    pub(super) middle: DVec3,
    pub(super) axis: DVec3,
    pub(super) radius: f64,
    /// Half the distance of the centres.
    half: f64,
}

impl Circle {
    /// The circle of spheres of radius `rho` about `a` and `b`.
    pub(super) fn between(a: DVec3, b: DVec3, rho: f64) -> Self {
        let along = (b - a) / 2.0;
        let half = along.length();
        Self {
            middle: a + along,
            axis: along / half,
            radius: (rho * rho - half * half).max(0.0).sqrt(),
            half,
        }
    }

    /// The angle from `start` to `end`, right-handed about the axis, from -pi to pi.
    pub(super) fn angle(&self, start: DVec3, end: DVec3) -> f64 {
        let (s, e) = (start - self.middle, end - self.middle);
        // Differences keep the digits of short arcs.
        self.axis.dot(s.cross(end - start)).atan2(s.dot(e))
    }

    /// The point at `angle` from `start`.
    pub(super) fn at(&self, start: DVec3, angle: f64) -> DVec3 {
        let s = start - self.middle;
        self.middle + s * angle.cos() + self.axis.cross(s) * angle.sin()
    }

    /// The angle between the outward normals of the two spheres of radius `rho` along the circle.
    pub(super) fn face_angle(&self, rho: f64) -> f64 {
        2.0 * (self.half / rho).min(1.0).asin()
    }

    /// The largest distance of a point of the circle from `point`.
    pub(super) fn farthest_from(&self, point: DVec3) -> f64 {
        let w = self.middle - point;
        let along = w.dot(self.axis);
        let across = (w - self.axis * along).length();
        along.hypot(across + self.radius)
    }
}
