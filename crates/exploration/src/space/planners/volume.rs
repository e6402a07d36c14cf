use super::super::SpaceKnowledge;
use super::super::candidates::{Score, candidates};
use super::super::opening::{Stage, stage};
use super::{NOTHING, best, proposal};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use contact_kinematics::Direction;

/// Touches where the volume between the bounds is expected to shrink most: the mean over heights at which the body may be met of
/// what the upper bound loses and the lower one gains, weighted as they count in the gap.
#[derive(Clone, Debug)]
pub struct VolumeGreedy {
    start: Vec<Direction>,
}

impl VolumeGreedy {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<Direction>) -> Self {
        Self { start }
    }
}

impl Planner<SpaceKnowledge> for VolumeGreedy {
    fn name(&self) -> &'static str {
        "volume"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, SpaceKnowledge>,
    ) -> Result<Proposal<SpaceKnowledge>, PlanError> {
        let (bounds, upper) = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(bounds, upper) => (bounds, upper),
        };
        let prospects = situation.known.prospects();
        let found = candidates(bounds, upper, Score::Volume, &prospects, situation.limits);
        Ok(proposal(best(&found, NOTHING * upper.volume())?, Reason::Best))
    }
}
