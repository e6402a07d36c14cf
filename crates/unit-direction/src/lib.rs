//! Unit vectors as a type: a normal that was not normalised cannot reach a formula that needs one.
//!
//! Start with [`Direction::new`] for a vector of any length, [`Direction::from_unit`] for data that claim to be unit.
//!
//! ```
//! use glam::DVec3;
//! use unit_direction::{Direction, DirectionError};
//!
//! # fn main() -> Result<(), DirectionError> {
//! let n = Direction::new(DVec3::new(3e-200, 0.0, 4e-200))?;
//! assert!((n.get() - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-15);
//! assert!(matches!(Direction::new(DVec3::ZERO), Err(DirectionError::Zero { .. })));
//! assert!(matches!(Direction::from_unit(DVec3::X * 1.1, 1e-3), Err(DirectionError::NotUnit { .. })));
//! # Ok(())
//! # }
//! ```
//!
//! In the plane: [`planar`].

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod planar;
mod space;

pub use space::{Direction, DirectionError};
