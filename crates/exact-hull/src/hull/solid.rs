//! The hull of points that span space.

use super::build::Builder;
use super::facets::NONE;
use crate::integrals::{SolidMoments, solid_moments};
use crate::mesh::TriangleMesh;
use crate::scaled::ScaledPoints;
use glam::DVec3;
use unit_direction::Direction;

/// A convex polytope of non-zero volume as a closed surface of triangles.
///
/// With exact signs every edge is convex or flat, never concave, and no input point is strictly outside of any facet.
/// Points inside of a flat face or edge may or may not be corners of the triangulation.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidHull {
    /// The corners, with the power of two by which coordinates are multiplied for exact signs.
    vertices: ScaledPoints<Vec<DVec3>>,
    sources: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    neighbours: Vec<[u32; 3]>,
    /// For each corner, one of the facets at it.
    facet_at: Vec<u32>,
}

impl SolidHull {
    /// `order` maps the builder's points to the caller's, of which they are the multiple by `scale`, a power of two.
    ///
    /// Corners keep the order of the builder's points, in which neighbours are close to each other; facets keep that of
    /// the builder's list.
    pub(super) fn from_builder(builder: &Builder, order: &[u32], scale: f64) -> Self {
        let list = &builder.facets.list;
        let mut numbers = vec![NONE; list.len()];
        let mut used = vec![false; order.len()];
        let mut count = 0;
        for (facet, number) in list.iter().zip(&mut numbers) {
            if facet.vertices[0] != NONE {
                facet.vertices.iter().for_each(|v| used[*v as usize] = true);
                *number = count;
                count += 1;
            }
        }
        let mut corner_number = vec![NONE; order.len()];
        let (mut vertices, mut sources) = (Vec::new(), Vec::new());
        for (v, used) in used.into_iter().enumerate() {
            if used {
                corner_number[v] = vertices.len() as u32;
                vertices.push(builder.facets.points[v]);
                sources.push(order[v]);
            }
        }
        let mut facet_at = vec![NONE; vertices.len()];
        let (mut triangles, mut neighbours) =
            (Vec::with_capacity(count as usize), Vec::with_capacity(count as usize));
        for (facet, number) in list.iter().zip(&numbers) {
            if *number != NONE {
                let triangle = facet.vertices.map(|v| corner_number[v as usize]);
                triangle.iter().for_each(|v| facet_at[*v as usize] = *number);
                triangles.push(triangle);
                neighbours.push(facet.neighbours.map(|g| numbers[g as usize]));
            }
        }
        let vertices = ScaledPoints::from_multiple(vertices, scale);
        Self { vertices, sources, triangles, neighbours, facet_at }
    }

    /// The same hull with facets numbered by the first of their corners, so that whoever goes through them finds the corners
    /// in the cache. The order of the builder is that of insertion and reuse.
    pub(crate) fn with_facets_along_corners(self) -> Self {
        let Self { vertices, sources, triangles, neighbours, mut facet_at } = self;
        let first = |t: &[u32; 3]| t[0].min(t[1]).min(t[2]) as usize;
        let count = vertices.points().len();
        let mut next = vec![0; count + 1];
        triangles.iter().for_each(|t| next[first(t) + 1] += 1);
        (0..count).for_each(|v| next[v + 1] += next[v]);
        let (mut numbers, mut old) = (vec![0; triangles.len()], vec![0; triangles.len()]);
        for (facet, triangle) in triangles.iter().enumerate() {
            let number = &mut next[first(triangle)];
            numbers[facet] = *number;
            old[*number as usize] = facet as u32;
            *number += 1;
        }
        let (triangles, neighbours) = old
            .iter()
            .map(|f| (triangles[*f as usize], neighbours[*f as usize].map(|g| numbers[g as usize])))
            .unzip();
        facet_at.iter_mut().for_each(|facet| *facet = numbers[*facet as usize]);
        Self { vertices, sources, triangles, neighbours, facet_at }
    }

    /// Corners in m.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        self.vertices.points()
    }

    /// For each corner, the index of the input point that it is.
    #[must_use]
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// Facets as indices into [`Self::vertices`], anticlockwise from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// For each facet, the facets across its edges from corner 0 to 1, 1 to 2 and 2 to 0.
    #[must_use]
    pub fn neighbours(&self) -> &[[u32; 3]] {
        &self.neighbours
    }

    /// The next facet anticlockwise around corner `vertex`, and the corner that comes before it around `facet`.
    #[inline]
    fn next_around(&self, vertex: u32, facet: u32) -> (u32, u32) {
        let t = self.triangles[facet as usize];
        let corner = if t[0] == vertex {
            0
        } else if t[1] == vertex {
            1
        } else {
            2
        };
        // It lies across the edge that ends at the vertex.
        (self.neighbours[facet as usize][(corner + 2) % 3], t[(corner + 2) % 3])
    }

    /// Replaces the edge `edge` of `facet` by the other diagonal of the two facets at it, unless that is an edge already. The
    /// diagonal is the second edge of `facet` then.
    pub(crate) fn flip(&mut self, facet: u32, edge: usize) -> bool {
        let (f, g) = (facet as usize, self.neighbours[facet as usize][edge]);
        let [a, b, c] = [0, 1, 2].map(|k| self.triangles[f][(edge + k) % 3]);
        let Some(back) = (0..3).find(|k| self.neighbours[g as usize][*k] == facet) else { return false };
        let d = self.triangles[g as usize][(back + 2) % 3];
        let mut met = false;
        self.for_each_neighbour(c, |v| met |= v == d);
        // Two facets that share two edges lie at a corner of two facets, which is none.
        if met || self.triangles[g as usize][back] != b {
            return false;
        }
        let [beyond_bc, beyond_ca] = [1, 2].map(|k| self.neighbours[f][(edge + k) % 3]);
        let [beyond_ad, beyond_db] = [1, 2].map(|k| self.neighbours[g as usize][(back + k) % 3]);
        self.triangles[f] = [a, d, c];
        self.neighbours[f] = [beyond_ad, g, beyond_ca];
        self.triangles[g as usize] = [d, b, c];
        self.neighbours[g as usize] = [beyond_db, beyond_bc, facet];
        for (beyond, old, new) in [(beyond_ad, g, facet), (beyond_bc, facet, g)] {
            // By corners, since two facets may share more than one edge with a third.
            let corner = if new == facet { d } else { c };
            let t = self.triangles[beyond as usize];
            if let Some(k) = (0..3).find(|k| self.neighbours[beyond as usize][*k] == old && t[*k] == corner) {
                self.neighbours[beyond as usize][k] = new;
            }
        }
        for (corner, facet) in [(a, facet), (b, g), (c, facet), (d, facet)] {
            self.facet_at[corner as usize] = facet;
        }
        true
    }

    /// The facets around corner `vertex`, anticlockwise from outside.
    pub fn facets_around(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        let first = self.facet_at[vertex as usize];
        std::iter::successors(Some(first), move |facet| {
            let next = self.next_around(vertex, *facet).0;
            (next != first).then_some(next)
        })
    }

    /// Calls `visit` with each corner that shares an edge with `vertex`.
    #[inline]
    pub fn for_each_neighbour(&self, vertex: u32, mut visit: impl FnMut(u32)) {
        let start = self.facet_at[vertex as usize];
        let mut facet = start;
        loop {
            let (next, neighbour) = self.next_around(vertex, facet);
            visit(neighbour);
            facet = next;
            if facet == start {
                break;
            }
        }
    }

    /// The corners of a facet.
    #[must_use]
    pub fn corners(&self, facet: usize) -> [DVec3; 3] {
        self.triangles[facet].map(|v| self.vertices()[v as usize])
    }

    /// Volume, centroid and area.
    #[must_use]
    pub fn moments(&self) -> SolidMoments {
        let reference = self.vertices().iter().sum::<DVec3>() / self.vertices().len() as f64;
        solid_moments((0..self.triangles.len()).map(|f| self.corners(f)), reference)
    }

    /// Volume in m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.moments().volume
    }

    /// Surface area in m^2.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.moments().area
    }

    /// Support function `max n . y` over the hull, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> f64 {
        self.vertices().iter().map(|v| v.dot(n.get())).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether `point` is inside or on the surface; exact.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        // A point out of the range of the predicate is out of that of the corners.
        let low = self.vertices().iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = self.vertices().iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        point.cmpge(low).all()
            && point.cmple(high).all()
            && (0..self.triangles.len()).all(|f| self.above_facet(f, point) <= 0.0)
    }

    /// Positive where `point`, in the range of the corners, is strictly outside of a facet's plane, zero on it; exact.
    pub(crate) fn above_facet(&self, facet: usize, point: DVec3) -> f64 {
        self.vertices.above(self.triangles[facet], point)
    }

    /// How far `point` is outside, in m: the largest signed distance from a facet's plane, negative inside.
    ///
    /// A point strictly outside is at least this far from the hull.
    #[must_use]
    pub fn excess(&self, point: DVec3) -> f64 {
        // In units of about the size, products of extreme coordinates stay in range; a power of two, since a facet whose
        // corners nearly coincide has another plane when these are rounded.
        let largest = self.vertices().iter().map(|v| v.abs().max_element()).fold(f64::MIN_POSITIVE, f64::max);
        let size = largest.log2().floor().exp2();
        let unit = |p: DVec3| p / size;
        (0..self.triangles.len())
            .filter_map(|f| {
                let [a, b, c] = self.corners(f).map(unit);
                let normal = (b - a).cross(c - a);
                let length = normal.length();
                (length > 0.0).then(|| normal.dot(unit(point) - a) / length * size)
            })
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The surface as a mesh.
    #[must_use]
    pub fn mesh(&self) -> TriangleMesh {
        TriangleMesh { vertices: self.vertices().to_vec(), triangles: self.triangles.clone() }
    }
}
