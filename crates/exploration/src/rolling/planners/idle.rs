//! What is done where promises are not kept: bodies drawn may all be wrong about what a motion brings.

use crate::knowledge::Knowledge;
use crate::planner::Reason;
use crate::random::Source;
use crate::rolling::belief::Belief;
use crate::rolling::flood::{far_motion, unreached};
use crate::rolling::planner::{RollPlanError, RollProposal, SPACING, View, targets};

/// Counts motions that brought no contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Idle {
    touches: usize,
    motions: usize,
    /// Contacts when it was first found that nothing reaches what is left, and how often since.
    touches_then: usize,
    tries: usize,
}

/// Motions without a contact after which a place farther away is looked for, and after which the body is shaken.
const FAR: usize = 2;
const SHAKEN: usize = 4;
/// Motions without a contact after which what is left counts as out of reach, whatever bodies drawn say.
const GIVEN_UP: usize = 40;
/// Times that a body is shaken before it is believed that nothing reaches what is left.
const TRIES: usize = 15;

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
        seed: u64,
    ) -> Result<Option<RollProposal>, RollPlanError> {
        let touches = view.known.touches();
        self.motions = if touches > self.touches { 0 } else { self.motions + 1 };
        self.touches = touches;
        match self.motions {
            0..FAR => Ok(None),
            FAR..SHAKEN => self.far(view, belief, least, seed).map(Some),
            SHAKEN..GIVEN_UP => Ok(Some(shaken(view, seed))),
            _ => Err(RollPlanError::NotFound { directions: unreached(view, belief) }),
        }
    }

    /// The way to a place farther away. That there is none is believed when other bodies drawn, after motions that let the body lie
    /// otherwise, say so too, with no contact in between.
    ///
    /// # Errors
    /// [`RollPlanError::NotFound`] after so many tries.
    pub(super) fn far(
        &mut self,
        view: &View<'_>,
        belief: &Belief,
        least: f64,
        seed: u64,
    ) -> Result<RollProposal, RollPlanError> {
        let touches = view.known.touches();
        if touches > self.touches_then {
            (self.touches_then, self.tries) = (touches, 0);
        }
        match far_motion(view, belief, least) {
            Err(RollPlanError::NotFound { .. }) if self.tries < TRIES => {
                self.tries += 1;
                Ok(shaken(view, seed))
            }
            way => way,
        }
    }
}

/// Any angles of the workspace: the body comes to lie otherwise.
fn shaken(view: &View<'_>, seed: u64) -> RollProposal {
    let all = targets(view.workspace, view.track.palms, SPACING);
    let drawn = Source::new(seed.wrapping_add(view.motion as u64)).unit();
    let to = all.get((drawn * all.len() as f64) as usize).copied().unwrap_or(view.track.palms);
    RollProposal { legs: vec![to], expected: None, reason: Reason::Sequence }
}
