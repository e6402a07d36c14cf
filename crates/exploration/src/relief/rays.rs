//! What a finger swept.

use super::felt::Relief;
use glam::DVec3;

/// Where the finger's centre was: a ray from where it stopped to where it came from, or a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    /// Unit vector to where it came from.
    along: DVec3,
    /// A point of it; of a ray that where it begins.
    start: DVec3,
    whole: bool,
}

impl Ray {
    /// The place of the ray that is nearest to a point, m.
    pub(super) fn nearest(&self, x: DVec3) -> DVec3 {
        let way = (x - self.start).dot(self.along);
        self.start + self.along * if self.whole { way } else { way.max(0.0) }
    }

    /// Distance to a point, m.
    pub(super) fn distance(&self, x: DVec3) -> f64 {
        self.nearest(x).distance(x)
    }
}

/// All of them. A touch that may be off began no higher than its centre and what that may be off.
pub(super) fn rays(relief: &Relief) -> Vec<Ray> {
    let q = relief.radius;
    let margin = relief.margins().of_centre(q);
    let touched = relief.touches.iter().map(|touch| {
        let (along, centre) = (touch.line.along.get(), touch.centre(q));
        // The line is known: what the centre is off it counts as what its height is off as well.
        let height = centre.dot(along) + margin + touch.line.off(centre).length();
        Ray { along, start: touch.line.at + along * height, whole: false }
    });
    let missed = relief.misses.iter().map(|l| Ray { along: l.along.get(), start: l.at, whole: true });
    touched.chain(missed).collect()
}
