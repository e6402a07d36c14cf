//! Shape, motion and bounds of an unknown convex object from touch: the five core crates under one name.
//!
//! This facade adds nothing of its own; each crate can be used alone.

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

/// The first use that the README shows must compile and hold.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
