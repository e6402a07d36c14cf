use super::idle::Idle;
use super::{BODIES, best};
use crate::parallel::planner::{ParallelPlanError, ParallelPlanner, ParallelProposal, ParallelView};
use crate::parallel::predict::Course;
use crate::planner::Reason;

/// The stroke that is expected to bring most, however far it is (the paper's first strategy).
#[derive(Clone, Debug)]
pub struct LargestGap {
    seed: u64,
    idle: Idle,
}

impl LargestGap {
    /// With bodies of this seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { seed, idle: Idle::default() }
    }
}

impl ParallelPlanner for LargestGap {
    fn name(&self) -> &'static str {
        "largest gap"
    }

    fn next(&mut self, view: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError> {
        let bodies = view.bodies(BODIES, self.seed);
        if let Some(instead) = self.idle.instead(view, &bodies)? {
            return Ok(instead);
        }
        let all = view.candidates(&bodies, &Course::start(&bodies, view.hold), &view.farthest_gaps());
        let Some((k, _)) = best(&all, view.worth()) else { return self.idle.walked(view) };
        let (stroke, expected) = (all[k].stroke, Some(all[k].prediction));
        Ok(ParallelProposal { stroke, expected, reason: Reason::Best })
    }
}
