use crate::planner::Reason;
use crate::random::Source;
use crate::rolling::planner::{RollPlanError, RollPlanner, RollProposal, View};

/// Turns the palms to angles drawn evenly from the workspace.
#[derive(Clone, Debug)]
pub struct RandomTurns {
    source: Source,
}

/// Angles are drawn from the box of both limits until they are allowed, this often at most.
const DRAWN: usize = 1000;

impl RandomTurns {
    /// Of this seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { source: Source::new(seed) }
    }
}

impl RollPlanner for RandomTurns {
    fn name(&self) -> &'static str {
        "random"
    }

    fn next(&mut self, view: &View<'_>) -> Result<RollProposal, RollPlanError> {
        let mut drawn = || view.workspace.angles.map(|[low, high]| self.source.between(low, high));
        let to = (0..DRAWN).map(|_| drawn()).find(|palms| view.workspace.allows(*palms));
        Ok(RollProposal {
            legs: vec![to.unwrap_or(view.track.palms)],
            expected: None,
            reason: Reason::Sequence,
        })
    }
}
