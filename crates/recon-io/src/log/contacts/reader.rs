use super::super::error::LogFileErrorKind as Kind;
use super::super::ordered::Ordered;
use super::super::read::Row;
use super::PalmSetup;
use super::columns::Columns;
use super::read::Palm;
use crate::rows::Whole;
use recon::observer::contacts::stream::PalmSensed;
use std::io::Read;

/// What palms of a log of version 2 sense, sample by sample as its lines come; an error ends them.
pub struct ContactRows<R> {
    rows: Ordered<R>,
    columns: Columns,
    palms: Vec<PalmSetup>,
}

impl<R: Read> ContactRows<R> {
    pub(in crate::log) fn new(
        header: &csv::StringRecord,
        rows: csv::StringRecordsIntoIter<Whole<R>>,
        palms: &[PalmSetup],
    ) -> Result<Self, Kind> {
        let columns = Columns::find(header, palms.len())?;
        check_setups(&columns, palms)?;
        Ok(Self { rows: Ordered::new(rows), columns, palms: palms.to_vec() })
    }
}

/// Whether each palm has a pose: that is known from the header.
pub(in crate::log) fn check_setups(columns: &Columns, palms: &[PalmSetup]) -> Result<(), Kind> {
    palms.iter().enumerate().try_for_each(|(i, setup)| Palm::new(i + 1, setup, &columns.palms[i]).map(|_| ()))
}

/// What a row says: time and palms.
pub(in crate::log) fn sample(
    row: &Row,
    columns: &Columns,
    palms: &[PalmSetup],
) -> Result<(f64, Vec<PalmSensed>), Kind> {
    row.check_count(columns.count)?;
    let t = row.finite(&columns.t)?;
    let sensed = |(i, setup): (usize, &PalmSetup)| {
        let mut palm = Palm::new(i + 1, setup, &columns.palms[i])?;
        palm.push(row)?;
        palm.sensed().ok_or(Kind::NoForce { palm: i + 1 })
    };
    Ok((t, palms.iter().enumerate().map(sensed).collect::<Result<_, _>>()?))
}

impl<R: Read> Iterator for ContactRows<R> {
    type Item = Result<(f64, Vec<PalmSensed>), Kind>;

    fn next(&mut self) -> Option<Self::Item> {
        self.rows.next(|row| sample(row, &self.columns, &self.palms).map(|sample| (sample.0, sample)))
    }
}
