//! One of so many samples of a log.

use object_dynamics::{ContactLog, ContactLogError};

/// The log with its first sample and every `every`-th one after it. Impulses are integrals, so that they lose nothing between samples.
///
/// # Errors
/// Those of a log that is left with less than two samples.
pub fn one_of(log: &ContactLog, every: usize) -> Result<ContactLog, ContactLogError> {
    if every <= 1 {
        return Ok(log.clone());
    }
    let samples: Vec<usize> = (0..log.times().len()).step_by(every).collect();
    log.picked(&samples)
}
