//! Where a body is between the palms, and how it rolls.

use super::workspace::ParallelWorkspace;
use contact_kinematics::Direction;
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::FRAC_1_SQRT_2;

/// A body as the two contacts know it.
pub(super) trait Held {
    /// The farthest point along an outward normal, body axes, m.
    fn farthest(&self, along: Direction) -> DVec3;

    /// Ratio of tangential to normal force at both contacts when squeezed along `along`: `|grad w| / w`.
    fn shear(&self, along: Direction) -> f64 {
        let (d, u) = (self.farthest(along) - self.farthest(-along), along.get());
        let width = d.dot(u);
        // What has no width is held by nothing.
        if width > 0.0 { (d - u * width).length() / width } else { f64::INFINITY }
    }
}

/// Where shear stopped a stroke: what was learned of the body's slopes beyond its contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Normal at the upper contact, body axes.
    pub at: Direction,
    /// Unit vector along which it went on, body axes.
    pub along: DVec3,
}

/// A wall is felt within so many rad of where it was met, and by strokes that lean by less than 45 degrees from the one that met it.
const NEAR: f64 = 0.15;
const ALIKE: f64 = FRAC_1_SQRT_2;

impl Wall {
    /// Whether a stroke along `heading` from `hold` goes on into it.
    pub(super) fn stops(&self, hold: &Hold, heading: DVec2) -> bool {
        self.is_met(hold.normals()[0].get(), hold.onwards(heading), [NEAR, ALIKE])
    }

    /// Whether it is met by going along a unit vector from a normal at the upper contact, both in body axes, if it is felt within `near` rad and by strokes
    /// that lean by less than the angle with the cosine `alike`. Squeezed from either side a body is the same.
    pub(super) fn is_met(&self, up: DVec3, along: DVec3, [near, alike]: [f64; 2]) -> bool {
        let side = self.at.get().dot(up).signum();
        (self.at.get() * side - up).length() < near && self.along.dot(along) * side > alike
    }
}

/// Orientation of a body, and where on the pads it is touched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Turns axes of the body into those of the world.
    pub R_WO: DQuat,
    /// The contact on the upper and on the lower pad, from the middle of each, world axes, m.
    pub pads: [DVec2; 2],
}

/// A straight motion of the upper palm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// World direction along which the upper palm moves, from world X, rad.
    pub heading: f64,
    /// By how much that turns the body, rad.
    pub turn: f64,
}

/// Why palms stop before a stroke is through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// A little farther and the contacts slip.
    Shear,
    /// A contact is at the edge of a pad.
    Pad,
}

impl Hold {
    /// Outward normals at the upper and the lower contact, body axes.
    #[must_use]
    pub fn normals(&self) -> [Direction; 2] {
        let up = Direction::new(self.R_WO.inverse() * DVec3::Z).unwrap_or(Direction::Z);
        [up, -up]
    }

    /// The unit vector along which the normal at the upper contact goes while the upper palm moves along `heading`, body axes.
    pub(super) fn onwards(&self, heading: DVec2) -> DVec3 {
        -(self.R_WO.inverse() * heading.extend(0.0))
    }

    /// After a turn by `turn` rad while the upper palm moves along `heading`, and how far that moved (m).
    ///
    /// The arcs that are rolled over are the changes of the contact points, turned into the world at the mean of both orientations: what is left
    /// out is of third order in the turn.
    pub(super) fn rolled(&self, body: &impl Held, heading: DVec2, turn: f64) -> (Self, f64) {
        self.turned(body, DVec3::new(-heading.y, heading.x, 0.0), turn)
    }

    /// After a turn by `turn` rad about the line through both contacts: pads that give a little let that happen.
    pub(super) fn spun(&self, body: &impl Held, turn: f64) -> Self {
        self.turned(body, self.span(body).normalize_or(DVec3::Z), turn).0
    }

    /// From the lower contact to the upper one, world axes, m.
    pub(super) fn span(&self, body: &impl Held) -> DVec3 {
        let [up, down] = self.normals();
        self.R_WO * (body.farthest(up) - body.farthest(down))
    }

    /// After a turn about `axis` without slip, and how far the upper palm went with it, m.
    fn turned(&self, body: &impl Held, axis: DVec3, turn: f64) -> (Self, f64) {
        let R_WO = (DQuat::from_axis_angle(axis, turn) * self.R_WO).normalize();
        let half = (DQuat::from_axis_angle(axis, 0.5 * turn) * self.R_WO).normalize();
        let next = Self { R_WO, pads: self.pads };
        let (old, new) = (self.normals(), next.normals());
        let points = |normals: [Direction; 2]| normals.map(|n| body.farthest(n));
        let (from, to) = (points(old), points(new));
        let arc = |k: usize| (half * (to[k] - from[k])).truncate();
        let span = |R: DQuat, points: [DVec3; 2]| (R * (points[0] - points[1])).truncate();
        let pads = [self.pads[0] + arc(0), self.pads[1] + arc(1)];
        // The lower contact, the span and the upper one again: where the upper palm is.
        let moved = arc(1) + span(R_WO, to) - span(self.R_WO, from) - arc(0);
        (Self { R_WO, pads }, moved.length())
    }

    /// How far the farther contact is from the middle of its pad, m.
    fn reach(&self) -> f64 {
        self.pads[0].length().max(self.pads[1].length())
    }

    /// After a step of a stroke, and how far the upper palm moved (m), unless palms stop before it.
    ///
    /// What is held too little, or is off its pad, may be rolled to where that is better.
    pub(super) fn stepped(
        &self,
        body: &impl Held,
        workspace: &ParallelWorkspace,
        heading: DVec2,
        turn: f64,
    ) -> Result<(Self, f64), Stop> {
        let (next, way) = self.rolled(body, heading, turn);
        if next.reach() > workspace.pad.max(self.reach()) {
            return Err(Stop::Pad);
        }
        let shear = body.shear(next.normals()[0]);
        if shear > workspace.most_shear() && shear > body.shear(self.normals()[0]) {
            return Err(Stop::Shear);
        }
        Ok((next, way))
    }
}

/// Steps of a turn, no larger than `step` rad, all alike.
pub(super) fn steps(turn: f64, step: f64) -> (usize, f64) {
    let parts = (turn.abs() / step).ceil().max(1.0);
    (parts as usize, turn / parts)
}
