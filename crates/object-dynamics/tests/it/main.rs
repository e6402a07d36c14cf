//! Dynamics from outside.
//!
//! One binary: each one more costs a link of everything.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

mod approach;
mod closed_forms;
mod contact_modes;
mod crawl;
mod flight;
mod giving_way;
mod motor_palms;
mod sliding;
mod three_palms;
