//! Observers for any system with a flow, an output and their linearisations; nothing here knows palms.

pub mod bank;
pub mod batch;
mod density;
mod eigen;
pub mod ekf;
mod kalman;
mod model;
pub mod newton;
mod node;
mod report;
pub mod rk4;
mod window;

pub use model::{Model, Sample};
#[cfg(feature = "palms")]
pub(crate) use report::direction_words;
pub use report::{ObserverError, Report, Status, describe_direction};
pub use window::Start;
