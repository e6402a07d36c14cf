//! Planners of palm motions.

mod greedy;
mod idle;
mod near;
mod random;
mod rate;
mod sweep;
mod walk;

pub use greedy::LargestGap;
pub use near::NearestGap;
pub use random::RandomTurns;
pub use rate::InformationRate;
pub use sweep::PalmSweep;

/// Bodies that are drawn for each motion.
const BODIES: usize = 12;
/// Scores closer than this, relative, are a tie, which goes to the first: never to rounding.
const TIE: f64 = 1e-9;

/// Index of the first of the largest scores; none of no scores.
fn first_largest(scores: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (k, score) in scores.enumerate() {
        if best.is_none_or(|(_, b)| score > b + TIE * b.abs()) {
            best = Some((k, score));
        }
    }
    best
}
