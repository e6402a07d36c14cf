//! The report of a simulation through contact modes: pictures, bands of modes, curves.

mod bands;
mod moment;
mod page;
mod picture;
mod plane;
mod space;
mod spans;
mod view;

#[cfg(test)]
mod tests;

pub use page::{write_contact_report, write_planar_contact_report};
pub use spans::{ModeSpan, mode_spans, planar_mode_spans};
