use super::{Stage, Touching, stage};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use crate::random::Source;

/// Directions that are uniform over the sphere (circle): what any planner must beat.
#[derive(Clone, Debug)]
pub struct RandomTouches<H> {
    start: Vec<H>,
    source: Source,
}

/// Draws until one is within reach; limits that leave less than some hundredth of all are met by moving one to the rim.
const DRAWS: usize = 100;

impl<H> RandomTouches<H> {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<H>, seed: u64) -> Self {
        Self { start, source: Source::new(seed) }
    }
}

impl<K: Touching> Planner<K> for RandomTouches<K::Heading> {
    fn name(&self) -> &'static str {
        "random"
    }

    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError> {
        if let Stage::Due(proposal) = stage(&self.start, situation)? {
            return Ok(proposal);
        }
        let mut along = K::drawn(&mut self.source);
        for _ in 0..DRAWS {
            if situation.limits.allow(along) {
                break;
            }
            along = K::drawn(&mut self.source);
        }
        let along = situation.limits.nearest(along).ok_or(PlanError::NothingToGain)?;
        Ok(Proposal { along, ray: None, expected: None, reason: Reason::Sequence })
    }
}
