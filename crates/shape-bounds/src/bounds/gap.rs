//! Where the bounds are apart: distances from the corners of the upper bound to the lower one.

use crate::distance::{distance_to_triangle, farthest_of, nearest};
use contact_kinematics::Direction;
use exact_hull::Polyhedron;
use exact_hull::{Hull, SupportWalk};
use glam::DVec3;

/// Where, and how far, the bounds are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Direction, in the body's frame, in which the upper bound exceeds the lower one.
    pub direction: Direction,
    /// The point of the upper bound.
    pub outer: DVec3,
    /// The nearest point of the lower bound.
    pub inner: DVec3,
    /// Their distance in m.
    pub distance: f64,
}

/// Distances from corners of the upper bound. Each search starts where the lower bound supports the planes of its corner: near
/// the nearest point, so that the climbs over the lower bound are short.
pub(super) struct GapSearch<'a> {
    upper: &'a Polyhedron,
    lower: LowerBound<'a>,
    /// For each face of the upper bound, the point of the lower bound farthest along its normal, and where that is.
    supports: Vec<(DVec3, u32)>,
}

/// Corners that are tried in the order of how large their gap can be: enough for a gap that rules most others out.
const TRIED_FIRST: usize = 1000;

/// Support points of the lower bound.
enum LowerBound<'a> {
    Solid(SupportWalk<'a>),
    /// Without interior: the few corners that there are.
    Flat(&'a [DVec3]),
}

impl LowerBound<'_> {
    fn farthest(&mut self, d: DVec3) -> DVec3 {
        match self {
            Self::Solid(walk) => walk.farthest(d),
            Self::Flat(corners) => farthest_of(corners, d),
        }
    }

    /// Where the next climb starts.
    fn place(&self) -> u32 {
        match self {
            Self::Solid(walk) => walk.corner(),
            Self::Flat(_) => 0,
        }
    }

    /// A triangle of the lower bound that is nearest to `query`, and a corner of it, by descent over the facets around corners,
    /// which ends at the nearest one, or at the first within `enough`. `None` without facets.
    fn near_triangle(&self, query: DVec3, place: u32, enough: f64) -> Option<(f64, u32, [DVec3; 3])> {
        let Self::Solid(walk) = self else { return None };
        let hull = walk.hull();
        let mut best = (f64::INFINITY, place, [DVec3::ZERO; 3]);
        let mut around = Some(place);
        while let Some(corner) = around.take() {
            for facet in hull.facets_around(corner) {
                let triangle = hull.corners(facet as usize);
                let distance = distance_to_triangle(query, triangle);
                if distance < best.0 {
                    let nearer = |a: &u32, b: &u32| {
                        let to = |v: u32| hull.vertices()[v as usize].distance_squared(query);
                        to(*a).total_cmp(&to(*b))
                    };
                    let next =
                        hull.triangles()[facet as usize].into_iter().filter(|v| *v != corner).min_by(nearer);
                    best = (distance, corner, triangle);
                    around = next;
                }
            }
            if best.0 <= enough {
                break;
            }
        }
        Some(best)
    }

    fn go_to(&mut self, place: u32) {
        if let Self::Solid(walk) = self {
            walk.start_at(place);
        }
    }
}

impl<'a> GapSearch<'a> {
    /// Prepares the search between `upper` and the hull `lower` with these `corners`.
    pub(super) fn new(upper: &'a Polyhedron, lower: &'a Hull, corners: &'a [DVec3]) -> Self {
        let lower = match lower.solid() {
            Some(solid) => LowerBound::Solid(SupportWalk::new(solid)),
            None => LowerBound::Flat(corners),
        };
        let mut search = Self { upper, lower, supports: Vec::new() };
        search.find_supports();
        search
    }

    /// The support points of all faces, from face to neighbouring face, so that each climb is short.
    fn find_supports(&mut self) {
        let unknown = (DVec3::ZERO, u32::MAX);
        self.supports = vec![unknown; self.upper.face_count()];
        let mut queue = Vec::with_capacity(self.upper.face_count());
        for first in 0..self.upper.face_count() as u32 {
            if self.supports[first as usize].1 == u32::MAX {
                self.support_face(first);
                queue.push(first);
            }
            while let Some(face) = queue.pop() {
                let upper = self.upper;
                upper.for_each_neighbouring_face(face, |next| {
                    if self.supports[next as usize].1 == u32::MAX {
                        self.lower.go_to(self.supports[face as usize].1);
                        self.support_face(next);
                        queue.push(next);
                    }
                });
            }
        }
    }

    fn support_face(&mut self, face: u32) {
        let normal = self.upper.face_half_spaces()[face as usize].normal.get();
        let point = self.lower.farthest(normal);
        self.supports[face as usize] = (point, self.lower.place());
    }

    /// The gap at a corner; `None` where it is below rounding and has no direction, or at most `enough`.
    pub(super) fn at_corner(&mut self, corner: usize, enough: f64) -> Option<Gap> {
        let outer = self.upper.vertices()[corner];
        let supports = self.upper.faces_at(corner).map(|f| self.supports[f as usize]);
        let mut start = supports.map(|(point, _)| point);
        let mut place = supports[0].1;
        if let Some((distance, near, triangle)) = self.lower.near_triangle(outer, place, enough) {
            if distance <= enough {
                return None;
            }
            (place, start) = (near, triangle);
        }
        self.lower.go_to(place);
        let found = nearest(outer, &start, |d| self.lower.farthest(d));
        let direction = Direction::new(found.direction).ok()?;
        Some(Gap { direction, outer, inner: found.point, distance: found.certified })
    }

    /// The gap is at most this: the distance to a triangle whose corners are in the lower bound.
    pub(super) fn at_most(&self, corner: usize) -> f64 {
        let triangle = self.upper.faces_at(corner).map(|f| self.supports[f as usize].0);
        distance_to_triangle(self.upper.vertices()[corner], triangle)
    }

    /// The largest gap: that of the corners where it can be largest first, then of all that can have a larger one, as they
    /// lie in memory, which is from neighbour to neighbour.
    pub(super) fn largest(&mut self) -> Option<Gap> {
        let at_most: Vec<f64> = (0..self.upper.vertices().len()).map(|v| self.at_most(v)).collect();
        let larger = |x: &u32, y: &u32| at_most[*y as usize].total_cmp(&at_most[*x as usize]);
        let mut first: Vec<u32> = (0..at_most.len() as u32).collect();
        if first.len() > TRIED_FIRST {
            first.select_nth_unstable_by(TRIED_FIRST, larger);
            first.truncate(TRIED_FIRST);
        }
        first.sort_unstable_by(larger);
        let mut best: Option<Gap> = None;
        for corner in first.into_iter().map(|k| k as usize).chain(0..at_most.len()) {
            let known = best.map_or(0.0, |gap| gap.distance);
            if best.is_some() && known >= at_most[corner] {
                continue;
            }
            let gap = self.at_corner(corner, known);
            best = best.into_iter().chain(gap).max_by(|x, y| x.distance.total_cmp(&y.distance));
        }
        best
    }
}
