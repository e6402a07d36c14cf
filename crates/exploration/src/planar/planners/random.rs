use super::super::PlanarKnowledge;
use super::super::opening::{Stage, stage};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use crate::random::Source;
use shape_bounds::exact_hull::planar::Direction;
use std::f64::consts::TAU;

/// Directions that are uniform over the circle: what any planner must beat.
#[derive(Clone, Debug)]
pub struct RandomTouches {
    start: Vec<Direction>,
    source: Source,
}

/// Draws until one is within reach; limits that leave less than some hundredth of the circle are met by moving one to the rim.
const DRAWS: usize = 100;

impl RandomTouches {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<Direction>, seed: u64) -> Self {
        Self { start, source: Source::new(seed) }
    }
}

impl RandomTouches {
    fn draw(&mut self) -> Direction {
        Direction::from_angle(self.source.between(0.0, TAU))
    }
}

impl Planner<PlanarKnowledge> for RandomTouches {
    fn name(&self) -> &'static str {
        "random"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, PlanarKnowledge>,
    ) -> Result<Proposal<PlanarKnowledge>, PlanError> {
        if let Stage::Due(proposal) = stage(&self.start, situation)? {
            return Ok(proposal);
        }
        let mut along = self.draw();
        for _ in 0..DRAWS {
            if situation.limits.allow(along) {
                break;
            }
            along = self.draw();
        }
        let along = situation.limits.nearest(along).ok_or(PlanError::NothingToGain)?;
        Ok(Proposal { along, ray: None, expected: None, reason: Reason::Sequence })
    }
}
