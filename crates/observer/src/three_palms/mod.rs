//! Three palms in space: what contacts tell without forces ([`no_force`]), and the paper's own method ([`paper_method`]).

mod motion_state;
pub mod no_force;
pub mod paper_method;
mod paper_system;
mod track;

pub use motion_state::MotionState;
pub use track::{Track, TrackError};
