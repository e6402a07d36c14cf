use crate::integrals::{SolidMoments, solid_moments};
use glam::DVec3;

/// A surface of triangles in memory; writing it to a file is another crate's work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Corners in m.
    pub vertices: Vec<DVec3>,
    /// Indices into `vertices`, anticlockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The corners of each triangle.
    pub fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|v| self.vertices[v as usize]))
    }

    /// Volume, centroid and area of the solid that the mesh encloses; meaningless for a mesh that is not closed.
    #[must_use]
    pub fn moments(&self) -> SolidMoments {
        let reference = self.vertices.iter().sum::<DVec3>() / self.vertices.len().max(1) as f64;
        solid_moments(self.corners(), reference)
    }
}
