//! Shape, motion and bounds of an unknown convex object from touch: the five core crates under one name.
//!
//! Each crate can be used alone; this facade adds [`least_model`], which needs several of them: the cheapest model that reaches a wanted accuracy,
//! and why. Start with the crate that answers your question:
//!
//! | question | crate |
//! |---|---|
//! | Where does a convex body touch a palm, and how does that change? | [`contact_kinematics`] |
//! | How does it move between palms? | [`object_dynamics`] |
//! | How did it move, and what does it weigh, from what palms felt? | [`observer`] |
//! | What is certain of its shape? | [`shape_bounds`] |
//! | Where to touch next? | [`exploration`] |
//!
//! ```
//! use glam::DVec3;
//! use recon::shape_bounds::{ContactSample, ShapeBounds};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Where a unit ball was touched, with the outward normal there: its six poles.
//! let poles = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
//! let bounds = ShapeBounds::from_contacts(&ContactSample::from_raw(poles.map(|p| (p, p)))?)?;
//! assert!((bounds.lower_volume() - 4.0 / 3.0).abs() < 1e-12); // the octahedron inside,
//! assert!((bounds.upper_volume() - 8.0).abs() < 1e-12); // the cube outside
//! # Ok(())
//! # }
//! ```

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod least_model;

#[doc(inline)]
pub use contact_kinematics;
#[doc(inline)]
pub use exploration;
#[doc(inline)]
pub use object_dynamics;
#[doc(inline)]
pub use observer;
#[doc(inline)]
pub use shape_bounds;
