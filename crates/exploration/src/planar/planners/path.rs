use super::super::PlanarKnowledge;
use super::super::caps::{Candidates, by_area, by_distance};
use super::super::opening::{Stage, stage};
use super::width::width_touch;
use super::{NOTHING, OVERESTIMATE, best, proposal};
use crate::goal::Goal;
use crate::heading::Heading;
use crate::knowledge::Knowledge;
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use shape_bounds::exact_hull::planar::Direction;

/// Of all touches that pay nearly as much as the best one, takes the nearest: three quarters of the way of a greedy planner for a few
/// per cent more touches.
///
/// The score is that of the goal: expected loss of area for a gap, the distance of the bounds for a Hausdorff distance, and the two
/// directions of a width. This is the planner to start with.
#[derive(Clone, Debug)]
pub struct PathAware {
    start: Vec<Direction>,
    share: f64,
}

/// Share of the best score that is enough: 0.77 of the way for 1.02 of the touches.
const SHARE: f64 = 0.5;

/// Power of the share where distances are scored: what is nearly the largest is most of what there is to touch, and all of it must be
/// touched in the end. 0.9 of the largest is enough then.
const OF_DISTANCE: f64 = 0.2;

impl PathAware {
    /// With these first touches and a share of 0.5.
    #[must_use]
    pub fn new(start: Vec<Direction>) -> Self {
        Self { start, share: SHARE }
    }

    /// With another share of the best score that is enough, in [0, 1]: 1 is greedy, 0.3 where motion is dear.
    #[must_use]
    pub fn with_share(self, share: f64) -> Self {
        Self { share: share.clamp(0.0, 1.0), ..self }
    }
}

/// Where the best touch is expected to come this near to the goal, or nearer, in terms of what is left, only touches that are expected
/// to reach it are near enough: one that is spared is worth more than its way.
const NEARLY: f64 = 1.3;

impl Planner<PlanarKnowledge> for PathAware {
    fn name(&self) -> &'static str {
        "path-aware"
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
        let (found, share, least) = match situation.goal {
            Goal::Gap(_) => {
                (by_area(bounds, &prospects, situation.limits), self.share, NOTHING * upper.area())
            }
            Goal::Hausdorff(_) => {
                let found = by_distance(bounds, &prospects, situation.limits);
                (found, self.share.powf(OF_DISTANCE), NOTHING * upper.perimeter())
            }
            Goal::Width { along, .. } => return width_touch(situation, *along),
        };
        let best = best(&found, least)?;
        let finish = last_step(situation, upper.area());
        let enough = if finish < NEARLY * best.score { finish.min(best.score) } else { 0.0 };
        let enough = enough.max(share * best.score);
        let chosen = situation.here.map_or(best, |here| nearest(&found, enough, here, best));
        let reason = if chosen == best { Reason::Best } else { Reason::Near };
        Ok(proposal(chosen, reason))
    }
}

/// The score that is expected to reach the goal in one touch; infinite where the score is not in the unit of the goal.
fn last_step(situation: &Situation<'_, PlanarKnowledge>, upper: f64) -> f64 {
    match situation.goal {
        Goal::Gap(goal) => (situation.known.measures().gap() - goal) * upper / OVERESTIMATE,
        _ => f64::INFINITY,
    }
}

/// The candidate nearest to `here` of those with a score of `enough`.
fn nearest(found: &Candidates, enough: f64, here: Direction, best: super::Candidate) -> super::Candidate {
    let good = found.within.iter().filter(|c| c.score >= enough);
    // The first of several that are equally near.
    good.min_by(|a, b| a.along.angle_to(here).total_cmp(&b.along.angle_to(here))).copied().unwrap_or(best)
}
