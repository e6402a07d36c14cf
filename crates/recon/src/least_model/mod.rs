//! The least model that serves: for a wanted accuracy the cheapest way to simulate a scene or to estimate a motion, and why.
//!
//! [`least_estimate`] chooses for a log, [`least_plane_estimate`] for one in the plane, [`least_motion`] and [`least_tolerance`] for a simulation. Both return what they chose with a
//! [`Choice`]: each question, each alternative, what it costs, what accuracy it reaches and how that is known. What is chosen is run, and its
//! accuracy is checked on the run itself; thresholds and what they rest on are in `docs/least-model.md`.

mod accuracy;
mod choice;
mod left_out;
mod plane;
mod reconstruction;
mod simulation;
#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panics")]
mod tests;
mod thinned;
mod three_planes;
mod words;

pub use accuracy::{Accuracy, AccuracyError};
pub use choice::{Alternative, Choice, Decision, Evidence, Model, Question};
pub use left_out::{is_frictionless, is_planar, out_of_balance};
pub use plane::{LeastPlaneEstimate, least_plane_estimate, one_of_plane};
pub use reconstruction::{LeastEstimate, contact_size, least_estimate, stated_accuracy};
pub use simulation::{Least, Pose, least_tolerance};
pub use thinned::one_of;
pub use three_planes::{LeastMotion, body_size, least_motion, outline_size};
