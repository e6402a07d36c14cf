use super::columns::Columns;
use super::contacts::{ContactRows, PalmSetup, palms_in_space};
use super::error::LogFileErrorKind as Kind;
use super::read::{Row, csv_error, three_palms};
use crate::rows::{Whole, rows};
use recon::object_dynamics::{LogError, Sample, SeriesError};
use std::io::Read;

/// The samples of a sensor log one by one as their lines come: from a file, or from a pipe into which a robot writes. The formats are those
/// of [`parse_any_log`](super::parse_any_log); truth is not looked at.
pub enum LogReader<R> {
    /// Version 1: three flat palms through the origin.
    ThreePalms(Box<PlaneRows<R>>),
    /// Version 2: palms of any number, shape, pose and motion.
    Contacts(Box<ContactRows<R>>),
}

/// Samples of a log of version 1; an error ends them.
pub struct PlaneRows<R> {
    rows: csv::StringRecordsIntoIter<Whole<R>>,
    columns: Columns,
    /// Samples so far, and the time of the latest, s.
    count: usize,
    latest: Option<f64>,
    ended: bool,
}

impl<R: Read> LogReader<R> {
    /// Reads the header. Version 2 needs the palms' shapes.
    ///
    /// # Errors
    /// [`LogFileErrorKind`](super::LogFileErrorKind): no header, or one without a column that is needed.
    pub fn new(text: R, palms: Option<&[PalmSetup]>) -> Result<Self, Kind> {
        let mut rows = rows(text);
        let header = rows.next().ok_or(Kind::Empty)?.map_err(csv_error)?;
        if palms_in_space(&header)? == 0 {
            let columns = three_palms(&header)?;
            let rows = PlaneRows { columns, rows, count: 0, latest: None, ended: false };
            return Ok(Self::ThreePalms(Box::new(rows)));
        }
        let rows = ContactRows::new(&header, rows, palms.ok_or(Kind::NoPalms)?)?;
        Ok(Self::Contacts(Box::new(rows)))
    }
}

impl<R: Read> PlaneRows<R> {
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

impl<R: Read> Iterator for PlaneRows<R> {
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
