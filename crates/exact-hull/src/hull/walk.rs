use super::SolidHull;
use glam::DVec3;

/// Corners whose heights differ by less than this many units of rounding are level.
const LEVEL_ULPS: f64 = 8.0;

/// Support points of a hull by climbing from corner to corner: a few steps where the directions change little from one
/// query to the next, O(sqrt n) from afar.
///
/// The climb ends where no neighbouring corner is farther, which on a convex surface is the farthest of all. Where corners are
/// closer together than rounding tells their heights apart, all that are level with each other are looked at before it ends.
#[derive(Clone, Debug)]
pub struct SupportWalk<'a> {
    hull: &'a SolidHull,
    corner: u32,
    /// The search at which a corner was last met; empty until a search over level corners is needed.
    met: Vec<u32>,
    search: u32,
    stack: Vec<u32>,
}

impl<'a> SupportWalk<'a> {
    /// A climb that starts anywhere.
    #[must_use]
    pub fn new(hull: &'a SolidHull) -> Self {
        Self { hull, corner: 0, met: Vec::new(), search: 0, stack: Vec::new() }
    }

    /// The hull that is climbed.
    #[must_use]
    pub fn hull(&self) -> &'a SolidHull {
        self.hull
    }

    /// Where the next climb starts, an index into [`SolidHull::vertices`].
    #[must_use]
    pub fn corner(&self) -> u32 {
        self.corner
    }

    /// Makes the next climb start at a corner, an index into [`SolidHull::vertices`].
    pub fn start_at(&mut self, corner: u32) {
        self.corner = corner;
    }

    /// The corner farthest along `direction`, which need not be of unit length.
    pub fn farthest(&mut self, direction: DVec3) -> DVec3 {
        self.hull.vertices()[self.farthest_corner(direction)]
    }

    /// The same as an index into [`SolidHull::vertices`].
    pub fn farthest_corner(&mut self, direction: DVec3) -> usize {
        let vertices = self.hull.vertices();
        loop {
            let here = vertices[self.corner as usize];
            let height = here.dot(direction);
            let level = height - LEVEL_ULPS * f64::EPSILON * here.abs().dot(direction.abs());
            let (mut highest, mut next, mut has_level) = (height, self.corner, false);
            self.hull.for_each_neighbour(self.corner, |v| {
                let candidate = vertices[v as usize].dot(direction);
                has_level |= candidate >= level;
                if candidate > highest {
                    (highest, next) = (candidate, v);
                }
            });
            if next == self.corner {
                let higher = if has_level { self.higher_beyond(direction, height, level) } else { None };
                match higher {
                    Some(higher) => next = higher,
                    None => return self.corner as usize,
                }
            }
            self.corner = next;
        }
    }

    /// A corner above `height` next to those that are at `level` at least and connected with the present one.
    #[cold]
    fn higher_beyond(&mut self, direction: DVec3, height: f64, level: f64) -> Option<u32> {
        let Self { hull, met, stack, .. } = self;
        let vertices = hull.vertices();
        met.resize(vertices.len(), 0);
        self.search += 1;
        met[self.corner as usize] = self.search;
        stack.push(self.corner);
        let mut higher = None;
        while let (Some(corner), None) = (stack.pop(), higher) {
            hull.for_each_neighbour(corner, |v| {
                let candidate = vertices[v as usize].dot(direction);
                if candidate > height {
                    higher = Some(v);
                } else if candidate >= level && met[v as usize] != self.search {
                    met[v as usize] = self.search;
                    stack.push(v);
                }
            });
        }
        stack.clear();
        higher
    }
}
