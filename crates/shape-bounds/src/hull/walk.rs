use super::SolidHull;
use glam::DVec3;

/// Support points of a hull by climbing from corner to corner: a few steps where the directions change little from one
/// query to the next, O(sqrt n) from afar.
///
/// The climb ends where no neighbouring corner is farther, which on a convex surface is the farthest of all.
#[derive(Clone, Debug)]
pub struct SupportWalk<'a> {
    hull: &'a SolidHull,
    /// For each corner, one facet at it.
    facet_at: Vec<u32>,
    corner: u32,
}

impl<'a> SupportWalk<'a> {
    /// Prepares the climb in time O(n).
    #[must_use]
    pub fn new(hull: &'a SolidHull) -> Self {
        let facet_at = hull.facet_at_each_vertex();
        Self { hull, facet_at, corner: 0 }
    }

    /// The corner farthest along `direction`, which need not be of unit length.
    pub fn farthest(&mut self, direction: DVec3) -> DVec3 {
        self.hull.vertices()[self.farthest_corner(direction)]
    }

    /// The same as an index into [`SolidHull::vertices`].
    pub fn farthest_corner(&mut self, direction: DVec3) -> usize {
        let vertices = self.hull.vertices();
        let mut height = vertices[self.corner as usize].dot(direction);
        loop {
            let mut next = self.corner;
            self.hull.for_each_neighbour(self.corner, self.facet_at[self.corner as usize], |v| {
                let candidate = vertices[v as usize].dot(direction);
                if candidate > height {
                    (height, next) = (candidate, v);
                }
            });
            if next == self.corner {
                return self.corner as usize;
            }
            self.corner = next;
        }
    }
}
