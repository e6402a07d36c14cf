//! Planners in space. All begin with the same few touches, and close the upper bound if those have not.

mod gaussian;
mod hausdorff;
mod path;
mod random;
mod sweep;
mod volume;
mod width;

pub use gaussian::GaussianVariance;
pub use hausdorff::HausdorffGreedy;
pub use path::PathAware;
pub use random::RandomTouches;
pub use sweep::FixedSweep;
pub use volume::VolumeGreedy;

use super::SpaceKnowledge;
use super::candidates::{Candidate, Candidates};
use crate::planner::{PlanError, Proposal, Reason};

/// What a touch is found to remove over what was expected, in the median.
const OVERESTIMATE: f64 = 0.8;
/// Scores below this share of the largest that there can be are rounding.
const NOTHING: f64 = 1e-12;
/// Scores closer than this, relative, are a tie, which goes to the first: never to rounding.
const TIE: f64 = 1e-9;

/// The first of the candidates with the largest score; an error where none is above `least`.
fn best(found: &Candidates, least: f64) -> Result<Candidate, PlanError> {
    let mut best: Option<&Candidate> = None;
    for candidate in &found.within {
        if best.is_none_or(|b| candidate.score > b.score * (1.0 + TIE)) {
            best = Some(candidate);
        }
    }
    match best {
        Some(best) if best.score > least => Ok(*best),
        _ if found.out_of_reach.iter().any(|c| c.score > least) => {
            Err(PlanError::Unreachable { directions: found.named_out_of_reach() })
        }
        _ => Err(PlanError::NothingToGain),
    }
}

fn proposal(candidate: Candidate, reason: Reason) -> Proposal<SpaceKnowledge> {
    let Candidate { along, ray, score } = candidate;
    Proposal { along, ray: Some(ray), expected: Some(OVERESTIMATE * score), reason }
}
