//! What planners of touches need of the plane.

use super::PlanarKnowledge;
use super::caps::{Candidates, by_area, by_distance};
use super::start::golden;
use crate::gaussian::ImplicitSurface;
use crate::limits::Limits;
use crate::random::Source;
use crate::touching::{Score, Stand, Touching};
use glam::DVec2;
use shape_bounds::exact_hull::planar::{ConvexPolygon, Direction, Intersection};
use shape_bounds::planar::ShapeBounds;
use std::f64::consts::TAU;

impl Touching for PlanarKnowledge {
    type Closed<'a> = (&'a ShapeBounds, &'a ConvexPolygon);

    const GREEDY: &'static str = "area";

    const RAYS: usize = 120;

    fn stand(&self) -> Stand<'_, Self> {
        match self.bounds().map(|bounds| (bounds, bounds.upper())) {
            Some((bounds, Intersection::Bounded(upper))) => Stand::Closed((bounds, upper.shape())),
            Some((_, Intersection::Unbounded(open))) => Stand::Open(open.directions()),
            None => Stand::Nothing,
        }
    }

    fn normals(&self) -> impl Iterator<Item = Direction> {
        self.contacts().iter().map(|contact| contact.normal)
    }

    fn middle(of: &[Direction]) -> Option<Direction> {
        Direction::new(of.iter().map(|d| d.get()).sum::<DVec2>()).ok()
    }

    fn in_sequence(k: usize) -> Direction {
        golden(k)
    }

    fn drawn(source: &mut Source) -> Direction {
        Direction::from_angle(source.between(0.0, TAU))
    }

    fn variance(&self) -> impl Fn(Direction) -> Option<(Direction, f64)> {
        let felt = self.contacts().iter().map(|c| (c.point.to_array(), c.normal.get().to_array()));
        let surface = ImplicitSurface::about(&felt.collect::<Vec<_>>());
        move |ray| {
            let (gradient, variance) = surface.as_ref()?.along(&ray.get().to_array())?;
            Some((Direction::new(DVec2::from_array(gradient)).ok()?, variance))
        }
    }

    fn margin(&self) -> f64 {
        let prospects = self.prospects();
        prospects.out + prospects.inwards
    }

    fn sizes((_, upper): Self::Closed<'_>) -> [f64; 2] {
        [upper.area(), upper.perimeter()]
    }

    fn candidates(
        &self,
        (bounds, _): Self::Closed<'_>,
        score: Score,
        limits: &Limits<Direction>,
    ) -> Candidates {
        match score {
            Score::Volume => by_area(bounds, &self.prospects(), limits),
            Score::Distance => by_distance(bounds, &self.prospects(), limits),
        }
    }
}
