use super::super::PlanarKnowledge;
use super::super::knowledge::Prospects;
use crate::heading::Heading;
use crate::knowledge::Knowledge;
use crate::planner::{PlanError, Proposal, Reason, Situation};
use shape_bounds::exact_hull::planar::Direction;

/// The side of the width along `along` on which the bounds are further apart: one exact touch each closes it.
pub(super) fn width_touch(
    situation: &Situation<'_, PlanarKnowledge>,
    along: Direction,
) -> Result<Proposal<PlanarKnowledge>, PlanError> {
    let room = |d: Direction| {
        let (lower, upper) = situation.known.support(d);
        upper - lower
    };
    let mut sides = [along, -along];
    sides.sort_by(|a, b| room(*b).total_cmp(&room(*a)));
    let Prospects { out, inwards, .. } = situation.known.prospects();
    // Exact: beyond rounding. With noise: what a new touch leaves itself cannot be gained.
    let size = situation.known.mean_width();
    let gains = |d: &Direction| room(*d) > (1e-12 * size).max(out + inwards);
    let wanted: Vec<Direction> = sides.into_iter().filter(gains).collect();
    match wanted.iter().find(|d| situation.limits.allow(**d)) {
        Some(side) => {
            let expected = Some(room(*side) - out - inwards);
            Ok(Proposal { along: *side, ray: None, expected, reason: Reason::Width })
        }
        None if wanted.is_empty() => Err(PlanError::NothingToGain),
        None => Err(PlanError::Unreachable { directions: wanted.iter().map(|d| d.coordinates()).collect() }),
    }
}
