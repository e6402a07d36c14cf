//! The same in the plane: hulls of points, intersections of half-planes, both point by point and all at once.
//!
//! ```
//! use exact_hull::planar::Hull;
//! use glam::DVec2;
//!
//! # fn main() -> Result<(), exact_hull::planar::PointsError> {
//! let points = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec2::new(x, y));
//! let hull = Hull::of(&points)?;
//! let polygon = hull.polygon().expect("four of them are corners");
//! assert_eq!(polygon.sources(), [0, 1, 3, 4]);
//! assert_eq!(polygon.shape().area(), 1.0);
//! # Ok(())
//! # }
//! ```

mod chain;
mod half_plane;
mod halfplanes;
mod hull;
mod polygon;
mod ring;
#[cfg(test)]
mod tests;

pub(crate) use chain::convex_corners;
pub use half_plane::HalfPlane;
pub use halfplanes::{
    IncrementalIntersection, Intersection, IntersectionError, Region, Unbounded, interior_point,
};
pub use hull::{Hull, HullPolygon, IncrementalHull, PointsError};
pub use polygon::ConvexPolygon;
pub use ring::Ring;
pub use unit_direction::planar::{Direction, DirectionError};
