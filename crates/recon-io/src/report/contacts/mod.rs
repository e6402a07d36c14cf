//! The report of a simulation through contact modes.

mod spans;

pub use spans::{ModeSpan, mode_spans};
