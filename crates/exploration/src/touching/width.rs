use super::Touching;
use crate::heading::Heading;
use crate::planner::{PlanError, Proposal, Reason, Situation};

/// The side of the width along `along` on which the bounds are further apart: one exact touch each closes it.
pub(super) fn width_touch<K: Touching>(
    situation: &Situation<'_, K>,
    along: K::Heading,
) -> Result<Proposal<K>, PlanError> {
    let room = |d: K::Heading| {
        let (lower, upper) = situation.known.support(d);
        upper - lower
    };
    let mut sides = [along, along.opposite()];
    sides.sort_by(|a, b| room(*b).total_cmp(&room(*a)));
    let margin = situation.known.margin();
    // Exact: beyond rounding. With noise: what a new touch leaves itself cannot be gained.
    let size = situation.known.mean_width();
    let gains = |d: &K::Heading| room(*d) > (1e-12 * size).max(margin);
    let wanted: Vec<K::Heading> = sides.into_iter().filter(gains).collect();
    match wanted.iter().find(|d| situation.limits.allow(**d)) {
        Some(side) => {
            let expected = Some(room(*side) - margin);
            Ok(Proposal { along: *side, ray: None, expected, reason: Reason::Width })
        }
        None if wanted.is_empty() => Err(PlanError::NothingToGain),
        None => Err(PlanError::Unreachable { directions: wanted.iter().map(|d| d.coordinates()).collect() }),
    }
}
