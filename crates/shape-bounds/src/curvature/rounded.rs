//! The hull of equal balls: hull of the centres plus a ball.

use super::steiner::ConvexMeasures;
use crate::body::{Climb, ConvexBody};
use crate::distance::{farthest_of, nearest};
use contact_kinematics::Direction;
use exact_hull::arithmetic::{Compensated, cross_of_differences};
use exact_hull::{Hull, PointsError, SolidHull, SupportWalk};
use glam::DVec3;
use std::f64::consts::PI;

/// The convex hull of balls of one radius: all points within that distance of the hull of the centres.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedHull {
    core: Hull,
    /// Corners of the core.
    corners: Vec<DVec3>,
    radius: f64,
}

impl RoundedHull {
    /// The hull of balls of `radius` (at least zero) about `centres`.
    ///
    /// # Errors
    /// Those of [`Hull::of`].
    pub fn of(centres: &[DVec3], radius: f64) -> Result<Self, PointsError> {
        let core = Hull::of(centres)?;
        let corners = core.corner_points(centres);
        Ok(Self { core, corners, radius })
    }

    /// Hull of the centres.
    #[must_use]
    pub fn core(&self) -> &Hull {
        &self.core
    }

    /// Radius of the balls, in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Volume, area and mean curvature by Steiner's formula, exact to rounding.
    #[must_use]
    pub fn measures(&self) -> ConvexMeasures {
        self.core_measures().grown(self.radius)
    }

    /// Volume in m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.measures().volume
    }

    /// Surface area in m^2.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.measures().area
    }

    /// The corner of the core farthest along a direction.
    pub(super) fn core_support(&self) -> impl FnMut(DVec3) -> DVec3 + '_ {
        let mut walk = self.core.solid().map(SupportWalk::new);
        move |d| match &mut walk {
            Some(walk) => walk.farthest(d),
            None => farthest_of(&self.corners, d),
        }
    }

    fn core_measures(&self) -> ConvexMeasures {
        let c = &self.corners;
        match &self.core {
            Hull::Point(_) => ConvexMeasures::default(),
            // An edge by itself has normals all around; the rim of a plate, half around.
            Hull::Segment(_) => {
                ConvexMeasures { mean_curvature: PI * c[0].distance(c[1]), ..ConvexMeasures::default() }
            }
            Hull::Polygon(_) => {
                let rim: f64 = (0..c.len()).map(|k| c[k].distance(c[(k + 1) % c.len()])).sum();
                let twice: DVec3 = c.windows(2).skip(1).map(|e| (e[0] - c[0]).cross(e[1] - c[0])).sum();
                ConvexMeasures { volume: 0.0, area: twice.length(), mean_curvature: 0.5 * PI * rim }
            }
            Hull::Solid(solid) => {
                let moments = solid.moments();
                let mean_curvature = 0.5 * edge_angles(solid);
                ConvexMeasures { volume: moments.volume, area: moments.area, mean_curvature }
            }
        }
    }
}

impl ConvexBody for RoundedHull {
    fn climb(&self) -> Climb<'_> {
        let mut farthest = self.core_support();
        Box::new(move |d| farthest(d) + d.normalize_or_zero() * self.radius)
    }

    /// Support function in m.
    fn support(&self, n: Direction) -> f64 {
        self.corners.iter().map(|c| c.dot(n.get())).fold(f64::NEG_INFINITY, f64::max) + self.radius
    }

    /// Whether `point` is inside; one outside by a few units of rounding may be admitted.
    fn contains(&self, point: DVec3) -> bool {
        let found = nearest(point, &self.corners[..1], self.core_support());
        let rounding = 4.0 * f64::EPSILON * (point.abs().max_element() + self.radius);
        found.certified <= self.radius + rounding
    }
}

/// Sum over the edges of length times exterior angle.
fn edge_angles(hull: &SolidHull) -> f64 {
    // Centres that coincide or are collinear but for rounding make facets that are as thin as that.
    let normals: Vec<DVec3> = (0..hull.triangles().len())
        .map(|f| {
            let [a, b, c] = hull.corners(f);
            cross_of_differences(a, b, c)
        })
        .collect();
    let mut sum = Compensated::default();
    for (f, neighbours) in hull.neighbours().iter().enumerate() {
        let corners = hull.corners(f);
        for (e, g) in neighbours.iter().enumerate() {
            if f < *g as usize {
                let edge = corners[(e + 1) % 3] - corners[e];
                let (own, other) = (normals[f].normalize_or_zero(), normals[*g as usize].normalize_or_zero());
                // The angle by both sine and cosine keeps its digits at nearly flat and nearly folded edges.
                let angle = own.cross(other).length().atan2(own.dot(other));
                sum.add(edge.length() * angle);
            }
        }
    }
    sum.value()
}
