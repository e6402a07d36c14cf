//! The hull of points that span space.

use super::build::Builder;
use super::facets::NONE;
use crate::integrals::{SolidMoments, solid_moments};
use crate::mesh::TriangleMesh;
use crate::predicates::above;
use contact_kinematics::Direction;
use glam::DVec3;

/// A convex polytope of non-zero volume as a closed surface of triangles.
///
/// With exact signs every edge is convex or flat, never concave, and no input point is strictly outside of any facet.
/// Points inside of a flat face or edge may or may not be corners of the triangulation.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidHull {
    vertices: Vec<DVec3>,
    sources: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    neighbours: Vec<[u32; 3]>,
}

impl SolidHull {
    /// `order` maps the builder's points to the caller's.
    pub(super) fn from_builder(builder: &Builder, order: &[u32], points: &[DVec3]) -> Self {
        let list = &builder.facets.list;
        let mut facet_number = vec![NONE; list.len()];
        let mut vertex_number = vec![NONE; order.len()];
        let (mut vertices, mut sources) = (Vec::new(), Vec::new());
        let mut count = 0;
        for (facet, number) in list.iter().zip(&mut facet_number) {
            if facet.vertices[0] == NONE {
                continue;
            }
            *number = count;
            count += 1;
            for v in facet.vertices {
                let slot = &mut vertex_number[v as usize];
                if *slot == NONE {
                    *slot = vertices.len() as u32;
                    vertices.push(points[order[v as usize] as usize]);
                    sources.push(order[v as usize]);
                }
            }
        }
        let alive = || list.iter().filter(|f| f.vertices[0] != NONE);
        let triangles = alive().map(|f| f.vertices.map(|v| vertex_number[v as usize])).collect();
        let neighbours = alive().map(|f| f.neighbours.map(|g| facet_number[g as usize])).collect();
        Self { vertices, sources, triangles, neighbours }
    }

    /// Corners in m.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
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

    /// For each corner, one of the facets at it.
    pub(crate) fn facet_at_each_vertex(&self) -> Vec<u32> {
        let mut facet_at = vec![NONE; self.vertices.len()];
        for (f, t) in self.triangles.iter().enumerate() {
            t.iter().for_each(|v| facet_at[*v as usize] = f as u32);
        }
        facet_at
    }

    /// The next facet anticlockwise around corner `vertex`, and the corner that comes before it around `facet`.
    #[inline]
    pub(crate) fn next_around(&self, vertex: u32, facet: u32) -> (u32, u32) {
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

    /// Calls `visit` with each corner that shares an edge with `vertex`; `start` is a facet at it.
    #[inline]
    pub(crate) fn for_each_neighbour(&self, vertex: u32, start: u32, mut visit: impl FnMut(u32)) {
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
        self.triangles[facet].map(|v| self.vertices[v as usize])
    }

    /// Volume, centroid and area.
    #[must_use]
    pub fn moments(&self) -> SolidMoments {
        let reference = self.vertices.iter().sum::<DVec3>() / self.vertices.len() as f64;
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
        self.vertices.iter().map(|v| v.dot(n.get())).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether `point` is inside or on the surface; exact.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        (0..self.triangles.len()).all(|f| {
            let [a, b, c] = self.corners(f);
            above(a, b, c, point) <= 0.0
        })
    }

    /// How far `point` is outside, in m: the largest signed distance from a facet's plane, negative inside.
    ///
    /// A point strictly outside is at least this far from the hull.
    #[must_use]
    pub fn excess(&self, point: DVec3) -> f64 {
        (0..self.triangles.len())
            .filter_map(|f| {
                let [a, b, c] = self.corners(f);
                let normal = (b - a).cross(c - a);
                let length = normal.length();
                (length > 0.0).then(|| normal.dot(point - a) / length)
            })
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The surface as a mesh.
    #[must_use]
    pub fn mesh(&self) -> TriangleMesh {
        TriangleMesh { vertices: self.vertices.clone(), triangles: self.triangles.clone() }
    }
}
