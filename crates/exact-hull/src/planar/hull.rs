//! Convex hulls in the plane, decided by exact predicates.

use super::ConvexPolygon;
use super::chain::convex_corners;
use crate::predicates::turn;
use crate::scaled::{PlaneRange, scale_in_plane};
use glam::DVec2;
use thiserror::Error;

/// Why a set of points has no hull.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PointsError {
    /// No points at all.
    #[error("no points: a hull needs at least one")]
    Empty,
    /// More points than a 32-bit index holds.
    #[error("{count} points: a hull holds at most {limit}; thin the samples out")]
    TooMany {
        /// Points given.
        count: usize,
        /// Points that are possible.
        limit: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("point {index} ({}, {}) has a coordinate that is not finite", point.x, point.y)]
    NotFinite {
        /// Which point.
        index: usize,
        /// The point as given.
        point: DVec2,
    },
    /// Coordinates of such different sizes that their products leave the range of `f64`, where no answer is exact.
    #[error("coordinates from {smallest:e} to {largest:e} in one set: set the tiny ones to zero")]
    DynamicRange {
        /// Smallest non-zero size of a coordinate.
        smallest: f64,
        /// Largest size of a coordinate.
        largest: f64,
    },
}

/// The convex hull of a set of points, by the dimension that the points span; exact, as in space.
#[derive(Clone, Debug, PartialEq)]
pub enum Hull {
    /// All points coincide: the index of one of them.
    Point(usize),
    /// All points are on a line: the indices of its ends.
    Segment([usize; 2]),
    /// The points span the plane.
    Polygon(HullPolygon),
}

/// A hull with an interior.
#[derive(Clone, Debug, PartialEq)]
pub struct HullPolygon {
    shape: ConvexPolygon,
    sources: Vec<u32>,
}

impl HullPolygon {
    /// The polygon.
    #[must_use]
    pub fn shape(&self) -> &ConvexPolygon {
        &self.shape
    }

    /// For each corner, the index of the point it is.
    #[must_use]
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }
}

impl Hull {
    /// The hull of `points` in time O(n log n), by Andrew's monotone chain with exact signs; only strict corners are kept.
    ///
    /// # Errors
    /// [`PointsError`] for no points, more than 2^32 - 2 of them, a coordinate that is not finite, and coordinates whose
    /// sizes differ by more than 2^960.
    pub fn of(points: &[DVec2]) -> Result<Self, PointsError> {
        let scale = check(points)?;
        let scaled: Vec<DVec2> = points.iter().map(|p| *p * scale).collect();
        let corners = convex_corners(&scaled);
        Ok(match corners[..] {
            [i] => Self::Point(i as usize),
            [i, j] => Self::Segment([i as usize, j as usize]),
            _ => {
                let shape = ConvexPolygon::new(corners.iter().map(|i| points[*i as usize]).collect());
                Self::Polygon(HullPolygon { shape, sources: corners })
            }
        })
    }

    /// The hull if it has an area.
    #[must_use]
    pub fn polygon(&self) -> Option<&HullPolygon> {
        match self {
            Self::Polygon(polygon) => Some(polygon),
            _ => None,
        }
    }

    /// Dimension of the hull, 0 to 2.
    #[must_use]
    pub fn dimension(&self) -> usize {
        match self {
            Self::Point(_) => 0,
            Self::Segment(_) => 1,
            Self::Polygon(_) => 2,
        }
    }

    /// Which points are the corners, counter-clockwise.
    #[must_use]
    pub fn corners(&self) -> Vec<usize> {
        match self {
            Self::Point(i) => vec![*i],
            Self::Segment(ends) => ends.to_vec(),
            Self::Polygon(polygon) => polygon.sources().iter().map(|i| *i as usize).collect(),
        }
    }

    /// The corners of the hull of `points`, counter-clockwise.
    #[must_use]
    pub fn corner_points(&self, points: &[DVec2]) -> Vec<DVec2> {
        self.corners().into_iter().map(|i| points[i]).collect()
    }
}

/// The power of two that brings the points into the range where the predicates are exact; 1 for all ordinary data.
fn check(points: &[DVec2]) -> Result<f64, PointsError> {
    let limit = u32::MAX as usize - 1;
    if points.is_empty() {
        return Err(PointsError::Empty);
    }
    if points.len() > limit {
        return Err(PointsError::TooMany { count: points.len(), limit });
    }
    scale_in_plane(points).map_err(|reason| match reason {
        PlaneRange::NotFinite(index) => PointsError::NotFinite { index, point: points[index] },
        PlaneRange::TooWide { smallest, largest } => PointsError::DynamicRange { smallest, largest },
    })
}

/// A hull that takes one point at a time: O(log n) for a point inside, and a copy of the corners for one outside.
#[derive(Clone, Debug, Default)]
pub struct IncrementalHull {
    points: Vec<DVec2>,
    /// Strict corners counter-clockwise: all of them, or fewer than three while the points span no plane.
    corners: Vec<u32>,
}

impl IncrementalHull {
    /// The hull of no points.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a point; whether the hull has changed.
    ///
    /// # Errors
    /// [`PointsError`] for a coordinate that is not finite or out of the range of the exact predicates (2^-480 to
    /// 2^480); the point is then not taken.
    pub fn insert(&mut self, point: DVec2) -> Result<bool, PointsError> {
        self.check(point)?;
        let index = self.points.len();
        self.points.push(point);
        if self.corners.len() < 3 {
            let candidates: Vec<u32> = self.corners.iter().copied().chain([index as u32]).collect();
            let places: Vec<DVec2> = candidates.iter().map(|i| self.points[*i as usize]).collect();
            let next: Vec<u32> =
                convex_corners(&places).into_iter().map(|k| candidates[k as usize]).collect();
            let changed = next != self.corners;
            self.corners = next;
            return Ok(changed);
        }
        Ok(self.extend(index as u32))
    }

    /// Whether `point` can be taken.
    ///
    /// # Errors
    /// Those of [`Self::insert`].
    pub fn check(&self, point: DVec2) -> Result<(), PointsError> {
        match check(&[point]) {
            Ok(1.0) => Ok(()),
            Err(PointsError::NotFinite { .. }) => {
                Err(PointsError::NotFinite { index: self.points.len(), point })
            }
            _ => {
                let size = point.abs();
                Err(PointsError::DynamicRange { smallest: size.min_element(), largest: size.max_element() })
            }
        }
    }

    /// An edge with the point strictly on its right: by bisection in the fan of the first corner, exact.
    fn seen_edge(&self, point: DVec2) -> Option<usize> {
        let count = self.corners.len();
        let at = |k: usize| self.points[self.corners[k % count] as usize];
        let sees = |k: usize| turn(at(k), at(k + 1), point) < 0.0;
        let side = |k: usize| turn(at(0), at(k), point);
        let (first, last) = (side(1), side(count - 1));
        if first < 0.0 {
            return Some(0);
        }
        if last > 0.0 {
            return Some(count - 1);
        }
        if first == 0.0 || last == 0.0 {
            // On the line of an edge of the first corner.
            return (0..count).find(|k| sees(*k));
        }
        // Left of the way to corner `low`, right of that to corner `high`.
        let (mut low, mut high) = (1, count - 1);
        while high - low > 1 {
            let middle = usize::midpoint(low, high);
            if side(middle) >= 0.0 { low = middle } else { high = middle }
        }
        sees(low).then_some(low)
    }

    /// Replaces the run of edges that see the point. An edge sees a point on its right, or beyond its end on its line.
    fn extend(&mut self, index: u32) -> bool {
        let count = self.corners.len();
        let at = |k: usize| self.points[self.corners[k % count] as usize];
        let point = self.points[index as usize];
        let Some(seen) = self.seen_edge(point) else { return false };
        // The run that holds `seen`, backwards and forwards. Edges on whose line the point lies join it, so that the
        // corners left are strict.
        let joins = |k: usize| turn(at(k), at(k + 1), point) <= 0.0;
        let mut first = seen + count;
        while joins(first - 1) {
            first -= 1;
        }
        let mut last = seen + count;
        while joins(last + 1) {
            last += 1;
        }
        // Corners from the end of the run round to its start are kept.
        let kept = (last + 1..=first + count).map(|k| self.corners[k % count]);
        self.corners = kept.chain([index]).collect();
        true
    }

    /// All points so far.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// The hull as it is now.
    ///
    /// # Errors
    /// [`PointsError::Empty`] before the first point.
    pub fn hull(&self) -> Result<Hull, PointsError> {
        Ok(match self.corners[..] {
            [] => return Err(PointsError::Empty),
            [i] => Hull::Point(i as usize),
            [i, j] => Hull::Segment([i as usize, j as usize]),
            _ => {
                let vertices = self.corners.iter().map(|i| self.points[*i as usize]).collect();
                Hull::Polygon(HullPolygon {
                    shape: ConvexPolygon::new(vertices),
                    sources: self.corners.clone(),
                })
            }
        })
    }
}
