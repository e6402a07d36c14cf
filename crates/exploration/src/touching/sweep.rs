use super::{Stage, Touching, stage};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};

/// A fixed sequence that is spread evenly at any length: what can be had without looking. In the plane turns by the golden angle.
#[derive(Clone, Debug)]
pub struct FixedSweep<H> {
    start: Vec<H>,
    next: usize,
}

/// Members of the sequence that are passed over because they are out of reach, at most.
const PASSED: usize = 1000;

impl<H> FixedSweep<H> {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<H>) -> Self {
        Self { start, next: 0 }
    }
}

impl<K: Touching> Planner<K> for FixedSweep<K::Heading> {
    fn name(&self) -> &'static str {
        "sweep"
    }

    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError> {
        if let Stage::Due(proposal) = stage(&self.start, situation)? {
            return Ok(proposal);
        }
        for _ in 0..PASSED {
            let along = K::in_sequence(self.next);
            self.next += 1;
            if situation.limits.allow(along) {
                return Ok(Proposal { along, ray: None, expected: None, reason: Reason::Sequence });
            }
        }
        Err(PlanError::NothingToGain)
    }
}
