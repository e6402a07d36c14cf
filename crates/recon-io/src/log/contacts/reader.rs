use super::super::error::LogFileErrorKind as Kind;
use super::super::read::{Row, csv_error};
use super::PalmSetup;
use super::columns::Columns;
use super::read::Palm;
use crate::rows::Whole;
use recon::object_dynamics::{LogError, SeriesError};
use recon::observer::PalmSensed;
use std::io::Read;

/// What palms of a log of version 2 sense, sample by sample as its lines come; an error ends them.
pub struct ContactRows<R> {
    rows: csv::StringRecordsIntoIter<Whole<R>>,
    columns: Columns,
    palms: Vec<PalmSetup>,
    count: usize,
    latest: Option<f64>,
    ended: bool,
}

impl<R: Read> ContactRows<R> {
    pub(in crate::log) fn new(
        header: &csv::StringRecord,
        rows: csv::StringRecordsIntoIter<Whole<R>>,
        palms: &[PalmSetup],
    ) -> Result<Self, Kind> {
        let columns = Columns::find(header, palms.len())?;
        // Whether a palm has a pose is known from the header.
        for (i, setup) in palms.iter().enumerate() {
            Palm::new(i + 1, setup, &columns.palms[i])?;
        }
        Ok(Self { rows, columns, palms: palms.to_vec(), count: 0, latest: None, ended: false })
    }

    fn sample(&mut self, record: csv::Result<csv::StringRecord>) -> Result<(f64, Vec<PalmSensed>), Kind> {
        let record = record.map_err(csv_error)?;
        let line = record.position().map_or(0, csv::Position::line);
        let row = Row { record: &record, line };
        row.check_count(self.columns.count)?;
        let t = row.finite(&self.columns.t)?;
        if let Some(previous) = self.latest.filter(|latest| t <= *latest) {
            let series = SeriesError::TimeNotIncreasing { sample: self.count, time: t, previous };
            return Err(Kind::Samples { line: Some(line), source: LogError::Series(series) });
        }
        (self.count, self.latest) = (self.count + 1, Some(t));
        let sensed = |(i, setup): (usize, &PalmSetup)| {
            let mut palm = Palm::new(i + 1, setup, &self.columns.palms[i])?;
            palm.push(&row)?;
            palm.sensed().ok_or(Kind::NoForce { palm: i + 1 })
        };
        Ok((t, self.palms.iter().enumerate().map(sensed).collect::<Result<_, _>>()?))
    }
}

impl<R: Read> Iterator for ContactRows<R> {
    type Item = Result<(f64, Vec<PalmSensed>), Kind>;

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
