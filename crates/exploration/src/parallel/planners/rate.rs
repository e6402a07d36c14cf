use super::BODIES;
use super::idle::Idle;
use crate::parallel::hold::Stroke;
use crate::parallel::planner::{ParallelPlanError, ParallelPlanner, ParallelProposal, ParallelView};
use crate::parallel::predict::{Course, Prediction};
use crate::planner::Reason;

/// The first of a few strokes that together bring most per way of the upper palm, found by a beam search.
#[derive(Clone, Debug)]
pub struct PathRate {
    seed: u64,
    horizon: usize,
    bodies: usize,
    idle: Idle,
}

/// Courses that are followed up at each depth.
const BEAM: usize = 4;
/// A stroke is charged this much beyond its own way, in sizes: who stops and plans has moved a little for nothing.
const EACH: f64 = 0.1;

impl PathRate {
    /// Looking `horizon` strokes ahead (1 looks no further than the next), on bodies of this seed.
    #[must_use]
    pub fn new(seed: u64, horizon: usize) -> Self {
        Self { seed, horizon: horizon.max(1), bodies: BODIES, idle: Idle::default() }
    }

    /// On so many bodies drawn, one at least.
    #[must_use]
    pub fn with_bodies(self, bodies: usize) -> Self {
        Self { bodies: bodies.max(1), ..self }
    }
}

/// Where the first stroke of a course goes, and what it brings.
type First = (Stroke, Prediction);

impl ParallelPlanner for PathRate {
    fn name(&self) -> &'static str {
        "gap per way"
    }

    fn next(&mut self, view: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError> {
        let bodies = view.bodies(self.bodies, self.seed);
        if let Some(instead) = self.idle.instead(view, &bodies)? {
            return Ok(instead);
        }
        let mut beam: Vec<(Course, Option<First>)> = vec![(Course::start(&bodies, view.hold), None)];
        let (aims, worth) = (view.farthest_gaps(), view.worth());
        let mut best: Option<(f64, First)> = None;
        for depth in 0..self.horizon {
            let mut found: Vec<(f64, Course, First)> = Vec::new();
            for (course, first) in &beam {
                for c in view.candidates(&bodies, course, &aims) {
                    let p = c.prediction;
                    if p.gain > worth {
                        let rate = p.gain / (p.way + EACH * view.workspace.size * (depth + 1) as f64);
                        found.push((rate, c.course, first.unwrap_or((c.stroke, p))));
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
        let Some((_, (stroke, expected))) = best else { return self.idle.walked(view) };
        Ok(ParallelProposal { stroke, expected: Some(expected), reason: Reason::Best })
    }
}
