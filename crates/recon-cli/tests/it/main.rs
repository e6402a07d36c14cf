//! The command from outside: what it reads, writes and says.
//!
//! One binary: each one more costs a link of everything.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

mod any_friction;
mod any_palms;
mod bad_input;
mod bags;
mod batch;
mod bounds;
mod bounds_noise;
mod bounds_shapes;
mod check;
mod common;
mod contour;
mod end_to_end;
mod explore;
mod export;
mod follow;
mod guides;
mod in_memory;
#[cfg(unix)]
mod interrupted;
mod least_model;
mod margins;
mod not_smooth;
mod nothing_lost;
mod planar;
mod pushes;
mod relief;
mod schema;
mod simulate_any;
mod simulate_planar;
