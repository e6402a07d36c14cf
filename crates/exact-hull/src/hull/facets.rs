//! The facets of a hull under construction: a closed surface of triangles with their neighbours.

use crate::predicates::{UNIT_ROUNDOFF, above};
use glam::DVec3;

/// No facet, or no vertex.
pub(super) const NONE: u32 = u32::MAX;

/// Points that a hull holds at most: its facets, twice as many, and the marks of twice the insertions are 32-bit numbers.
pub(crate) const MOST_POINTS: usize = (u32::MAX / 2) as usize - 2;

/// A triangle of the hull and what a test against it needs, in one cache line.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Facet {
    /// The plane is `{ y : plane . (y - centre) = 1 }`: the facet's vertex in the polar dual about the centre.
    plane: DVec3,
    /// `plane . (p - centre) - 1` decides only beyond this.
    error: f64,
    /// Corners, anticlockwise from outside. The first is [`NONE`] when the facet is no longer there.
    pub(super) vertices: [u32; 3],
    /// Facet across the edge from corner `i` to corner `i + 1`.
    pub(super) neighbours: [u32; 3],
    /// Twice the insertion at which the facet was last judged, plus one if it was found visible.
    pub(super) mark: u32,
}

/// Facets and the points they connect.
pub(super) struct Facets {
    pub(super) points: Vec<DVec3>,
    /// A point strictly inside the first simplex, when one can be represented.
    pub(super) centre: Option<DVec3>,
    /// Bound on `|p - centre|` by coordinate over all points.
    reach: DVec3,
    pub(super) list: Vec<Facet>,
    free: Vec<u32>,
}

impl Facets {
    /// No facets yet. `centre`, where given, lies strictly inside of every facet that will be added.
    pub(super) fn new(points: Vec<DVec3>, centre: Option<DVec3>) -> Self {
        let origin = centre.unwrap_or(DVec3::ZERO);
        let reach = points.iter().fold(DVec3::ZERO, |reach, p| reach.max((*p - origin).abs()));
        let list = Vec::with_capacity(2 * points.len());
        Self { points, centre, reach, list, free: Vec::new() }
    }

    /// Adds a point. One beyond the reach of all before it widens the filters' error bounds, which are proportional to the
    /// reach; it at least doubles, so that this is rare.
    pub(super) fn push_point(&mut self, point: DVec3) -> u32 {
        self.points.push(point);
        let seen = (point - self.centre.unwrap_or(DVec3::ZERO)).abs();
        let factor = (seen / self.reach).max_element();
        let within = factor <= 1.0;
        if !within {
            let factor = 2.0 * factor;
            self.reach *= factor;
            for facet in &mut self.list {
                facet.error *= factor;
            }
        }
        (self.points.len() - 1) as u32
    }

    pub(super) fn corners(&self, facet: u32) -> [DVec3; 3] {
        self.list[facet as usize].vertices.map(|v| self.points[v as usize])
    }

    /// Adds a facet whose neighbours are set later.
    #[inline]
    pub(super) fn add(&mut self, vertices: [u32; 3], mark: u32) -> u32 {
        let (plane, error) = match self.centre {
            Some(centre) => self.filter_plane(vertices.map(|v| self.points[v as usize]), centre),
            None => (DVec3::ZERO, f64::INFINITY),
        };
        let facet = Facet { plane, error, vertices, neighbours: [NONE; 3], mark };
        if let Some(slot) = self.free.pop() {
            self.list[slot as usize] = facet;
            slot
        } else {
            self.list.push(facet);
            (self.list.len() - 1) as u32
        }
    }

    #[inline]
    pub(super) fn remove(&mut self, facet: u32) {
        self.list[facet as usize].vertices[0] = NONE;
        self.free.push(facet);
    }

    /// The facet's plane about `centre`, and the size beyond which the sign of [`Self::height`] is certain.
    ///
    /// With `u`, `w` the edges, `n = u x w`, `P_i` the sum of the sizes of the two products in `n_i`, `E` the reach and
    /// `e` the unit roundoff: each `n_i` is off by at most `4 e P_i`, which acts on `p - a`, at most `2 E`; the
    /// products with the rounded `p - centre` and `a - centre`, the division and the last subtraction add
    /// `11 e |n_i| E_i`, and `|n_i| <= P_i`. That is 19 e P.E in all, divided by the plane's distance `n.(a - centre)`
    /// as computed; 24 covers the terms of second order and the rounding of the bound itself.
    #[inline]
    fn filter_plane(&self, [a, b, c]: [DVec3; 3], centre: DVec3) -> (DVec3, f64) {
        let (u, w) = (b - a, c - a);
        let n = u.cross(w);
        let (s, t) = (u.abs(), w.abs());
        let products = DVec3::new(s.y * t.z + s.z * t.y, s.z * t.x + s.x * t.z, s.x * t.y + s.y * t.x);
        let bound = 24.0 * UNIT_ROUNDOFF * products.dot(self.reach);
        let distance = n.dot(a - centre);
        if distance > bound && bound > f64::MIN_POSITIVE {
            (n / distance, bound / distance)
        } else {
            (DVec3::ZERO, f64::INFINITY)
        }
    }

    /// Height of a point over a facet in units of the facet's distance from the centre; `q` is the point from the centre.
    #[inline]
    pub(super) fn height(&self, facet: u32, q: DVec3) -> f64 {
        self.list[facet as usize].plane.dot(q) - 1.0
    }

    /// Whether `height` proves that the point it was computed for is strictly outside.
    #[inline]
    pub(super) fn proves_visible(&self, facet: u32, height: f64) -> bool {
        height > self.list[facet as usize].error
    }

    /// Whether point `p` is strictly outside of the facet's plane; exact. `q` is the point from the centre.
    #[inline]
    pub(super) fn is_visible(&self, facet: u32, p: u32, q: DVec3) -> bool {
        self.is_visible_at(facet, p, self.height(facet, q))
    }

    /// [`Self::is_visible`] for a height that is known.
    #[inline]
    pub(super) fn is_visible_at(&self, facet: u32, p: u32, height: f64) -> bool {
        let error = self.list[facet as usize].error;
        if height > error {
            true
        } else if height < -error {
            false
        } else {
            self.is_visible_exactly(facet, p)
        }
    }

    #[cold]
    fn is_visible_exactly(&self, facet: u32, p: u32) -> bool {
        let [a, b, c] = self.corners(facet);
        above(a, b, c, self.points[p as usize]) > 0.0
    }

    /// Point `p` as seen from the centre.
    #[inline]
    pub(super) fn seen_from_centre(&self, p: u32) -> DVec3 {
        self.points[p as usize] - self.centre.unwrap_or(DVec3::ZERO)
    }
}
