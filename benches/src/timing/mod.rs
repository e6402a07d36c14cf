//! Time, measured side by side with the error it buys.

mod side_by_side;
mod study;

pub use side_by_side::{Budget, SideBySide, Timing};
pub use study::Study;
