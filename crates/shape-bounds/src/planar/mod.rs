//! The same in the plane: bounds on a convex outline from contact points and outward normals.
//!
//! The names are those of the bounds in space; what differs is that areas stand for volumes, half-planes for half-spaces
//! and discs for balls. The plane has closed forms that space lacks, so this is a module of its own.
//!
//! ```
//! use glam::DVec2;
//! use shape_bounds::planar::{ContactSample, ShapeBounds};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A unit disc, touched at six places.
//! let turn = |k: u32| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / 6.0);
//! let contacts = ContactSample::from_raw((0..6).map(|k| (turn(k), turn(k))))?;
//! let bounds = ShapeBounds::from_contacts(&contacts)?;
//! assert!(bounds.lower_area() < std::f64::consts::PI && std::f64::consts::PI < bounds.upper_area());
//! # Ok(())
//! # }
//! ```

mod approximation;
mod bounds;
mod curvature;
mod distance;
mod fit;
mod noise;
mod sample;
#[cfg(test)]
mod tests;

pub use approximation::{PrincipalCurve, SplineCurve};
pub use bounds::{BoundsError, Gap, IncrementalBounds, ShapeBounds};
pub use curvature::{CurvatureBounds, CurvatureError, Disc, DiscIntersection, RoundedHull, Side};
pub use exact_hull::planar::{
    ConvexPolygon, Direction, DirectionError, HalfPlane, Hull, HullPolygon, IncrementalHull,
    IncrementalIntersection, Intersection, IntersectionError, PointsError, Region, Unbounded,
};
pub use fit::{FitError, FittedOutline, OutlineChoice, OutlineFamily, OutlineFit, TurnedEllipse};
pub use noise::{
    ContactNoise, NoiseError, NoisyContact, correlated_noise, estimate_noise, independence_is_tested,
    with_noise_as_found, without_outliers,
};
pub use sample::{ContactError, ContactSample};
