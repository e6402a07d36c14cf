//! Logs that are denser than their motion needs.

use recon::object_dynamics::SensorLog;

/// Samples of longer logs are taken together, where that loses nothing.
const MOST_SAMPLES: usize = 200_000;
/// Samples that such a log is brought down to, and what the means may be off by beside what noise hides, as a share of the largest reading. Under
/// noise few means say what all of them do, and the more a mean is of the less time they take; where there is none to hide anything, many are more
/// exact. A share of 1e-12 is rounding.
const ENOUGH: [(usize, f64); 3] = [(50_000, 1e-12), (100_000, 1e-12), (MOST_SAMPLES, 1e-9)];

/// The log, or of a long one the means of so many samples.
pub(super) fn condensed(log: SensorLog) -> (SensorLog, usize) {
    let count = log.samples().len();
    if count <= MOST_SAMPLES {
        return (log, 1);
    }
    let means = |(samples, blurred): (usize, f64)| {
        // Odd, so that the truth of the middle one is that of the mean's time.
        let together = count.div_ceil(samples) | 1;
        Some((log.condensed(together, blurred)?, together))
    };
    let found = ENOUGH.into_iter().find_map(means);
    found.unwrap_or((log, 1))
}
