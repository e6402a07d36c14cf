use super::{NOTHING, Score, Stage, Touching, proposal, stage};
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};

/// Touches where the volume (area) between the bounds is expected to shrink most.
///
/// In space the score is the mean over heights at which the body may be met of what the upper bound loses and the lower one gains, weighted as they count in
/// the gap. In the plane it is the area beyond an edge of the lower bound: of a triangle a touch along the normal of the edge leaves a quarter at most, and a
/// sixth in the mean, whatever the body.
#[derive(Clone, Debug)]
pub struct VolumeGreedy<H> {
    start: Vec<H>,
}

impl<H> VolumeGreedy<H> {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<H>) -> Self {
        Self { start }
    }
}

impl<K: Touching> Planner<K> for VolumeGreedy<K::Heading> {
    fn name(&self) -> &'static str {
        K::GREEDY
    }

    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError> {
        let closed = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(closed) => closed,
        };
        let found = situation.known.candidates(closed, Score::Volume, situation.limits);
        Ok(proposal(found.best(NOTHING * K::sizes(closed)[0])?, Reason::Best))
    }
}

/// Touches where the bounds are furthest apart: along the line from the corner of the upper bound that is farthest from the lower
/// one to its nearest point there.
///
/// The largest difference of the support functions over all directions is the same: the two descriptions are one planner.
#[derive(Clone, Debug)]
pub struct HausdorffGreedy<H> {
    start: Vec<H>,
}

impl<H> HausdorffGreedy<H> {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<H>) -> Self {
        Self { start }
    }
}

impl<K: Touching> Planner<K> for HausdorffGreedy<K::Heading> {
    fn name(&self) -> &'static str {
        "hausdorff"
    }

    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError> {
        let closed = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(closed) => closed,
        };
        let found = situation.known.farthest(closed, situation.limits);
        Ok(proposal(found.best(NOTHING * K::sizes(closed)[1])?, Reason::Best))
    }
}
