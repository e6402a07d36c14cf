//! The same in the plane: bounds on a convex outline from contact points and outward normals.
//!
//! The names are those of the bounds in space; what differs is that areas stand for volumes, half-planes for half-spaces
//! and discs for balls. The plane has closed forms that space lacks, so this is a module of its own. Directions, hulls and half-planes are those of
//! [`exact_hull::planar`].
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

pub mod approximation;
mod bounds;
pub mod curvature;
mod distance;
pub mod fit;
pub mod noise;
mod sample;
#[cfg(test)]
mod tests;

pub use bounds::{BoundsError, Gap, IncrementalBounds, ShapeBounds};
pub use sample::{ContactError, ContactSample};
