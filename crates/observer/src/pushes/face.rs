//! The outline as what a finger feels: of a smooth one the normal turns along each short edge of the line that stands for it.

use glam::DVec2;
use object_dynamics::pushing::{ClosedLine, Nearest};

/// An outline with its normals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face<'a> {
    pub(super) line: &'a ClosedLine,
    /// Whether its corners are those of the object.
    pub(super) has_corners: bool,
}

impl Face<'_> {
    /// The nearest point, with the normal of the object rather than of the line.
    pub(super) fn nearest(&self, to: DVec2) -> Nearest {
        let near = self.line.nearest(to);
        if self.has_corners { near } else { Nearest { normal: self.normal(&near), ..near } }
    }

    /// The normal on the edge of a nearest point of this or of a line close by.
    pub(super) fn normal(&self, near: &Nearest) -> DVec2 {
        let corners = self.line.corners();
        let (n, k) = (corners.len(), near.edge);
        let across =
            |from: usize, to: usize| -(corners[to % n] - corners[from % n]).perp().normalize_or_zero();
        if self.has_corners {
            return across(k, k + 1);
        }
        // At a corner the normal is across the way from the one before to the one after.
        across(k + n - 1, k + 1).lerp(across(k, k + 2), near.along).normalize_or_zero()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normal_of_a_smooth_outline_turns_evenly() {
        let circle = (0..24).map(|k| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / 24.0));
        let line = ClosedLine::new(circle.collect()).unwrap();
        let face = Face { line: &line, has_corners: false };
        for k in 0..100 {
            let direction = DVec2::from_angle(0.0628 * f64::from(k));
            let off = face.nearest(direction).normal.angle_to(direction).abs();
            // Along an edge of 15 degrees the line's own normal is off by up to 7.5.
            assert!(off.to_degrees() < 0.1, "{off}");
        }
    }
}
