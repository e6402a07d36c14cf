use crate::parallel::hold::Stroke;
use crate::parallel::planner::{ParallelPlanError, ParallelPlanner, ParallelProposal, ParallelView};
use crate::planner::Reason;
use std::f64::consts::{FRAC_PI_2, PI};

/// Strokes that look at nothing: to and fro along one heading, a step to the side in between.
#[derive(Clone, Debug, Default)]
pub struct RasterSweep;

/// Turns of a long stroke and of a step to the side, rad: one after the other twice as far as a contact is from the next.
const LONG: f64 = 2.0;
const ASIDE: f64 = 0.4;
/// After so many strokes the raster is turned by a right angle.
const RASTER: usize = 16;

impl RasterSweep {
    /// From a long stroke on.
    #[must_use]
    pub fn new() -> Self {
        Self
    }
}

impl ParallelPlanner for RasterSweep {
    fn name(&self) -> &'static str {
        "fixed sweep"
    }

    fn next(&mut self, view: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError> {
        let k = view.stroke % RASTER;
        let across = FRAC_PI_2 * (view.stroke / RASTER) as f64;
        let (heading, turn) = match k % 4 {
            0 => (0.0, LONG),
            2 => (PI, LONG),
            _ => (FRAC_PI_2, ASIDE),
        };
        let stroke = Stroke { heading: across + heading, turn };
        Ok(ParallelProposal { stroke, expected: None, reason: Reason::Sequence })
    }
}
