//! Convex hulls in space, decided by exact predicates.

mod build;
mod certificate;
mod error;
mod facets;
mod farthest;
mod incremental;
mod locate;
mod order;
mod seed;
mod solid;
#[cfg(test)]
mod tests;
mod walk;

pub use certificate::HullCertificate;
pub use error::PointsError;
pub(crate) use facets::MOST_POINTS;
pub use farthest::Farthest;
pub use incremental::IncrementalHull;
pub use order::insertion_order;
pub use solid::SolidHull;
pub use walk::SupportWalk;

use crate::planar::convex_corners;
use crate::predicates::drop_axis;
use crate::scaled::ScaledPoints;
use build::{Built, build};
use glam::{DVec2, DVec3};

/// The convex hull of a set of points, by the dimension that the points span.
///
/// The dimension is exact: three points are a [`Hull::Segment`] only if they are collinear to the last bit. Points that
/// were meant to be coplanar but are rounded span a very thin [`Hull::Solid`].
#[derive(Clone, Debug, PartialEq)]
pub enum Hull {
    /// All points coincide: the index of one of them.
    Point(usize),
    /// All points are on a line: the indices of its ends.
    Segment([usize; 2]),
    /// All points are in a plane: the indices of the polygon's strict corners, in order around it.
    Polygon(Vec<usize>),
    /// The points span space.
    Solid(SolidHull),
}

impl Hull {
    /// The hull of `points`, in expected time O(n log n).
    ///
    /// Incremental insertion in biased random rounds along a Hilbert curve, with exact signs behind a floating-point
    /// filter. The result does not depend on chance: the random order is a fixed function of the indices.
    ///
    /// # Errors
    /// [`PointsError`] for no points, more than 2^31 - 3 points, a coordinate that is not finite, and coordinates
    /// whose sizes differ by more than 2^630.
    pub fn of(points: &[DVec3]) -> Result<Self, PointsError> {
        let limit = MOST_POINTS;
        if points.is_empty() {
            return Err(PointsError::Empty);
        }
        if points.len() > limit {
            return Err(PointsError::TooMany { count: points.len(), limit });
        }
        let given = ScaledPoints::for_planes(points)?;
        let working = &*given.scaled();
        Ok(match build(working) {
            Built::Point(i) => Self::Point(i),
            Built::Line => Self::Segment(line_ends(working)),
            Built::Plane { axis } => {
                let flat: Vec<DVec2> = working.iter().map(|p| drop_axis(*p, axis)).collect();
                Self::Polygon(convex_corners(&flat).into_iter().map(|i| i as usize).collect())
            }
            Built::Space(builder, sources) => {
                Self::Solid(SolidHull::from_builder(&builder, &sources, given.scale()))
            }
        })
    }

    /// The hull if it has a volume.
    #[must_use]
    pub fn solid(&self) -> Option<&SolidHull> {
        match self {
            Self::Solid(solid) => Some(solid),
            _ => None,
        }
    }

    /// The hull itself if it has a volume.
    #[must_use]
    pub fn into_solid(self) -> Option<SolidHull> {
        match self {
            Self::Solid(solid) => Some(solid),
            _ => None,
        }
    }

    /// The corners of the hull of `points`, in order around a polygon.
    #[must_use]
    pub fn corner_points(&self, points: &[DVec3]) -> Vec<DVec3> {
        match self {
            Self::Point(i) => vec![points[*i]],
            Self::Segment(ends) => ends.iter().map(|i| points[*i]).collect(),
            Self::Polygon(corners) => corners.iter().map(|i| points[*i]).collect(),
            Self::Solid(solid) => solid.vertices().to_vec(),
        }
    }

    /// Dimension of the hull, 0 to 3.
    #[must_use]
    pub fn dimension(&self) -> usize {
        match self {
            Self::Point(_) => 0,
            Self::Segment(_) => 1,
            Self::Polygon(_) => 2,
            Self::Solid(_) => 3,
        }
    }
}

/// Ends of collinear points: along a line, the lexicographic order is the order on the line.
fn line_ends(points: &[DVec3]) -> [usize; 2] {
    let less = |i: usize, j: usize| {
        let (p, q) = (points[i], points[j]);
        (p.x, p.y, p.z) < (q.x, q.y, q.z)
    };
    (0..points.len()).fold([0, 0], |[low, high], i| {
        [if less(i, low) { i } else { low }, if less(high, i) { i } else { high }]
    })
}
