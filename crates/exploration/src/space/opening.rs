//! What every planner does before there are two bounds to look at.

use super::SpaceKnowledge;
use super::sequence::low_discrepancy;
use crate::heading::Heading;
use crate::knowledge::Knowledge;
use crate::planner::{PlanError, Proposal, Reason, Situation};
use contact_kinematics::Direction;
use glam::DVec3;
use shape_bounds::ShapeBounds;
use shape_bounds::exact_hull::{Intersection, Polyhedron};
use std::f64::consts::FRAC_PI_2;

/// What there is to plan on.
pub(super) enum Stage<'a> {
    /// A touch that is due, whatever else is known.
    Due(Proposal<SpaceKnowledge>),
    /// Both bounds.
    Closed(&'a ShapeBounds, &'a Polyhedron),
}

/// The start, then whatever closes the upper bound.
pub(super) fn stage<'a>(
    start: &[Direction],
    situation: &Situation<'a, SpaceKnowledge>,
) -> Result<Stage<'a>, PlanError> {
    let due = |along: Direction, reason| {
        let along = situation.limits.nearest(along).ok_or_else(|| out_of_reach(&[along]))?;
        Ok(Stage::Due(Proposal { along, ray: None, expected: None, reason }))
    };
    let touches = situation.known.touches();
    if let Some(along) = start.get(touches) {
        return due(*along, Reason::Start);
    }
    match situation.known.bounds().map(|bounds| (bounds, bounds.upper())) {
        Some((bounds, Intersection::Bounded(upper))) => Ok(Stage::Closed(bounds, upper)),
        Some((_, Intersection::Unbounded(open))) => close(open.directions(), situation),
        // Too few contacts, or noise leaves nothing certain: any others help.
        None => due(low_discrepancy(touches), Reason::Sequence),
    }
}

/// A touch along a direction without end. Out of reach, none of its neighbours in reach must be one that was made already.
fn close<'a>(open: &[Direction], situation: &Situation<'a, SpaceKnowledge>) -> Result<Stage<'a>, PlanError> {
    // No touch ends a direction that is at right angles to all that can be reached, or behind them.
    let sum: DVec3 = open.iter().map(|d| d.get()).sum();
    let middle = Direction::new(sum).ok();
    let hopeless =
        |d: &Direction| situation.limits.nearest(*d).is_none_or(|h| h.angle_to(*d) > FRAC_PI_2 - SAME);
    let lost: Vec<Direction> = middle.into_iter().chain(open.iter().copied()).filter(hopeless).collect();
    if !lost.is_empty() {
        return Err(out_of_reach(&lost));
    }
    let known = situation.known.contacts();
    let is_new = |along: &Direction| known.iter().all(|c| c.normal.angle_to(*along) > SAME);
    let reachable = open.iter().filter_map(|d| situation.limits.nearest(*d)).find(is_new);
    match reachable {
        Some(along) => Ok(Stage::Due(Proposal { along, ray: None, expected: None, reason: Reason::Open })),
        None => Err(out_of_reach(open)),
    }
}

/// Normals closer than this, in rad, are one.
const SAME: f64 = 1e-3;

fn out_of_reach(wanted: &[Direction]) -> PlanError {
    PlanError::Unreachable { directions: wanted.iter().map(|d| d.coordinates()).collect() }
}
