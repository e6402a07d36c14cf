//! Outline of an object on a table, friction and contact modes from pushes by a round finger of known radius: force and place of the
//! finger throughout, poses of the object only before and after each push.
//!
//! Where the finger first and last touched in each push (`touches.rs`) is fitted by polygons and smooth outlines (`shape.rs`, `fit.rs`),
//! of which evidence chooses one (`choose.rs`). Between its poses the object goes where the force drives it on the table
//! (`path.rs`); force and slip against the outline tell sliding from sticking, and how large friction is (`modes.rs`,
//! `friction.rs`). `estimate.rs` is the way of a log.

mod arcs;
mod choose;
mod error;
mod estimate;
mod face;
mod fit;
mod friction;
mod line;
mod modes;
mod outline;
mod path;
mod result;
mod shape;
mod slopes;
mod touches;

pub use choose::OutlineCandidate;
pub use error::PushesError;
pub use estimate::estimate_pushes;
pub use outline::{OutlineCorner, OutlinePoint, PushedOutline};
pub use result::{PushFriction, PushInstant, PushResult, PushesEstimate};
pub use touches::NoTouch;

#[cfg(test)]
mod tests;
