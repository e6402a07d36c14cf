use super::{Stage, Touching, stage};
use crate::heading::Heading;
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};

/// Touches where a Gaussian process over implicit surfaces is least sure: a baseline, given the best length that is known for it, a
/// sphere as prior mean, normals as gradients, and no place twice. It has no proof of anything: the bounds of the loop have.
#[derive(Clone, Debug)]
pub struct GaussianVariance<H> {
    start: Vec<H>,
}

/// Directions closer than this, in rad, are one: without this bar the same place is touched for ever.
const REPEATED: f64 = 0.03;

impl<H> GaussianVariance<H> {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<H>) -> Self {
        Self { start }
    }
}

impl<K: Touching> Planner<K> for GaussianVariance<K::Heading> {
    fn name(&self) -> &'static str {
        "gaussian process"
    }

    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError> {
        if let Stage::Due(proposal) = stage(&self.start, situation)? {
            return Ok(proposal);
        }
        let (rays, variance) = (K::Heading::spread(K::RAYS), situation.known.variance());
        let mut best: Option<(K::Heading, f64)> = None;
        let apart = |along: &K::Heading| {
            situation.known.normals().map(|n| n.angle_to(*along)).fold(f64::INFINITY, f64::min)
        };
        let is_new = |along: &K::Heading| situation.limits.allow(*along) && apart(along) >= REPEATED;
        for (along, variance) in rays.iter().filter_map(|ray| variance(*ray)) {
            if is_new(&along) && best.is_none_or(|b| variance > b.1) {
                best = Some((along, variance));
            }
        }
        // With every normal of the surface touched, as on flats, or no surface at all: the ray that is farthest from all touches.
        let farthest = || {
            let rays = rays.iter().copied().filter(is_new);
            rays.max_by(|a, b| apart(a).total_cmp(&apart(b)))
        };
        let along = best.map(|b| b.0).or_else(farthest).ok_or(PlanError::NothingToGain)?;
        Ok(Proposal { along, ray: None, expected: None, reason: Reason::Variance })
    }
}
