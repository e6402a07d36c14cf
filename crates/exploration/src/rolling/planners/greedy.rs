use super::idle::Idle;
use super::{BODIES, first_largest};
use crate::planner::Reason;
use crate::rolling::planner::{RollPlanError, RollPlanner, RollProposal, View, belief, candidates, worth};
use crate::rolling::predict::Course;

/// The motion that is expected to take most of what is between the bounds, however far it is (the paper's first strategy).
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

impl RollPlanner for LargestGap {
    fn name(&self) -> &'static str {
        "largest gap"
    }

    fn next(&mut self, view: &View<'_>) -> Result<RollProposal, RollPlanError> {
        let belief = belief(view, BODIES, self.seed)?;
        let all = candidates(view, &belief, &Course::start(&belief, view.track));
        let least = worth(view, &belief);
        if let Some(instead) = self.idle.instead(view, &belief, least)? {
            return Ok(instead);
        }
        match first_largest(all.iter().map(|c| c.prediction.gain)) {
            Some((k, gain)) if gain > least => Ok(RollProposal {
                legs: vec![all[k].to],
                expected: Some(all[k].prediction),
                reason: Reason::Best,
            }),
            _ => self.idle.far(view, &belief, least),
        }
    }
}
