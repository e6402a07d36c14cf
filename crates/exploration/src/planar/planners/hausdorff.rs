use super::super::PlanarKnowledge;
use super::super::caps::by_distance;
use super::super::opening::{Stage, stage};
use super::{NOTHING, best, proposal};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use shape_bounds::exact_hull::planar::Direction;

/// Touches where the bounds are furthest apart: along the line from the corner of the upper bound that is farthest from the lower
/// one to its nearest point there.
///
/// The largest difference of the support functions over all directions is the same: the two descriptions are one planner.
#[derive(Clone, Debug)]
pub struct HausdorffGreedy {
    start: Vec<Direction>,
}

impl HausdorffGreedy {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<Direction>) -> Self {
        Self { start }
    }
}

impl Planner<PlanarKnowledge> for HausdorffGreedy {
    fn name(&self) -> &'static str {
        "hausdorff"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, PlanarKnowledge>,
    ) -> Result<Proposal<PlanarKnowledge>, PlanError> {
        let (bounds, upper) = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(bounds, upper) => (bounds, upper),
        };
        let least = NOTHING * upper.perimeter();
        let prospects = situation.known.prospects();
        let found = by_distance(bounds, &prospects, situation.limits);
        Ok(proposal(best(&found, least)?, Reason::Best))
    }
}
