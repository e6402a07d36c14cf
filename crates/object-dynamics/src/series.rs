//! What every log asks of its samples as a series in time, whatever a sample holds.

use thiserror::Error;

/// Times beyond this are in no use as seconds: 300 years, and steps of a microsecond are lost in rounding.
const LATEST: f64 = 1e10;
/// Readings beyond this are none of a palm's, in m, N, N s, N m or rad/s: their squares still are far from the largest number.
pub(crate) const MOST_READING: f64 = 1e9;

/// Whether a reading is a number, and no larger than any.
pub(crate) fn is_taken(reading: f64) -> bool {
    reading.abs() <= MOST_READING
}

/// Why samples are not a series.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SeriesError {
    /// Fewer than two samples.
    #[error("log has {found} sample(s); at least 2 are needed")]
    TooShort {
        /// How many there are.
        found: usize,
    },
    /// Time does not increase.
    #[error(
        "t of sample {sample} is {time} s, not above {previous} s before it; sort the log and drop repeats"
    )]
    TimeNotIncreasing {
        /// Index from 0.
        sample: usize,
        /// Its time, s.
        time: f64,
        /// The time before, s.
        previous: f64,
    },
    /// A time that is given in another unit.
    #[error("t of sample {sample} is {time:e} s, beyond {LATEST:e} s; give times in seconds")]
    TimeOutOfRange {
        /// Index from 0.
        sample: usize,
        /// Its time, s.
        time: f64,
    },
    /// Truth does not match the samples.
    #[error("truth has {found} rows for {expected} samples")]
    TruthLength {
        /// Number of samples.
        expected: usize,
        /// Number of truth rows.
        found: usize,
    },
}

impl SeriesError {
    /// Index from 0 of the sample at fault, where one is.
    #[must_use]
    pub fn sample(&self) -> Option<usize> {
        match *self {
            Self::TimeNotIncreasing { sample, .. } | Self::TimeOutOfRange { sample, .. } => Some(sample),
            Self::TooShort { .. } | Self::TruthLength { .. } => None,
        }
    }
}

/// Refuses fewer than two samples, and truth of another length.
pub(crate) fn check_lengths(samples: usize, truth: Option<usize>) -> Result<(), SeriesError> {
    if samples < 2 {
        return Err(SeriesError::TooShort { found: samples });
    }
    match truth {
        Some(found) if found != samples => Err(SeriesError::TruthLength { expected: samples, found }),
        _ => Ok(()),
    }
}

/// Refuses a sample that does not come after the one before it, or is out of any clock's range.
pub(crate) fn check_order(sample: usize, previous: Option<f64>, time: f64) -> Result<(), SeriesError> {
    match previous {
        _ if time.abs() > LATEST => Err(SeriesError::TimeOutOfRange { sample, time }),
        Some(previous) if time <= previous => Err(SeriesError::TimeNotIncreasing { sample, time, previous }),
        _ => Ok(()),
    }
}
