use super::columns::Columns;
use super::contacts::{ContactRows, PalmSetup, palms_in_space};
use super::error::LogFileErrorKind as Kind;
use super::ordered::Ordered;
use super::read::{csv_error, three_palms};
use crate::rows::rows;
use recon::object_dynamics::Sample;
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
    rows: Ordered<R>,
    columns: Columns,
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
            return Ok(Self::ThreePalms(Box::new(PlaneRows { columns, rows: Ordered::new(rows) })));
        }
        let rows = ContactRows::new(&header, rows, palms.ok_or(Kind::NoPalms)?)?;
        Ok(Self::Contacts(Box::new(rows)))
    }
}

impl<R: Read> Iterator for PlaneRows<R> {
    type Item = Result<Sample, Kind>;

    fn next(&mut self) -> Option<Self::Item> {
        self.rows.next(|row| row.sample(&self.columns).map(|sample| (sample.t, sample)))
    }
}
