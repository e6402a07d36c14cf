//! Two touches on neighbouring lines of one direction.

use super::lines::Touch;
use crate::Heading;
use crate::contour::Margins;
use glam::DVec3;

/// What lies between two touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Angle between the normals, rad.
    pub(super) turn: f64,
    /// The smaller of both cosines between a normal and the direction.
    pub(super) facing: f64,
    /// How far apart the contacts are, m.
    pub(super) mouth: f64,
    /// Way of the centre, m, as long as it is nowhere steeper than at its ends.
    way: f64,
    /// The same at the mean of both slopes, m.
    chord: f64,
    /// Change of the normal along the way of the centre, negative where it turns inwards: `dn . dc / |dc|`.
    along: f64,
    /// `dn . dx / |dn|^2` of normals and contacts, m: minus the radius of a hollow that both are on, the radius of what bulges, minus the finger's radius for two contacts at once.
    bulge: f64,
    /// By how much the heights differ from what the normals say of the way, over the way.
    step: f64,
    /// Distance of the lines, m.
    length: f64,
    radius: f64,
}

/// Contacts whose normals are farther than 60 degrees from where the finger came from are left to other directions: the centre climbs too steeply between lines.
pub(super) const FACING: f64 = 0.5;
/// Of a way that is longer than the normals say by more than its own length an end is hidden behind the other.
const HIDDEN: f64 = 1.0;
/// What turns by `dn . dx < -q |dn|^2 / 2` turns inwards: a corner that bulges has 0, two contacts of one ball -q, and hollows that are felt less than that.
const INWARDS: f64 = -0.5;

impl Edge {
    /// Between lines that are `length` m apart along the unit vector `axis`, for a finger of radius `q` m.
    pub(super) fn of([from, to]: [Touch; 2], axis: DVec3, length: f64, q: f64) -> Self {
        let a = from.line.along.get();
        let (turned, apart) = (to.normal.get() - from.normal.get(), to.point - from.point);
        let facing = from.facing().min(to.facing());
        // The centre moves across the normal, in the plane of both lines: slope of its way by each normal.
        let slope =
            |t: &Touch| if t.facing() > 0.0 { -t.normal.get().dot(axis) / t.facing() } else { f64::INFINITY };
        let slopes = [slope(&from), slope(&to)];
        let mean = 0.5 * (slopes[0] + slopes[1]);
        let risen = (to.centre(q) - from.centre(q)).dot(a);
        let steepest = slopes.map(f64::abs).into_iter().fold(0.0, f64::max);
        let squared = turned.length_squared();
        Self {
            turn: from.normal.angle_to(to.normal),
            facing,
            mouth: apart.length(),
            way: length * steepest.hypot(1.0),
            chord: length * mean.hypot(1.0),
            along: turned.dot(axis + a * mean) / mean.hypot(1.0),
            bulge: if squared > 0.0 { turned.dot(apart) / squared } else { 0.0 },
            step: (risen - mean * length).abs() / (length * steepest.hypot(1.0)),
            length,
            radius: q,
        }
    }

    /// Whether the surface between is seen along the direction: both ends face it, and none hides behind the other.
    pub(super) fn is_seen(&self, margins: &Margins) -> bool {
        let doubt = 2.0 * margins.of_centre(self.radius) / self.length;
        self.facing >= FACING && self.step <= HIDDEN + doubt
    }

    /// Whether it turns inwards by more than `most` (rad): over the least length, a jump.
    pub(super) fn is_jump(&self, most: f64) -> bool {
        self.turn > most && self.bulge < INWARDS * self.radius
    }

    /// If all of it was felt, the mean radius of curvature along it is no more than this somewhere, m: `q + L / a`. None where normals may differ by noise alone.
    pub(super) fn radius_at_most(&self, doubt: f64) -> Option<f64> {
        (self.turn > doubt).then(|| self.radius + self.way / (self.turn - doubt))
    }

    /// The mean radius of curvature along it of a hollow that was felt, m: `q + L / a`, with what the normal turns along the way. None where it does not turn inwards beyond `doubt` (rad).
    pub(super) fn hollow(&self, doubt: f64) -> Option<f64> {
        let inwards = -self.along - doubt;
        (inwards > 0.0 && self.bulge < 0.0).then(|| self.radius + self.chord / inwards)
    }
}
