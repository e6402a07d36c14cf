use super::super::PlanarKnowledge;
use super::super::opening::{Stage, stage};
use crate::gaussian::ImplicitSurface;
use crate::heading::Heading;
use crate::knowledge::Knowledge;
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};
use glam::DVec2;
use shape_bounds::exact_hull::planar::Direction;

/// Touches where a Gaussian process over implicit surfaces is least sure: a baseline, given the best length that is known for it, a
/// sphere as prior mean, normals as gradients, and no place twice. It has no proof of anything: the bounds of the loop have.
#[derive(Clone, Debug)]
pub struct GaussianVariance {
    start: Vec<Direction>,
    rays: Vec<Direction>,
}

/// Rays along which the surface is looked at.
const RAYS: usize = 120;
/// Directions closer than this, in rad, are one: without this bar the same place is touched for ever.
const REPEATED: f64 = 0.03;

impl GaussianVariance {
    /// With these first touches.
    #[must_use]
    pub fn new(start: Vec<Direction>) -> Self {
        Self { start, rays: Direction::spread(RAYS) }
    }
}

impl Planner<PlanarKnowledge> for GaussianVariance {
    fn name(&self) -> &'static str {
        "gaussian process"
    }

    fn next(
        &mut self,
        situation: &Situation<'_, PlanarKnowledge>,
    ) -> Result<Proposal<PlanarKnowledge>, PlanError> {
        if let Stage::Due(proposal) = stage(&self.start, situation)? {
            return Ok(proposal);
        }
        let contacts = situation.known.contacts();
        let count = situation.known.touches() as f64;
        let centre = contacts.iter().map(|c| c.point).sum::<DVec2>() / count;
        let radius = contacts.iter().map(|c| c.point.distance(centre)).sum::<f64>() / count;
        let scaled: Vec<_> = contacts
            .iter()
            .map(|c| (((c.point - centre) / radius).to_array(), c.normal.get().to_array()))
            .collect();
        let surface = ImplicitSurface::new(&scaled);
        let mut best: Option<(Direction, f64)> = None;
        let is_new = |along: &Direction| {
            situation.limits.allow(*along) && contacts.iter().all(|c| c.normal.angle_to(*along) >= REPEATED)
        };
        for ray in &self.rays {
            let found = surface.as_ref().and_then(|s| s.along(&ray.get().to_array()));
            let Some((gradient, variance)) = found else { continue };
            let Ok(along) = Direction::new(DVec2::from_array(gradient)) else { continue };
            if is_new(&along) && best.is_none_or(|b| variance > b.1) {
                best = Some((along, variance));
            }
        }
        // With every normal of the surface touched, as on flats, or no surface at all: the ray that is farthest from all touches.
        let apart = |along: &Direction| {
            contacts.iter().map(|c| c.normal.angle_to(*along)).fold(f64::INFINITY, f64::min)
        };
        let farthest = || {
            let rays = self.rays.iter().copied().filter(is_new);
            rays.max_by(|a, b| apart(a).total_cmp(&apart(b)))
        };
        let along = best.map(|b| b.0).or_else(farthest).ok_or(PlanError::NothingToGain)?;
        Ok(Proposal { along, ray: None, expected: None, reason: Reason::Variance })
    }
}
