//! Outlines in the plane: convex, how large, and whether points lie in them.

use super::surface::Flaw;
use glam::DVec2;
use robust::{Coord, orient2d};

/// A closed polygon, corners counter-clockwise.
#[derive(Clone, Debug, Default)]
pub struct Outline(Vec<DVec2>);

/// Positive where the corners turn left; the sign is exact.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let of = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(of(a), of(b), of(c))
}

impl Outline {
    /// Takes corners, m, counter-clockwise.
    #[must_use]
    pub fn new(corners: Vec<DVec2>) -> Self {
        Self(corners)
    }

    /// The corners, m.
    #[must_use]
    pub fn corners(&self) -> &[DVec2] {
        &self.0
    }

    fn sides(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        self.0.iter().copied().zip(self.0.iter().copied().cycle().skip(1))
    }

    /// Area in m^2, positive for corners counter-clockwise, and length in m.
    #[must_use]
    pub fn size(&self) -> (f64, f64) {
        let about = self.0.first().copied().unwrap_or_default();
        let area = self.sides().map(|(a, b)| (a - about).perp_dot(b - about) / 2.0).sum();
        (area, self.sides().map(|(a, b)| a.distance(b)).sum())
    }

    /// Distance of the farthest corner from the origin, m.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.0.iter().map(|p| p.length()).fold(0.0, f64::max)
    }

    /// Corners that differ by more than `tolerance` (m): arcs and straight sides meet in corners that are written twice.
    fn distinct(&self, tolerance: f64) -> Self {
        let mut corners = self.0.clone();
        corners.dedup_by(|a, b| a.distance(*b) <= tolerance);
        while corners.len() > 1 && corners[0].distance(corners[corners.len() - 1]) <= tolerance {
            corners.pop();
        }
        Self(corners)
    }

    fn middle(&self) -> DVec2 {
        self.0.iter().sum::<DVec2>() / self.0.len() as f64
    }

    /// Why this does not go once round one convex body, but for dents of depth `tolerance` (m).
    #[must_use]
    pub fn not_convex(&self, tolerance: f64) -> Option<Flaw> {
        let distinct = self.distinct(tolerance);
        let (corners, count) = (&distinct.0, distinct.0.len());
        if count < 3 {
            // A sliver that is thinner than that has no dents that are deeper.
            let count = self.distinct(0.0).0.len();
            return (count < 3).then(|| Flaw::NotConvex(format!("it has {count} corner(s) that differ")));
        }
        let depth = |k: usize| {
            let [a, b, c] = [corners[k], corners[(k + 1) % count], corners[(k + 2) % count]];
            if turn(a, b, c) >= 0.0 { 0.0 } else { distance_to_side(a, c, b) }
        };
        let worst = (0..count).map(|k| (depth(k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((depth, k)) = worst.filter(|(depth, _)| *depth > tolerance) {
            let why = format!("it is dented by {depth:.1e} m next to its corner {} of {count}", k + 1);
            return Some(Flaw::NotConvex(why));
        }
        let times = distinct.winding(distinct.middle());
        (times != 1).then(|| Flaw::NotConvex(format!("it goes {times} times round its middle")))
    }

    /// How often the outline goes round a point; decided by exact signs.
    fn winding(&self, p: DVec2) -> i32 {
        let side = |(a, b): (DVec2, DVec2)| match (a.y <= p.y, b.y <= p.y) {
            (true, false) => i32::from(turn(a, b, p) > 0.0),
            (false, true) => -i32::from(turn(a, b, p) < 0.0),
            _ => 0,
        };
        self.sides().map(side).sum()
    }

    /// The point of `points` that is farthest outside of this convex outline by more than `tolerance`, and how far, m;
    /// `None` where all are inside.
    #[must_use]
    pub fn farthest_outside(&self, points: &[DVec2], tolerance: f64) -> Option<(usize, f64)> {
        let Self(corners) = self.distinct(tolerance);
        let (middle, count) = (self.middle(), corners.len());
        let first = *corners.first()?;
        // Turned from the first corner by half a turn or more.
        let far = |q: DVec2| turn(middle, first, q) < 0.0;
        let outside = |p: DVec2| {
            let before = |q: &DVec2| match (far(*q), far(p)) {
                (a, b) if a == b => turn(middle, *q, p) >= 0.0,
                (a, _) => !a,
            };
            let from = corners.partition_point(before) + count - 1;
            let side = |k: usize| (corners[k % count], corners[(k + 1) % count]);
            let (a, b) = side(from);
            if turn(a, b, p) >= 0.0 {
                return 0.0;
            }
            // Of the sides around the one seen from the middle: no less than the distance.
            let near = (from + count - 2..=from + count + 2).map(side);
            near.map(|(a, b)| distance_to_side(a, b, p)).fold(f64::INFINITY, f64::min)
        };
        let all = points.iter().enumerate().map(|(k, p)| (k, outside(*p)));
        all.filter(|(_, distance)| *distance > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

fn distance_to_side(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let (along, reach) = (b - a, p - a);
    let share = (reach.dot(along) / along.length_squared()).clamp(0.0, 1.0);
    // A side of no length is a point.
    if share.is_nan() { reach.length() } else { reach.distance(along * share) }
}
