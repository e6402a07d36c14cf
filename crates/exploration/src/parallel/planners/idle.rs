//! What is done where bodies drawn promise nothing, or what they promised was not kept.

use super::walk::Walk;
use crate::parallel::belief::DrawnBody;
use crate::parallel::hold::Stroke;
use crate::parallel::planner::{ParallelPlanError, ParallelProposal, ParallelView};
use crate::planner::Reason;
use std::f64::consts::FRAC_PI_2;

/// Strokes that no body drawn speaks for.
#[derive(Clone, Debug, Default)]
pub(super) struct Idle {
    walk: Walk,
}

/// The first strokes are crosswise and so long, rad: then normals span all directions.
const FIRST: f64 = 0.9;
/// There are so many of them: to all four sides.
const CROSSWISE: usize = 4;
/// Strokes without a contact after which bodies drawn are no longer asked.
const WALKED: usize = 3;

impl Idle {
    /// The stroke to be made in place of a planner's own: crosswise while the upper bound has no end, and where those before brought nothing one that was
    /// not made yet.
    ///
    /// # Errors
    /// Those of [`Self::walked`].
    pub(super) fn instead(
        &mut self,
        view: &ParallelView<'_>,
        bodies: &[DrawnBody],
    ) -> Result<Option<ParallelProposal>, ParallelPlanError> {
        if view.idle >= WALKED {
            return self.walked(view).map(Some);
        }
        let first = || {
            let stroke = Stroke { heading: view.stroke as f64 * FRAC_PI_2, turn: FIRST };
            ParallelProposal { stroke, expected: None, reason: Reason::Start }
        };
        match bodies.is_empty() {
            true if view.stroke < CROSSWISE => Ok(Some(first())),
            true => self.walked(view).map(Some),
            false => Ok(None),
        }
    }

    /// A stroke that was not made yet.
    ///
    /// # Errors
    /// [`ParallelPlanError::NotFound`] where there is none.
    pub(super) fn walked(&mut self, view: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError> {
        match self.walk.next(view) {
            Some(stroke) => Ok(ParallelProposal { stroke, expected: None, reason: Reason::Sequence }),
            None => Err(ParallelPlanError::NotFound { directions: view.farthest_gaps() }),
        }
    }
}
