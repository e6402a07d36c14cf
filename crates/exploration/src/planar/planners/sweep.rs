use super::super::PlanarKnowledge;
use super::super::opening::{Stage, stage};
use super::super::start::golden;
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use shape_bounds::exact_hull::planar::Direction;

/// Turns by the golden angle, spread evenly at any length: what can be had without looking.
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

impl Planner<PlanarKnowledge> for FixedSweep {
    fn name(&self) -> &'static str {
        "sweep"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, PlanarKnowledge>,
    ) -> Result<Proposal<PlanarKnowledge>, PlanError> {
        if let Stage::Due(proposal) = stage(&self.start, situation)? {
            return Ok(proposal);
        }
        for _ in 0..PASSED {
            let along = golden(self.next);
            self.next += 1;
            if situation.limits.allow(along) {
                return Ok(Proposal { along, ray: None, expected: None, reason: Reason::Sequence });
            }
        }
        Err(PlanError::NothingToGain)
    }
}
