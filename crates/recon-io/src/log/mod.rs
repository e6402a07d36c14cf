//! Sensor logs as CSV files: of any palms (version 2), of three flat palms (version 1), planar ones of two, and of pushes. What they
//! hold is in `docs/formats.md`.

mod columns;
mod contacts;
mod error;
mod memory;
mod ordered;
mod planar;
mod planar_contacts;
mod pushes;
mod read;
mod reader;
mod write;

#[cfg(test)]
mod tests;

pub use contacts::{
    AnyLog, ContactRows, PalmSetup, PoseAgainstScene, parse_any_log, parse_contact_log, read_any_log,
    read_contact_log, write_contact_log,
};
pub use error::{LogFileError, LogFileErrorKind};
pub use memory::{
    RowReader, RowSample, log_of_columns, planar_contact_log_of_columns, planar_log_of_columns,
};
pub use planar::{parse_planar_log, read_planar_log, write_planar_log};
pub use planar_contacts::{parse_planar_contact_log, read_planar_contact_log, write_planar_contact_log};
pub use pushes::{read_push_logs, write_push_poses, write_push_samples};
pub use read::{parse_log, read_log};
pub use reader::{LogReader, PlaneRows};
pub use write::write_log;

pub(crate) use columns::TRUTH;
pub(crate) use contacts::read_pose_table;
