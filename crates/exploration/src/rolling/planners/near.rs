use super::idle::Idle;
use super::{BODIES, first_largest};
use crate::planner::Reason;
use crate::rolling::balance::Rest;
use crate::rolling::belief::Belief;
use crate::rolling::metric::{PalmsInBody, distance};
use crate::rolling::planner::{
    Candidate, RollPlanError, RollPlanner, RollProposal, View, belief, candidates, worth,
};
use crate::rolling::predict::Course;

/// Of all motions that bring nearly as much as the best one, the one with the nearest end in the metric of configurations
/// (the paper's second strategy).
#[derive(Clone, Debug)]
pub struct NearestGap {
    seed: u64,
    share: f64,
    idle: Idle,
}

/// Share of the best gain that is enough.
const SHARE: f64 = 0.5;

impl NearestGap {
    /// With bodies of this seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { seed, share: SHARE, idle: Idle::default() }
    }

    /// With another share of the best gain that is enough, in [0, 1]; 1 is greedy.
    #[must_use]
    pub fn with_share(self, share: f64) -> Self {
        Self { share: share.clamp(0.0, 1.0), ..self }
    }
}

impl RollPlanner for NearestGap {
    fn name(&self) -> &'static str {
        "nearest gap"
    }

    fn next(&mut self, view: &View<'_>) -> Result<RollProposal, RollPlanError> {
        let belief = belief(view, BODIES, self.seed)?;
        let start = Course::start(&belief, view.track);
        let all = candidates(view, &belief, &start);
        let least = worth(view, &belief);
        if let Some(instead) = self.idle.instead(view, &belief, least)? {
            return Ok(instead);
        }
        let Some((best, gain)) = first_largest(all.iter().map(|c| c.prediction.gain)).filter(|b| b.1 > least)
        else {
            return self.idle.far(view, &belief, least);
        };
        let good = (0..all.len()).filter(|k| all[*k].prediction.gain >= self.share * gain);
        let way = |k: &usize| mean_distance(view, &belief, &start, &all[*k]);
        let nearest = good.map(|k| (k, way(&k))).min_by(|a, b| a.1.total_cmp(&b.1));
        let k = nearest.map_or(best, |(k, _)| k);
        let reason = if k == best { Reason::Best } else { Reason::Near };
        Ok(RollProposal { legs: vec![all[k].to], expected: Some(all[k].prediction), reason })
    }
}

/// Distance (m) of both ends of a motion, mean over the bodies that are not lost.
fn mean_distance(view: &View<'_>, belief: &Belief, start: &Course, candidate: &Candidate) -> f64 {
    let place = |k: usize, course: &Course| {
        let rest = Rest { phi: course.swings[k]?.0, turned: 0.0 };
        PalmsInBody::of(&belief.bodies[k], course.palms, &rest)
    };
    let one = |k: usize| {
        let (from, to) = (place(k, start)?, place(k, &candidate.course)?);
        distance(&from, &to, 0.5 * view.workspace.size).ok()
    };
    let ways: Vec<f64> = (0..belief.bodies.len()).filter_map(one).collect();
    ways.iter().sum::<f64>() / ways.len().max(1) as f64
}
