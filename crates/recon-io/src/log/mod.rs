//! Sensor logs, version 1, as CSV files.

mod columns;
mod error;
mod read;
mod write;

#[cfg(test)]
mod tests;

pub use error::{LogFileError, LogFileErrorKind};
pub use read::{parse_log, read_log};
pub use write::write_log;

pub(crate) use columns::TRUTH;
