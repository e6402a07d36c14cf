use super::error::LogFileErrorKind as Kind;
use super::read::{Row, csv_error};
use crate::rows::Whole;
use recon::object_dynamics::{LogError, SeriesError};
use std::io::Read;

/// Rows of a log one by one as its lines come, in order of time; an error ends them.
pub(super) struct Ordered<R> {
    rows: csv::StringRecordsIntoIter<Whole<R>>,
    times: Times,
    ended: bool,
}

impl<R: Read> Ordered<R> {
    pub(super) fn new(rows: csv::StringRecordsIntoIter<Whole<R>>) -> Self {
        Self { rows, times: Times::default(), ended: false }
    }

    /// The next row as what `read` makes of it, and its time, s.
    pub(super) fn next<T>(
        &mut self,
        read: impl FnOnce(&Row) -> Result<(f64, T), Kind>,
    ) -> Option<Result<T, Kind>> {
        if self.ended {
            return None;
        }
        let record = self.rows.next()?;
        let sample = self.sample(record, read);
        self.ended = sample.is_err();
        Some(sample)
    }

    fn sample<T>(
        &mut self,
        record: csv::Result<csv::StringRecord>,
        read: impl FnOnce(&Row) -> Result<(f64, T), Kind>,
    ) -> Result<T, Kind> {
        let record = record.map_err(csv_error)?;
        let row = Row::of(&record);
        let (time, sample) = read(&row)?;
        self.times.take(time, row.line)?;
        Ok(sample)
    }
}

/// Times that must increase.
#[derive(Default)]
pub(super) struct Times {
    /// Samples so far, and the time of the latest, s.
    pub(super) count: usize,
    latest: Option<f64>,
}

impl Times {
    /// Takes the time (s) of the sample that stands in `line`.
    pub(super) fn take(&mut self, time: f64, line: u64) -> Result<(), Kind> {
        if let Some(previous) = self.latest.filter(|latest| time <= *latest) {
            let series = SeriesError::TimeNotIncreasing { sample: self.count, time, previous };
            return Err(Kind::Samples { line: Some(line), source: LogError::Series(series) });
        }
        (self.count, self.latest) = (self.count + 1, Some(time));
        Ok(())
    }
}
