//! Support points of a hull of any dimension.

use super::{Hull, SupportWalk};
use glam::DVec3;

/// Support points of a hull of any dimension, by index into the points. A climb starts at a point that the caller
/// expects to be near: for the point of a contact its own, which on a convex body is the farthest along its normal.
#[derive(Clone, Debug)]
pub struct Farthest<'a> {
    points: &'a [DVec3],
    shape: Shape<'a>,
    /// For each point the corner that it is.
    corner: Vec<u32>,
}

#[derive(Clone, Debug)]
enum Shape<'a> {
    Few(Vec<usize>),
    /// Corners in order around a polygon, and where the next climb starts.
    Ring(&'a [usize], usize),
    Solid(SupportWalk<'a>, &'a [u32]),
}

/// The point is no corner.
const NONE: u32 = u32::MAX;

impl<'a> Farthest<'a> {
    /// The hull of `points`, which must be theirs.
    #[must_use]
    pub fn new(hull: &'a Hull, points: &'a [DVec3]) -> Self {
        let mut corner = vec![NONE; points.len()];
        let shape = match hull {
            Hull::Point(k) => Shape::Few(vec![*k]),
            Hull::Segment(ends) => Shape::Few(ends.to_vec()),
            Hull::Polygon(ring) => {
                ring.iter().enumerate().for_each(|(at, k)| corner[*k] = at as u32);
                Shape::Ring(ring, 0)
            }
            Hull::Solid(solid) => {
                let sources = solid.sources();
                sources.iter().enumerate().for_each(|(at, k)| corner[*k as usize] = at as u32);
                Shape::Solid(SupportWalk::new(solid), sources)
            }
        };
        Self { points, shape, corner }
    }

    /// The point that is the farthest along `n`; the climb starts at the point `own` if that is a corner.
    pub fn along(&mut self, n: DVec3, own: usize) -> usize {
        let (points, start) = (self.points, self.corner[own]);
        let height = |k: usize| n.dot(points[k]);
        match &mut self.shape {
            Shape::Few(all) => {
                all.iter().copied().max_by(|a, b| height(*a).total_cmp(&height(*b))).unwrap_or(own)
            }
            Shape::Ring(ring, at) => {
                let count = ring.len();
                if start != NONE {
                    *at = start as usize;
                }
                loop {
                    let sides = [(*at + 1) % count, (*at + count - 1) % count];
                    match sides.into_iter().find(|side| height(ring[*side]) > height(ring[*at])) {
                        Some(side) => *at = side,
                        None => return ring[*at],
                    }
                }
            }
            Shape::Solid(walk, sources) => {
                if start != NONE {
                    walk.start_at(start);
                }
                sources[walk.farthest_corner(n)] as usize
            }
        }
    }
}
