//! Readings of sensors that have their own rates and clocks, before they are samples of one log: interpolation with a stated
//! error, intervals without readings, and the offset between two clocks.

mod clock;
mod gaps;
mod poses;
mod track;

pub use clock::{ClockOffset, clock_offset};
pub use gaps::{Rhythm, Silence};
pub use poses::{PoseTrack, TurnAndShift};
pub use track::{Track, TrackError};
