//! The pipeline without files.
//!
//! Options are words as on the command line (`--contact-noise=1e-4`), so that both are one thing with one set of limits and messages.

mod bounds;
mod failure;
mod follower;
mod log;
mod options;
mod plan;
mod plane;
mod reconstruct;
mod simulate;

pub use bounds::{Bounded, Outlines};
pub use failure::{Failure, FailureKind};
pub use follower::Follower;
pub use log::Log;
pub use plan::{plan_of_columns, plan_of_file};
pub use plane::{PlaneLog, PlaneReconstructed, PlaneScene, PlaneSimulated};
pub use reconstruct::{Body, Reconstructed};
pub use simulate::Simulated;

use crate::error::CliError;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Runs `work` on this thread until it is done, or another thread sets `stop`, where loops ask
/// (simulations and estimates of motion; bounds run to their end).
///
/// # Errors
/// That of `work`; or [`FailureKind::Interrupted`].
pub fn unless_stopped<T>(
    stop: &Arc<AtomicBool>,
    work: impl FnOnce() -> Result<T, Failure>,
) -> Result<T, Failure> {
    recon::contact_kinematics::unless_stopped(stop, work).unwrap_or_else(|stopped| {
        Err(Failure { kind: FailureKind::Interrupted, message: stopped.to_string() })
    })
}

/// Checks a folder of results by its files alone, as `recon check` does; returns what held.
///
/// # Errors
/// What does not hold.
pub fn check(folder: &Path) -> Result<Vec<String>, Failure> {
    Ok(recon_io::check(folder).map_err(CliError::from)?)
}
