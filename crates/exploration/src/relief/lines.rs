//! Lines on which a finger comes up to a body, and what it meets.

use contact_kinematics::Direction;
use glam::DVec3;

/// A straight line on which the centre of a round finger comes from far away, against `along`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// From the body to where the finger comes from.
    pub along: Direction,
    /// Where the line crosses the plane through the origin across it, m.
    pub at: DVec3,
}

impl Line {
    /// How far a point is off the line: the vector across it, m.
    #[must_use]
    pub fn off(&self, x: DVec3) -> DVec3 {
        let arm = x - self.at;
        let a = self.along.get();
        arm - a * arm.dot(a)
    }
}

/// The first contact on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// On which the finger came.
    pub line: Line,
    /// In m.
    pub point: DVec3,
    /// Outward normal of the body.
    pub normal: Direction,
}

impl Touch {
    /// Where the centre of a finger of radius `q` m was by point and normal, m: on the line, but for what these are off.
    #[must_use]
    pub fn centre(&self, q: f64) -> DVec3 {
        self.point + self.normal.get() * q
    }

    /// Cosine of the angle between the normal and where the finger came from.
    #[must_use]
    pub fn facing(&self) -> f64 {
        self.normal.get().dot(self.line.along.get())
    }
}

/// A round finger that is moved on straight lines.
pub trait ProbingFinger {
    /// Why it cannot go on.
    type Error;

    /// Its radius, m.
    fn radius(&self) -> f64;

    /// Comes from far away down the line and stops at the first contact; none where it passes.
    ///
    /// # Errors
    /// Those of the finger.
    fn approach(&mut self, line: &Line) -> Result<Option<Touch>, Self::Error>;
}
