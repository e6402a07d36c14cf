//! Judging a hull by exact signs alone, whoever made it.

use super::PointsError;
use crate::mesh::TriangleMesh;
use crate::predicates::{above, projection_axis};
use crate::scaled::ScaledPoints;
use glam::DVec3;

/// What is wrong with a mesh that claims to be the hull of some points; all zero (and Euler 2) when nothing is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HullCertificate {
    /// Points strictly outside of some facet's plane.
    pub outside: usize,
    /// Edges at which the surface bends inwards.
    pub concave_edges: usize,
    /// Edges that do not join exactly two facets in opposite senses.
    pub open_edges: usize,
    /// Facets of zero area.
    pub flat_facets: usize,
    /// Corners minus edges plus facets: 2 for a surface like the sphere.
    pub euler: i64,
}

impl HullCertificate {
    /// Judges `mesh` as the hull of `points`: every facet against every point, by exact signs.
    ///
    /// # Errors
    /// Those of [`ScaledPoints::for_planes`], of the mesh's corners, then the points.
    pub fn of(mesh: &TriangleMesh, points: &[DVec3]) -> Result<Self, PointsError> {
        let scaled = ScaledPoints::for_planes([&mesh.vertices[..], points].concat())?;
        let mut edges: Vec<([u32; 2], bool, u32)> = Vec::with_capacity(3 * mesh.triangles.len());
        for t in &mesh.triangles {
            for k in 0..3 {
                let (from, to, third) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
                edges.push(([from.min(to), from.max(to)], from < to, third));
            }
        }
        edges.sort_unstable();
        let mut verdict = Self::default();
        let scaled = scaled.scaled();
        let (corners_of, points) = scaled.split_at(mesh.vertices.len());
        let at = |v: u32| corners_of[v as usize];
        let mut edge_count = 0;
        for group in edges.chunk_by(|x, y| x.0 == y.0) {
            edge_count += 1;
            match group {
                [([low, high], false, left), (_, true, right)] => {
                    // Seen from outside, the facet of the forward sense is (low, high, right).
                    if above(at(*low), at(*high), at(*right), at(*left)) > 0.0 {
                        verdict.concave_edges += 1;
                    }
                }
                _ => verdict.open_edges += 1,
            }
        }
        let corners: Vec<[DVec3; 3]> = mesh.triangles.iter().map(|t| t.map(at)).collect();
        verdict.flat_facets =
            corners.iter().filter(|[a, b, c]| projection_axis(*a, *b, *c).is_none()).count();
        verdict.outside =
            points.iter().filter(|p| corners.iter().any(|[a, b, c]| above(*a, *b, *c, **p) > 0.0)).count();
        let mut used: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        verdict.euler = used.len() as i64 - edge_count + mesh.triangles.len() as i64;
        Ok(verdict)
    }

    /// Whether the mesh is the closed, convex surface of a polytope that holds all points.
    #[must_use]
    pub fn holds(&self) -> bool {
        *self == Self { euler: 2, ..Self::default() }
    }
}
