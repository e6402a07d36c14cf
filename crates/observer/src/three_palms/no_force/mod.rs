//! No force sensors: motion, shape and inertia over mass from contacts and palm poses alone.

mod closure;
mod deviations;
mod error;
mod estimate;
mod orientations;
mod problem;
mod search;
mod series;
mod shape;
mod suspects;

#[cfg(test)]
mod tests;

pub use closure::Closure;
pub use error::NoForceError;
pub use estimate::{KnownTouch, NoForceEstimate, NoForceEvidence, TouchShape, estimate_without_forces};
