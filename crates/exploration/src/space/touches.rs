//! What planners of touches need of space.

use super::SpaceKnowledge;
use super::candidates::{Candidates, candidates};
use super::sequence::low_discrepancy;
use crate::gaussian::ImplicitSurface;
use crate::limits::Limits;
use crate::random::Source;
use crate::touching::{Candidate, Score, Stand, Touching};
use contact_kinematics::Direction;
use glam::DVec3;
use shape_bounds::ShapeBounds;
use shape_bounds::exact_hull::{Intersection, Polyhedron};

impl Touching for SpaceKnowledge {
    type Closed<'a> = (&'a ShapeBounds, &'a Polyhedron);

    const GREEDY: &'static str = "volume";

    const RAYS: usize = 300;

    fn stand(&self) -> Stand<'_, Self> {
        match self.bounds().map(|bounds| (bounds, bounds.upper())) {
            Some((bounds, Intersection::Bounded(upper))) => Stand::Closed((bounds, upper)),
            Some((_, Intersection::Unbounded(open))) => Stand::Open(open.directions()),
            None => Stand::Nothing,
        }
    }

    fn normals(&self) -> impl Iterator<Item = Direction> {
        self.contacts().iter().map(|contact| contact.normal)
    }

    fn middle(of: &[Direction]) -> Option<Direction> {
        Direction::new(of.iter().map(|d| d.get()).sum::<DVec3>()).ok()
    }

    fn in_sequence(k: usize) -> Direction {
        low_discrepancy(k)
    }

    fn drawn(source: &mut Source) -> Direction {
        source.direction()
    }

    fn variance(&self) -> impl Fn(Direction) -> Option<(Direction, f64)> {
        let felt = self.contacts().iter().map(|c| (c.point.to_array(), c.normal.get().to_array()));
        let surface = ImplicitSurface::about(&felt.collect::<Vec<_>>());
        move |ray| {
            let (gradient, variance) = surface.as_ref()?.along(&ray.get().to_array())?;
            Some((Direction::new(DVec3::from_array(gradient)).ok()?, variance))
        }
    }

    fn margin(&self) -> f64 {
        let prospects = self.prospects();
        prospects.out + prospects.inwards
    }

    fn sizes((_, upper): Self::Closed<'_>) -> [f64; 2] {
        [upper.volume(), upper.moments().area.sqrt()]
    }

    fn candidates(
        &self,
        (bounds, upper): Self::Closed<'_>,
        score: Score,
        limits: &Limits<Direction>,
    ) -> Candidates {
        candidates(bounds, upper, score, &self.prospects(), limits)
    }

    /// Without limits by a search that makes few corners exact.
    fn farthest(&self, closed: Self::Closed<'_>, limits: &Limits<Direction>) -> Candidates {
        if !limits.are_none() {
            return self.candidates(closed, Score::Distance, limits);
        }
        let (bounds, upper) = closed;
        let mut found = Candidates::none();
        found.within.extend(bounds.largest_gap().map(|gap| {
            // Deeper than the nearest point, which may be a contact that a ray would only meet again.
            let aim = gap.inner.midpoint(upper.moments().centroid);
            Candidate { along: gap.direction, ray: [gap.outer, aim], score: gap.distance }
        }));
        found
    }
}
