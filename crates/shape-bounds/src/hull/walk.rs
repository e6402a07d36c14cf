use super::SolidHull;
use glam::DVec3;

/// Corners whose heights differ by less than this part of the hull's size are level.
const PLATEAU: f64 = 1e-13;

/// Support points of a hull by climbing from corner to corner: a few steps where the directions change little from one
/// query to the next, O(sqrt n) from afar.
///
/// The climb ends where no neighbouring corner is farther, nor any that is level but for rounding and connected with it:
/// where corners nearly coincide, a step may gain nothing. On a convex surface that is the farthest of all.
#[derive(Clone, Debug)]
pub struct SupportWalk<'a> {
    hull: &'a SolidHull,
    corner: u32,
    /// Height, per length of the direction, by which corners are still level, m.
    level: f64,
    /// The search at which a corner was last met.
    met: Vec<u32>,
    search: u32,
    stack: Vec<u32>,
}

impl<'a> SupportWalk<'a> {
    /// Prepares the climb in time O(n).
    #[must_use]
    pub fn new(hull: &'a SolidHull) -> Self {
        let vertices = hull.vertices();
        let size = vertices.iter().map(|v| v.distance(vertices[0])).fold(0.0, f64::max);
        let met = vec![0; vertices.len()];
        Self { hull, corner: 0, level: PLATEAU * size, met, search: 0, stack: Vec::new() }
    }

    /// The corner farthest along `direction`, which need not be of unit length.
    pub fn farthest(&mut self, direction: DVec3) -> DVec3 {
        self.hull.vertices()[self.farthest_corner(direction)]
    }

    /// The same as an index into [`SolidHull::vertices`].
    pub fn farthest_corner(&mut self, direction: DVec3) -> usize {
        let vertices = self.hull.vertices();
        // Heights over one corner: the rounding of far-away coordinates would hide small differences.
        let origin = vertices[0];
        let height_of = |v: u32| (vertices[v as usize] - origin).dot(direction);
        let mut height = height_of(self.corner);
        loop {
            let mut next = self.corner;
            self.hull.for_each_neighbour(self.corner, |v| {
                let candidate = height_of(v);
                if candidate > height {
                    (height, next) = (candidate, v);
                }
            });
            if next == self.corner {
                match self.higher_than_plateau(height, direction) {
                    Some(higher) => (next, height) = higher,
                    None => return self.corner as usize,
                }
            }
            self.corner = next;
        }
    }

    /// A corner above `height` next to those that are level with the present one and connected with it.
    fn higher_than_plateau(&mut self, height: f64, direction: DVec3) -> Option<(u32, f64)> {
        let Self { hull, met, stack, .. } = self;
        let vertices = hull.vertices();
        let lowest = height - self.level * direction.length();
        self.search += 1;
        met[self.corner as usize] = self.search;
        stack.push(self.corner);
        let mut higher = None;
        while let (Some(corner), None) = (stack.pop(), higher) {
            hull.for_each_neighbour(corner, |v| {
                let candidate = (vertices[v as usize] - vertices[0]).dot(direction);
                if candidate > height {
                    higher = Some((v, candidate));
                } else if candidate >= lowest && met[v as usize] != self.search {
                    met[v as usize] = self.search;
                    stack.push(v);
                }
            });
        }
        stack.clear();
        higher
    }
}
