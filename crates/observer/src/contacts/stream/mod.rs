//! The motion sample by sample, from no guess, in bounded memory.
//!
//! A thread of its own estimates the motion over a window of the latest samples, by the same least squares as a whole log:
//! [`estimate_contacts`](crate::estimate_contacts). It begins where the window before ended up, so that a few linearisations do. The
//! thread that pushes samples carries the motion from the window's end to the newest sample by what was measured since, with its
//! covariance, in a few microseconds.
//!
//! What the thread is given at one sample is taken at a fixed number of samples later, whenever it was done: the same samples give the
//! same estimates on every machine. On one that is too slow for that, a push waits.

mod dearer;
mod estimate;
mod freed;
mod front;
mod modes;
mod others;
mod planes;
mod sample;
mod schedule;
mod solution;
#[cfg(test)]
mod tests;
mod thread;
mod window;

pub use estimate::{StreamBody, StreamError, StreamEstimate, StreamMotion, StreamOptions, StreamStage};
pub use modes::StreamModes;
pub use planes::PlaneReadings;
pub use sample::{ForceReading, PalmSensed, StreamPalm};
pub use schedule::MotionStream;
