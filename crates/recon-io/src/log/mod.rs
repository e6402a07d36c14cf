//! Sensor logs, version 1, of three palms and planar ones of two, as CSV files.

mod columns;
mod error;
mod planar;
mod read;
mod reader;
mod write;

#[cfg(test)]
mod tests;

pub use error::{LogFileError, LogFileErrorKind};
pub use planar::{parse_planar_log, read_planar_log, write_planar_log};
pub use read::{parse_log, read_log};
pub use reader::LogReader;
pub use write::write_log;

pub(crate) use columns::TRUTH;
