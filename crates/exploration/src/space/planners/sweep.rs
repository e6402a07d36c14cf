use super::super::SpaceKnowledge;
use super::super::opening::{Stage, stage};
use super::super::sequence::low_discrepancy;
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use contact_kinematics::Direction;

/// A fixed sequence that is spread evenly at any length: what can be had without looking.
#[derive(Clone, Debug)]
pub struct FixedSweep {
    start: Vec<Direction>,
    next: usize,
}

/// Members of the sequence that are passed over because they are out of reach, at most.
const PASSED: usize = 1000;

impl FixedSweep {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<Direction>) -> Self {
        Self { start, next: 0 }
    }
}

impl Planner<SpaceKnowledge> for FixedSweep {
    fn name(&self) -> &'static str {
        "sweep"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, SpaceKnowledge>,
    ) -> Result<Proposal<SpaceKnowledge>, PlanError> {
        if let Stage::Due(proposal) = stage(&self.start, situation)? {
            return Ok(proposal);
        }
        for _ in 0..PASSED {
            let along = low_discrepancy(self.next);
            self.next += 1;
            if situation.limits.allow(along) {
                return Ok(Proposal { along, ray: None, expected: None, reason: Reason::Sequence });
            }
        }
        Err(PlanError::NothingToGain)
    }
}
