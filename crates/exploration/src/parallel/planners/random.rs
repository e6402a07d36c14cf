use crate::parallel::hold::Stroke;
use crate::parallel::planner::{ParallelPlanError, ParallelPlanner, ParallelProposal, ParallelView};
use crate::planner::Reason;
use crate::random::Source;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Strokes in any direction, of any length up to a quarter turn of the body.
#[derive(Clone, Debug)]
pub struct RandomStrokes {
    source: Source,
}

impl RandomStrokes {
    /// Of this seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { source: Source::new(seed) }
    }
}

impl ParallelPlanner for RandomStrokes {
    fn name(&self) -> &'static str {
        "random"
    }

    fn next(&mut self, _: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError> {
        let stroke =
            Stroke { heading: self.source.between(0.0, TAU), turn: self.source.between(0.0, FRAC_PI_2) };
        Ok(ParallelProposal { stroke, expected: None, reason: Reason::Sequence })
    }
}
