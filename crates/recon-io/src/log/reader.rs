use super::columns::Columns;
use super::error::LogFileErrorKind as Kind;
use super::read::{Row, csv_error, three_palms};
use crate::rows::{Whole, rows};
use recon::object_dynamics::{LogError, Sample, SeriesError};
use std::io::Read;

/// The samples of a sensor log, version 1, one by one as their lines come: from a file, or from a pipe into which a robot
/// writes. The format is that of [`parse_log`](super::parse_log); truth is not looked at.
///
/// An error ends the samples.
pub struct LogReader<R> {
    rows: csv::StringRecordsIntoIter<Whole<R>>,
    columns: Columns,
    /// Samples so far, and the time of the latest, s.
    count: usize,
    latest: Option<f64>,
    ended: bool,
}

impl<R: Read> LogReader<R> {
    /// Reads the header.
    ///
    /// # Errors
    /// [`LogFileErrorKind`](super::LogFileErrorKind): no header, or one without a column that is needed.
    pub fn new(text: R) -> Result<Self, Kind> {
        let mut rows = rows(text);
        let header = rows.next().ok_or(Kind::Empty)?.map_err(csv_error)?;
        Ok(Self { columns: three_palms(&header)?, rows, count: 0, latest: None, ended: false })
    }

    fn sample(&mut self, record: csv::Result<csv::StringRecord>) -> Result<Sample, Kind> {
        let record = record.map_err(csv_error)?;
        let line = record.position().map_or(0, csv::Position::line);
        let sample = Row { record: &record, line }.sample(&self.columns)?;
        if let Some(previous) = self.latest.filter(|t| sample.t <= *t) {
            let series = SeriesError::TimeNotIncreasing { sample: self.count, time: sample.t, previous };
            return Err(Kind::Samples { line: Some(line), source: LogError::Series(series) });
        }
        (self.count, self.latest) = (self.count + 1, Some(sample.t));
        Ok(sample)
    }
}

impl<R: Read> Iterator for LogReader<R> {
    type Item = Result<Sample, Kind>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let record = self.rows.next()?;
        let sample = self.sample(record);
        self.ended = sample.is_err();
        Some(sample)
    }
}
