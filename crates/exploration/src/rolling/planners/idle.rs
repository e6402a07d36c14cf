//! What is done where promises are not kept: bodies drawn may all be wrong about what a motion brings.

use super::walk::Walk;
use crate::knowledge::Knowledge;
use crate::rolling::belief::Belief;
use crate::rolling::flood::{far_motion, unreached};
use crate::rolling::planner::{RollPlanError, RollProposal, View};

/// Counts motions that brought no contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Idle {
    touches: usize,
    motions: usize,
    walk: Walk,
}

/// Motions without a contact after which a place farther away is looked for, and after which bodies drawn are no longer asked.
const FAR: usize = 2;
const WALKED: usize = 4;

impl Idle {
    /// The motion to be made in place of a planner's own, if those before brought nothing.
    ///
    /// # Errors
    /// Those of [`Self::far`].
    pub(super) fn instead(
        &mut self,
        view: &View<'_>,
        belief: &Belief,
        least: f64,
    ) -> Result<Option<RollProposal>, RollPlanError> {
        let touches = view.known.touches();
        self.motions = if touches > self.touches { 0 } else { self.motions + 1 };
        self.touches = touches;
        match self.motions {
            0..FAR => Ok(None),
            FAR..WALKED => self.far(view, belief, least).map(Some),
            _ => self.walked(view, belief).map(Some),
        }
    }

    /// The way to a place farther away; where no body drawn has any, a step that was not made yet.
    ///
    /// # Errors
    /// [`RollPlanError::NotFound`] where all were made.
    pub(super) fn far(
        &mut self,
        view: &View<'_>,
        belief: &Belief,
        least: f64,
    ) -> Result<RollProposal, RollPlanError> {
        match far_motion(view, belief, least) {
            Some(way) => Ok(way),
            None => self.walked(view, belief),
        }
    }

    fn walked(&mut self, view: &View<'_>, belief: &Belief) -> Result<RollProposal, RollPlanError> {
        let none = || RollPlanError::NotFound { directions: unreached(view, belief) };
        self.walk.next(view, belief).ok_or_else(none)
    }
}
