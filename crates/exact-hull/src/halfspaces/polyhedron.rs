use super::corners::corners;
use crate::HalfSpace;
use crate::hull::SolidHull;
use crate::integrals::{SolidMoments, solid_moments};
use crate::mesh::TriangleMesh;
use glam::DVec3;
use unit_direction::Direction;

/// Planes are moved outwards by this many units of rounding of the largest coordinate: more than the rounding of a
/// plane's distance (4) and of the computed corners (2 along a normal) together.
pub(super) const OUTWARD_ULPS: f64 = 8.0;

/// A corner computed from the planes as given may protrude over its neighbours' planes by this many units of rounding of
/// the largest coordinate, which is what evaluating the height takes; beyond, the corner of the rounded planes is used.
const CONSISTENT_ULPS: f64 = 4.0;

/// A bounded intersection of half-spaces with its corners and faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    interior: DVec3,
    /// The hull of the polar duals: its corners are the faces, its facets the corners.
    dual: SolidHull,
    vertices: Vec<DVec3>,
    /// The half-space of each face, with the outward rounding in its margin.
    half_spaces: Vec<HalfSpace>,
    redundant: Vec<u32>,
    /// Whether all corners are well determined by their planes.
    sure: bool,
}

impl Polyhedron {
    /// The polyhedron of `all` half-spaces, moved `outwards` (m), whose polar duals about `interior` have the hull `dual`.
    pub(super) fn from_dual(dual: SolidHull, all: &[HalfSpace], outwards: f64, interior: DVec3) -> Self {
        let mut dual = dual.with_facets_along_corners();
        let half_spaces: Vec<HalfSpace> =
            dual.sources().iter().map(|k| all[*k as usize].moved(outwards)).collect();
        let (vertices, sure) =
            corners(&mut dual, &half_spaces, interior, CONSISTENT_ULPS * rounding_unit(all));
        let mut used = vec![false; all.len()];
        dual.sources().iter().for_each(|k| used[*k as usize] = true);
        let redundant = (0..all.len() as u32).filter(|k| !used[*k as usize]).collect();
        Self { interior, dual, vertices, half_spaces, redundant, sure }
    }

    /// Whether all corners are well determined by their planes; of planes that share a line, where along it rounding decides.
    pub(super) fn is_sure(&self) -> bool {
        self.sure
    }

    /// A point strictly inside, in m.
    #[must_use]
    pub fn interior(&self) -> DVec3 {
        self.interior
    }

    /// Whether all corners are finite.
    pub(super) fn is_finite(&self) -> bool {
        self.vertices.iter().all(|v| v.is_finite())
    }

    /// Corners in m. Corners where more than three planes meet appear once for each three of them.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// For each corner, those at the other ends of its three edges.
    #[must_use]
    pub fn vertex_neighbours(&self) -> &[[u32; 3]] {
        self.dual.neighbours()
    }

    /// Number of faces.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.half_spaces.len()
    }

    /// Corners of a face as indices into [`Self::vertices`], anticlockwise from outside.
    pub fn face(&self, face: usize) -> impl Iterator<Item = u32> + '_ {
        self.dual.facets_around(face as u32)
    }

    /// The three faces at a corner, of those that [`Self::face`] numbers.
    #[must_use]
    pub fn faces_at(&self, corner: usize) -> [u32; 3] {
        self.dual.triangles()[corner]
    }

    /// Calls `visit` with each face that shares an edge with `face`.
    pub fn for_each_neighbouring_face(&self, face: u32, visit: impl FnMut(u32)) {
        self.dual.for_each_neighbour(face, visit);
    }

    /// For each face, the index of the half-space that it lies on.
    #[must_use]
    pub fn face_sources(&self) -> &[u32] {
        self.dual.sources()
    }

    /// For each face, its half-space with the margin that makes up for rounding.
    #[must_use]
    pub fn face_half_spaces(&self) -> &[HalfSpace] {
        &self.half_spaces
    }

    /// Half-spaces that could be left out because the others imply them, to rounding.
    #[must_use]
    pub fn redundant(&self) -> &[u32] {
        &self.redundant
    }

    /// Volume, centroid and area.
    #[must_use]
    pub fn moments(&self) -> SolidMoments {
        solid_moments(self.fans().map(|t| t.map(|v| self.vertices[v as usize])), self.interior)
    }

    /// Volume in m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.moments().volume
    }

    /// Support function `max n . y` over the polyhedron, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> f64 {
        self.vertices.iter().map(|v| v.dot(n.get())).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether `point` is inside. A point of the exact intersection is never denied; one outside by a few units of
    /// rounding may be admitted.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.excess(point) <= 0.0
    }

    /// The largest signed distance of `point` beyond a face's plane, in m; negative inside.
    #[must_use]
    pub fn excess(&self, point: DVec3) -> f64 {
        self.half_spaces.iter().map(|h| h.excess(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The surface as a mesh, each face as a fan of triangles.
    #[must_use]
    pub fn mesh(&self) -> TriangleMesh {
        TriangleMesh { vertices: self.vertices.clone(), triangles: self.fans().collect() }
    }

    fn fans(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        (0..self.face_count()).flat_map(|f| {
            let mut face = self.face(f);
            let (first, mut previous) = (face.next().unwrap_or(0), face.next().unwrap_or(0));
            face.map(move |v| [first, std::mem::replace(&mut previous, v), v])
        })
    }
}

/// The rounding of the largest coordinate.
fn rounding_unit(half_spaces: &[HalfSpace]) -> f64 {
    f64::EPSILON * half_spaces.iter().map(|h| h.point.abs().max_element()).fold(0.0, f64::max)
}

/// How far planes are moved outwards, in m: by more than all rounding in what follows.
pub(super) fn outward_rounding(half_spaces: &[HalfSpace]) -> f64 {
    OUTWARD_ULPS * rounding_unit(half_spaces)
}
