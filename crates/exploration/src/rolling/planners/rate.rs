use super::BODIES;
use super::idle::Idle;
use crate::planner::Reason;
use crate::rolling::planner::{RollPlanError, RollPlanner, RollProposal, View, belief, candidates, worth};
use crate::rolling::predict::{Course, Prediction};

/// What a rate is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cost {
    Seconds,
    Radians,
}

/// The first of a few motions that together bring most per second, found by a beam search.
#[derive(Clone, Debug)]
pub struct InformationRate {
    seed: u64,
    horizon: usize,
    bodies: usize,
    cost: Cost,
    idle: Idle,
}

/// Where the first motion of a course goes, and what it brings.
type First = ([f64; 2], Prediction);

/// Courses that are followed up at each depth.
const BEAM: usize = 6;
/// A motion is charged this much beyond its own way, in s or rad: who stops and plans has moved a little for nothing.
const EACH: f64 = 0.2;

impl InformationRate {
    /// Looking `horizon` motions ahead (2 or 3; 1 looks no further than the next), on bodies of this seed.
    #[must_use]
    pub fn new(seed: u64, horizon: usize) -> Self {
        let horizon = horizon.max(1);
        Self { seed, horizon, bodies: BODIES, cost: Cost::Seconds, idle: Idle::default() }
    }

    /// Per radian of palm motion in place of per second.
    #[must_use]
    pub fn per_radian(self) -> Self {
        Self { cost: Cost::Radians, ..self }
    }

    /// On so many bodies drawn, one at least.
    #[must_use]
    pub fn with_bodies(self, bodies: usize) -> Self {
        Self { bodies: bodies.max(1), ..self }
    }

    fn rate(&self, p: &Prediction, depth: usize) -> f64 {
        let cost = match self.cost {
            Cost::Seconds => p.seconds,
            Cost::Radians => p.radians,
        };
        p.gain / (cost + EACH * (depth + 1) as f64)
    }
}

impl RollPlanner for InformationRate {
    fn name(&self) -> &'static str {
        match self.cost {
            Cost::Seconds => "gap per second",
            Cost::Radians => "gap per radian",
        }
    }

    fn next(&mut self, view: &View<'_>) -> Result<RollProposal, RollPlanError> {
        let belief = belief(view, self.bodies, self.seed)?;
        let least = worth(view, &belief);
        if let Some(instead) = self.idle.instead(view, &belief, least)? {
            return Ok(instead);
        }
        // Courses, each with the first of its motions.
        let mut beam: Vec<(Course, Option<First>)> = vec![(Course::start(&belief, view.track), None)];
        let mut best: Option<(f64, First)> = None;
        for depth in 0..self.horizon {
            let mut found: Vec<(f64, Course, First)> = Vec::new();
            for (course, first) in &beam {
                for c in candidates(view, &belief, course) {
                    if c.prediction.gain > least {
                        let rate = self.rate(&c.prediction, depth);
                        found.push((rate, c.course, first.unwrap_or((c.to, c.prediction))));
                    }
                }
            }
            // Stable: ties stay in the order of candidates.
            found.sort_by(|a, b| b.0.total_cmp(&a.0));
            if let Some((rate, _, first)) = found.first()
                && best.is_none_or(|(b, _)| *rate > b)
            {
                best = Some((*rate, *first));
            }
            beam = found.into_iter().take(BEAM).map(|(_, course, first)| (course, Some(first))).collect();
        }
        match best {
            Some((_, (to, prediction))) => {
                Ok(RollProposal { legs: vec![to], expected: Some(prediction), reason: Reason::Best })
            }
            None => self.idle.far(view, &belief, least),
        }
    }
}
