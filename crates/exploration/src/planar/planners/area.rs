use super::super::PlanarKnowledge;
use super::super::caps::by_area;
use super::super::opening::{Stage, stage};
use super::{NOTHING, best, proposal};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use shape_bounds::exact_hull::planar::Direction;

/// Touches along the normal of the edge of the lower bound with the largest area beyond it: of a triangle a touch leaves a quarter at
/// most, and a sixth in the mean, whatever the body.
#[derive(Clone, Debug)]
pub struct AreaGreedy {
    start: Vec<Direction>,
}

impl AreaGreedy {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<Direction>) -> Self {
        Self { start }
    }
}

impl Planner<PlanarKnowledge> for AreaGreedy {
    fn name(&self) -> &'static str {
        "area"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, PlanarKnowledge>,
    ) -> Result<Proposal<PlanarKnowledge>, PlanError> {
        let (bounds, upper) = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(bounds, upper) => (bounds, upper),
        };
        let prospects = situation.known.prospects();
        let found = by_area(bounds, &prospects, situation.limits);
        Ok(proposal(best(&found, NOTHING * upper.area())?, Reason::Best))
    }
}
