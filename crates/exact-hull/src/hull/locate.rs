//! Finding a facet that a point sees, or the proof that there is none.

use super::facets::{Facets, NONE};
use crate::predicates::above;
use crate::random::random_bits;
use glam::DVec3;

/// Steps of the exact walk, as a multiple of the facets there are, before every facet is tried instead. The walk ends
/// with probability one; the limit only guards against an unlucky stretch.
const PATIENCE: usize = 4;

impl Facets {
    /// A facet whose plane has point `p` strictly outside, or `None` when `p` is in the hull; exact.
    ///
    /// First a climb in the polar dual, where the facets are the vertices of a convex polytope and the height of `p` is
    /// a linear function, so that a local maximum is the maximum. Rounding may spoil that; the exact walk corrects it.
    pub(super) fn find_visible(&self, p: u32, start: u32) -> Option<u32> {
        let Some(centre) = self.centre else { return self.scan(p) };
        let q = self.seen_from_centre(p);
        let mut facet = start;
        let mut height = self.height(facet, q);
        loop {
            if self.proves_visible(facet, height) {
                return Some(facet);
            }
            let mut next = NONE;
            for neighbour in self.list[facet as usize].neighbours {
                let candidate = self.height(neighbour, q);
                if candidate > height {
                    (height, next) = (candidate, neighbour);
                }
            }
            if next == NONE {
                return self.walk(p, q, facet, centre);
            }
            facet = next;
        }
    }

    /// Exact visibility walk (Devillers, Pion and Teillaud, "Walking in a triangulation", 2002) over the cones that
    /// the facets span from the centre, towards the cone that holds `p`.
    fn walk(&self, p: u32, q: DVec3, start: u32, centre: DVec3) -> Option<u32> {
        let point = self.points[p as usize];
        let mut facet = start;
        for step in 0..PATIENCE * self.list.len() {
            if self.is_visible(facet, p, q) {
                return Some(facet);
            }
            let corners = self.corners(facet);
            // A random first edge makes an endless cycle impossible.
            let first = if step == 0 { 0 } else { (random_bits(step as u64) % 3) as usize };
            let across = (0..3).map(|k| (first + k) % 3).find(|&k| {
                // The inner side of the cone is that of the third corner, above the plane through centre, i, i + 1.
                above(centre, corners[k], corners[(k + 1) % 3], point) < 0.0
            });
            match across {
                Some(edge) => facet = self.list[facet as usize].neighbours[edge],
                // In the facet's cone and not outside of its plane: in the tetrahedron of facet and centre.
                None => return None,
            }
        }
        self.scan(p)
    }

    /// The plain way: every facet.
    fn scan(&self, p: u32) -> Option<u32> {
        let q = self.seen_from_centre(p);
        (0..self.list.len() as u32)
            .find(|&facet| self.list[facet as usize].vertices[0] != NONE && self.is_visible(facet, p, q))
    }
}
