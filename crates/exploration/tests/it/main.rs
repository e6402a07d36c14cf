//! Planners on bodies, from the first touch to the proof.
//!
//! One binary: each one more costs a link of everything.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

mod closed_loop;
mod contour;
mod oracle;
mod parallel;
mod reaching;
mod relief;
mod rolling;
