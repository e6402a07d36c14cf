//! How the scene is looked at: along one direction, obliquely from above.

use glam::{DVec2, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::BodyState;
use std::f64::consts::TAU;

/// Points of an outline.
const POINTS: u32 = 96;
/// Azimuth from which the scene is seen, if none is better, and height of the eye, rad.
const FROM: [f64; 2] = [-0.9, 0.5];
/// Azimuths that are compared.
const AROUND: u32 = 36;

/// A parallel projection.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    right: DVec3,
    up: DVec3,
    towards: DVec3,
}

impl View {
    /// Obliquely from above, onto planes with these normals towards the object: from where the one that is seen most from its edge is least so.
    pub(super) fn onto(normals: &[DVec3]) -> Self {
        let open = |view: &Self| normals.iter().map(|n| n.dot(view.towards).abs()).fold(1.0, f64::min);
        let azimuths = (0..AROUND).map(|k| FROM[0] + TAU * f64::from(k) / f64::from(AROUND));
        let better = |best: Self, next: Self| if open(&next) > open(&best) + 1e-9 { next } else { best };
        azimuths.map(Self::from).fold(Self::from(FROM[0]), better)
    }

    fn from(azimuth: f64) -> Self {
        let [(sin_a, cos_a), (sin_e, cos_e)] = [azimuth, FROM[1]].map(f64::sin_cos);
        let towards = DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
        let right = DVec3::new(-sin_a, cos_a, 0.0);
        Self { right, up: towards.cross(right), towards }
    }

    /// Where a point of the world is seen, upwards, m.
    pub(super) fn place(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.right.dot(p), self.up.dot(p))
    }

    /// How near to the eye a point is, m.
    pub(super) fn nearness(&self, p: DVec3) -> f64 {
        self.towards.dot(p)
    }

    /// A direction on the picture, in the world.
    fn lifted(&self, angle: f64) -> DVec3 {
        angle.cos() * self.right + angle.sin() * self.up
    }

    /// The circle that a ball about `centre` is seen as, from one angle to another.
    pub(super) fn arc(&self, centre: DVec3, radius: f64, [from, to]: [f64; 2]) -> Vec<DVec2> {
        let angle = |k| from + (to - from) * f64::from(k) / f64::from(POINTS);
        (0..=POINTS).map(|k| self.place(centre + radius * self.lifted(angle(k)))).collect()
    }

    /// The outline of a body: the points whose normals are seen from the side.
    pub(super) fn outline<S: SupportFunction>(&self, body: &S, at: &BodyState) -> Vec<DVec2> {
        let angle = |k| TAU * f64::from(k) / f64::from(POINTS);
        (0..=POINTS).map(|k| self.place(surface_point(body, at, self.lifted(angle(k))))).collect()
    }

    /// The three lines on a body on which one coordinate of the normal is zero, where they are seen: they show how it has
    /// turned.
    pub(super) fn meridians<S: SupportFunction>(&self, body: &S, at: &BodyState) -> Vec<Vec<DVec2>> {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| at.R_WO * axis);
        let mut lines = Vec::new();
        for i in 0..3 {
            let mut line = Vec::new();
            for k in 0..=POINTS {
                let (sin, cos) = (TAU * f64::from(k) / f64::from(POINTS)).sin_cos();
                let n = cos * axes[(i + 1) % 3] + sin * axes[(i + 2) % 3];
                if self.nearness(n) >= 0.0 {
                    line.push(self.place(surface_point(body, at, n)));
                } else if !line.is_empty() {
                    lines.push(std::mem::take(&mut line));
                }
            }
            lines.push(line);
        }
        lines.retain(|line| line.len() > 1);
        lines
    }
}

/// The point of a body with the world's direction `n` as its normal.
fn surface_point<S: SupportFunction>(body: &S, at: &BodyState, n: DVec3) -> DVec3 {
    at.p_WCm + at.R_WO * body.point(Direction::new_unchecked((at.R_WO.inverse() * n).normalize()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use recon::contact_kinematics::Ellipsoid;

    /// Three planes as wide open as three walls of a corner: from nowhere is one of them seen from its edge.
    #[test]
    fn planes_are_not_seen_from_their_edges() {
        let normal = |azimuth: f64| DVec3::new(azimuth.cos(), azimuth.sin(), 1.0).normalize();
        for turn in [0.0, 0.3, 1.1] {
            let normals = [0.0, TAU / 3.0, -TAU / 3.0].map(|azimuth| normal(azimuth + turn));
            let view = View::onto(&normals);
            assert!(normals.iter().all(|n| n.dot(view.towards).abs() > 0.25), "{turn}");
        }
        assert_eq!(View::onto(&[DVec3::Z]).towards, View::onto(&[]).towards);
    }

    #[test]
    fn the_outline_of_an_ellipsoid_is_its_shadow() {
        let body = Ellipsoid::new(DVec3::new(0.05, 0.04, 0.03)).unwrap();
        let R_WO = DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7));
        let at = BodyState { p_WCm: DVec3::new(0.1, 0.2, 0.3), R_WO, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
        let view = View::onto(&[]);
        assert!(view.right.cross(view.up).distance(view.towards) < 1e-15);
        let outline = view.outline(&body, &at);
        // Every point of the body is seen inside of it, and the farthest in each direction on it.
        for k in 0..400 {
            let n = DVec3::new(
                (1.0 + f64::from(k)).sin(),
                (2.3 * f64::from(k)).cos(),
                (0.7 * f64::from(k)).sin(),
            );
            let seen = view.place(surface_point(&body, &at, n.normalize()));
            for angle in [0.0_f64, 1.0, 2.0, 3.0, 4.0, 5.0] {
                let u = DVec2::from_angle(angle);
                let most = outline.iter().map(|p| u.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
                // An outline of 96 points lies inside the true one by up to 1 - cos(pi / 96) of its size.
                assert!(u.dot(seen) <= most + 0.05 * 6e-4, "{angle}");
            }
        }
    }
}
