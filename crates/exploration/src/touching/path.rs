use super::width::width_touch;
use super::{CandidateOf, CandidatesOf, NOTHING, OVERESTIMATE, Score, Stage, Touching, proposal, stage};
use crate::goal::Goal;
use crate::heading::Heading;
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};

/// Of all touches that pay nearly as much as the best one, takes the nearest: half the way of a greedy planner in space, and three quarters
/// in the plane, for a few per cent more touches.
///
/// The score is that of the goal: expected loss of volume (area) for a gap, the distance of the bounds for a Hausdorff distance, and the two
/// directions of a width. This is the planner to start with.
#[derive(Clone, Debug)]
pub struct PathAware<H> {
    start: Vec<H>,
    /// Where it is not that of the side.
    share: Option<f64>,
}

/// Power of the share where distances are scored: what is nearly the largest is most of what there is to touch, and all of it must be
/// touched in the end. 0.9 of the largest is enough then.
const OF_DISTANCE: f64 = 0.2;

impl<H> PathAware<H> {
    /// With these first touches and a share of 0.55, in the plane 0.5.
    #[must_use]
    pub fn new(start: Vec<H>) -> Self {
        Self { start, share: None }
    }

    /// With another share of the best score that is enough, in [0, 1]: 1 is greedy, 0.3 where motion is dear.
    #[must_use]
    pub fn with_share(self, share: f64) -> Self {
        Self { share: Some(share.clamp(0.0, 1.0)), ..self }
    }
}

/// Where the best touch is expected to come this near to the goal, or nearer, in terms of what is left, only touches that are expected
/// to reach it are near enough: one that is spared is worth more than its way.
const NEARLY: f64 = 1.3;

impl<K: Touching> Planner<K> for PathAware<K::Heading> {
    fn name(&self) -> &'static str {
        "path-aware"
    }

    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError> {
        let closed = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(closed) => closed,
        };
        let ([volume, length], share) = (K::sizes(closed), self.share.unwrap_or(K::SHARE));
        let (score, share, least) = match situation.goal {
            Goal::Gap(_) => (Score::Volume, share, NOTHING * volume),
            Goal::Hausdorff(_) => (Score::Distance, share.powf(OF_DISTANCE), NOTHING * length),
            Goal::Width { along, .. } => return width_touch(situation, *along),
        };
        let found = situation.known.candidates(closed, score, situation.limits);
        let best = found.best(least)?;
        let finish = last_step(situation, volume);
        let enough = if finish < NEARLY * best.score { finish.min(best.score) } else { 0.0 };
        let enough = enough.max(share * best.score);
        let chosen = situation.here.map_or(best, |here| nearest::<K>(&found, enough, here, best));
        let reason = if chosen == best { Reason::Best } else { Reason::Near };
        Ok(proposal(chosen, reason))
    }
}

/// The score that is expected to reach the goal in one touch; infinite where the score is not in the unit of the goal.
fn last_step<K: Touching>(situation: &Situation<'_, K>, upper: f64) -> f64 {
    match situation.goal {
        Goal::Gap(goal) => (situation.known.measures().gap() - goal) * upper / OVERESTIMATE,
        _ => f64::INFINITY,
    }
}

/// The candidate nearest to `here` of those with a score of `enough`.
fn nearest<K: Touching>(
    found: &CandidatesOf<K>,
    enough: f64,
    here: K::Heading,
    best: CandidateOf<K>,
) -> CandidateOf<K> {
    let good = found.within.iter().filter(|c| c.score >= enough);
    // The first of several that are equally near.
    good.min_by(|a, b| a.along.angle_to(here).total_cmp(&b.along.angle_to(here))).copied().unwrap_or(best)
}
