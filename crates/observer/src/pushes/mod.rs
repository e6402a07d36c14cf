//! Outline of an object on a table, friction and contact modes from pushes by a round finger of known radius: force and place of the
//! finger throughout, poses of the object only before and after each push.
//!
//! Where the finger first and last touched in each push (`touches.rs`) is fitted by polygons and smooth outlines (`shape.rs`, `fit.rs`),
//! of which evidence chooses one (`choose.rs`). Between its poses the object goes where the force drives it on the table
//! (`path.rs`); force and slip against the outline tell sliding from sticking, and how large friction is (`modes.rs`,
//! `friction.rs`). `estimate.rs` is the way of a log.
//!
//! ```
//! use glam::DVec2;
//! use object_dynamics::pushing::{ClosedLine, PushDisturbances, PushScene, simulate_pushes};
//! use observer::pushes::estimate_pushes;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Thirty pushes of a box of 120 mm by 80 mm by a finger of 3 mm, as a robot with a force sensor records them.
//! let corners = [[-0.06, -0.04], [0.06, -0.04], [0.06, 0.04], [-0.06, 0.04]].map(DVec2::from);
//! let scene = PushScene {
//!     outline: ClosedLine::new(corners.to_vec())?,
//!     finger_radius: 3e-3,
//!     friction: 0.45,
//!     length: 0.035,
//!     sliding_force: 3.0,
//!     compliance: 6e-5,
//! };
//! let log = simulate_pushes(&scene, &PushDisturbances::default(), 30, 41)?.log;
//! let told = estimate_pushes(&log, scene.finger_radius)?;
//! assert_eq!(told.outline.corners.len(), 4);
//! assert!(told.friction.is_some_and(|found| (found.value - 0.45).abs() < 3.0 * found.deviation));
//! # Ok(())
//! # }
//! ```

mod arcs;
mod choose;
mod error;
mod estimate;
mod evidence;
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
