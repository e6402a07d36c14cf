//! The generic observers and estimators from outside.
//!
//! One binary: each one more costs a link of everything.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

mod allocations;
mod bank;
mod generic;
