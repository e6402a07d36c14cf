//! Bodies that are not convex, touched by convex palms.
//!
//! What the bounds of a convex body become ([`ShapeBounds::from_concave_contacts`]), and two descriptions of the body
//! itself that are approximations and no bounds: the alpha shape of the contact points ([`AlphaShape`]) and the smooth
//! surface through points and normals ([`HermiteSurface`]).
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::concave::AlphaShape;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Points of an L, on a lattice of spacing 1: nine cells of a square without four in a corner.
//! let all = (0..32).map(|k| DVec3::new((k % 4) as f64, (k / 4 % 4) as f64, (k / 16) as f64));
//! let points: Vec<DVec3> = all.filter(|p| p.x < 1.5 || p.y < 1.5).collect();
//! let shape = AlphaShape::of(&points)?;
//! // Of what is in the corner the hull has half; spheres about single cells have an eighth of it, where the lattice rounds it off.
//! assert!((shape.volume(f64::INFINITY)? - 7.0).abs() < 1e-12);
//! assert!((shape.volume(0.9)? - 5.5).abs() < 1e-12);
//! assert!(!shape.contains(0.9, DVec3::new(1.9, 1.9, 0.5))?);
//! # Ok(())
//! # }
//! ```

mod alpha;
mod contour;
mod error;
mod surface;
#[cfg(test)]
mod tests;
mod upper;

pub use alpha::AlphaShape;
pub use error::{AlphaError, SurfaceError};
pub use surface::HermiteSurface;

#[cfg(doc)]
use crate::bounds::ShapeBounds;
