//! Bodies that are not convex, touched by convex palms.
//!
//! What the bounds of a convex body become ([`ShapeBounds::from_concave_contacts`]), and two descriptions of the body
//! itself that are approximations and no bounds: the alpha shape of the contact points ([`AlphaShape`]) and the smooth
//! surface through points and normals ([`HermiteSurface`]).

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
