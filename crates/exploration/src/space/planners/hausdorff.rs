use super::super::SpaceKnowledge;
use super::super::candidates::{Candidate, Score, candidates};
use super::super::opening::{Stage, stage};
use super::{NOTHING, best, proposal};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use contact_kinematics::Direction;
use shape_bounds::ShapeBounds;
use shape_bounds::exact_hull::Polyhedron;

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

/// The largest gap as a candidate, by a search that makes few corners exact.
fn largest(bounds: &ShapeBounds, upper: &Polyhedron) -> Option<Candidate> {
    let gap = bounds.largest_gap()?;
    // Deeper than the nearest point, which may be a contact that a ray would only meet again.
    let aim = gap.inner.midpoint(upper.moments().centroid);
    Some(Candidate { along: gap.direction, ray: [gap.outer, aim], score: gap.distance })
}

impl Planner<SpaceKnowledge> for HausdorffGreedy {
    fn name(&self) -> &'static str {
        "hausdorff"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, SpaceKnowledge>,
    ) -> Result<Proposal<SpaceKnowledge>, PlanError> {
        let (bounds, upper) = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(bounds, upper) => (bounds, upper),
        };
        let least = NOTHING * upper.moments().area.sqrt();
        if situation.limits.are_none() {
            return match largest(bounds, upper).filter(|c| c.score > least) {
                Some(candidate) => Ok(proposal(candidate, Reason::Best)),
                None => Err(PlanError::NothingToGain),
            };
        }
        let prospects = situation.known.prospects();
        let found = candidates(bounds, upper, Score::Distance, &prospects, situation.limits);
        Ok(proposal(best(&found, least)?, Reason::Best))
    }
}
