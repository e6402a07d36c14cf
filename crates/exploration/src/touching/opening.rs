//! What every planner does before there are two bounds to look at.

use super::{Stand, Touching};
use crate::heading::Heading;
use crate::planner::{PlanError, Proposal, Reason, Situation};
use std::f64::consts::FRAC_PI_2;

/// What there is to plan on.
pub(crate) enum Stage<'a, K: Touching + 'a> {
    /// A touch that is due, whatever else is known.
    Due(Proposal<K>),
    /// Both bounds.
    Closed(K::Closed<'a>),
}

/// The start, then whatever closes the upper bound.
pub(crate) fn stage<'a, K: Touching>(
    start: &[K::Heading],
    situation: &Situation<'a, K>,
) -> Result<Stage<'a, K>, PlanError> {
    let due = |along: K::Heading, reason| {
        let along = situation.limits.nearest(along).ok_or_else(|| out_of_reach(&[along]))?;
        Ok(Stage::Due(Proposal { along, ray: None, expected: None, reason }))
    };
    let touches = situation.known.touches();
    if let Some(along) = start.get(touches) {
        return due(*along, Reason::Start);
    }
    match situation.known.stand() {
        Stand::Closed(closed) => Ok(Stage::Closed(closed)),
        Stand::Open(open) => close(open, situation),
        // Any others help.
        Stand::Nothing => due(K::in_sequence(touches), Reason::Sequence),
    }
}

/// A touch along a direction without end. Out of reach, none of its neighbours in reach must be one that was made already.
fn close<'a, K: Touching>(
    open: &[K::Heading],
    situation: &Situation<'a, K>,
) -> Result<Stage<'a, K>, PlanError> {
    // No touch ends a direction that is at right angles to all that can be reached, or behind them.
    let middle = K::middle(open);
    let hopeless =
        |d: &K::Heading| situation.limits.nearest(*d).is_none_or(|h| h.angle_to(*d) > FRAC_PI_2 - SAME);
    let lost: Vec<K::Heading> = middle.into_iter().chain(open.iter().copied()).filter(hopeless).collect();
    if !lost.is_empty() {
        return Err(out_of_reach(&lost));
    }
    let is_new = |along: &K::Heading| situation.known.normals().all(|n| n.angle_to(*along) > SAME);
    let reachable = open.iter().filter_map(|d| situation.limits.nearest(*d)).find(is_new);
    match reachable {
        Some(along) => Ok(Stage::Due(Proposal { along, ray: None, expected: None, reason: Reason::Open })),
        None => Err(out_of_reach(open)),
    }
}

/// Normals closer than this, in rad, are one.
const SAME: f64 = 1e-3;

fn out_of_reach<H: Heading>(wanted: &[H]) -> PlanError {
    PlanError::Unreachable { directions: wanted.iter().map(|d| d.coordinates()).collect() }
}
