//! What can be said of meshes and outlines by exact signs: whether a surface is closed and convex, how large it is, and
//! whether points are inside.
//!
//! Made to certify bounds on a shape: it shares no code with what builds them. Signs are those of Shewchuk's predicates
//! (from the crate `robust`), so that they hold for slivers and for points on a face; lengths and volumes are rounded.
//!
//! ```
//! use certificate::{Solid, Surface};
//! use glam::DVec3;
//!
//! # fn main() -> Result<(), certificate::SurfaceError> {
//! let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let tetrahedron = Surface::new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
//! assert_eq!(tetrahedron.not_convex(0.0), None);
//! let inside = Solid::new(&tetrahedron);
//! assert_eq!(inside.winding(DVec3::splat(0.2)), 1);
//! assert_eq!(inside.farthest_outside(&[DVec3::splat(0.2), -DVec3::X]), Some((1, 1.0)));
//! # Ok(())
//! # }
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

mod inside;
mod outline;
mod star;
mod surface;
#[cfg(test)]
mod tests;

pub use inside::Solid;
pub use outline::Outline;
pub use surface::{Flaw, Size, Surface, SurfaceError};
