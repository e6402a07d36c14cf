//! Contact kinematics from outside.
//!
//! One binary: each one more costs a link of everything.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

mod kinematics;
mod planar;
mod surfaces;
