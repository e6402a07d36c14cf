//! Logs that are denser than their motion needs.

use recon::object_dynamics::SensorLog;

/// Samples of longer logs are taken together, where that loses nothing.
const MOST_SAMPLES: usize = 200_000;

/// The log, or of a long one the means of so many samples.
pub(super) fn condensed(log: SensorLog) -> (SensorLog, usize) {
    // Odd, so that the truth of the middle one is that of the mean's time.
    let together = log.samples().len().div_ceil(MOST_SAMPLES) | 1;
    match (together > 1).then(|| log.condensed(together)).flatten() {
        Some(means) => (means, together),
        None => (log, 1),
    }
}
