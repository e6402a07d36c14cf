use super::SolidHull;
use glam::DVec3;

/// Support points of a hull by climbing from corner to corner: a few steps where the directions change little from one
/// query to the next, O(sqrt n) from afar.
///
/// The climb ends where no neighbouring corner is farther, which on a convex surface is the farthest of all.
#[derive(Clone, Debug)]
pub struct SupportWalk<'a> {
    hull: &'a SolidHull,
    corner: u32,
}

impl<'a> SupportWalk<'a> {
    /// A climb that starts anywhere.
    #[must_use]
    pub fn new(hull: &'a SolidHull) -> Self {
        Self { hull, corner: 0 }
    }

    /// The corner farthest along `direction`, which need not be of unit length.
    pub fn farthest(&mut self, direction: DVec3) -> DVec3 {
        let vertices = self.hull.vertices();
        let mut height = vertices[self.corner as usize].dot(direction);
        loop {
            let mut next = self.corner;
            self.hull.for_each_neighbour(self.corner, |v| {
                let candidate = vertices[v as usize].dot(direction);
                if candidate > height {
                    (height, next) = (candidate, v);
                }
            });
            if next == self.corner {
                return vertices[self.corner as usize];
            }
            self.corner = next;
        }
    }
}
