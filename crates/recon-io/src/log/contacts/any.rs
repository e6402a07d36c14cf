use super::super::error::{LogFileError, LogFileErrorKind as Kind};
use super::super::read::Table;
use super::PalmSetup;
use super::columns::palms_in_space;
use super::read::contacts;
use recon::object_dynamics::{ContactLog, SensorLog};
use std::io::{BufReader, Read};
use std::path::Path;

/// A sensor log of version 1 or 2.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyLog {
    /// Version 1: three flat palms through the origin.
    ThreePalms(SensorLog),
    /// Version 2: palms of any number, shape, pose and motion.
    Contacts(ContactLog),
}

/// Reads a sensor log of version 1 or 2 from a CSV file, whichever its header says. Version 2 needs the palms' shapes.
///
/// # Errors
/// [`LogFileError`] names the file, the line and the column.
pub fn read_any_log(path: impl AsRef<Path>, palms: Option<&[PalmSetup]>) -> Result<AnyLog, LogFileError> {
    let path = path.as_ref();
    let in_file = |kind| LogFileError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(Kind::Read(e)))?;
    parse_any_log(BufReader::new(file), palms).map_err(in_file)
}

/// The same from CSV text: a header with a column `px_i` or `sx_i` is one of version 2.
///
/// # Errors
/// [`LogFileErrorKind`](super::super::LogFileErrorKind) names the line and the column.
pub fn parse_any_log(text: impl Read, palms: Option<&[PalmSetup]>) -> Result<AnyLog, Kind> {
    let table = Table::open(text)?;
    if palms_in_space(&table.header)? == 0 {
        return table.three_palms().map(AnyLog::ThreePalms);
    }
    contacts(table, palms.ok_or(Kind::NoPalms)?).map(AnyLog::Contacts)
}
