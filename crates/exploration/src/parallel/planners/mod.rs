//! Planners of strokes.

mod greedy;
mod idle;
mod near;
mod random;
mod rate;
mod sweep;
mod walk;

pub use greedy::LargestGap;
pub use near::NearestGap;
pub use random::RandomStrokes;
pub use rate::PathRate;
pub use sweep::RasterSweep;

use super::planner::Candidate;

/// Bodies that are drawn for each stroke.
const BODIES: usize = 3;

/// Of those that are worth their way the first of those that bring most.
fn best(all: &[Candidate], worth: f64) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (k, c) in all.iter().enumerate() {
        let gain = c.prediction.gain;
        if gain > worth && best.is_none_or(|(_, b)| gain > b) {
            best = Some((k, gain));
        }
    }
    best
}
