//! Meshes as shapes of parry3d, for its collision, distance and ray queries.

use crate::TriangleMesh;
use parry3d_f64::shape::{ConvexPolyhedron, TriMesh, TriMeshBuilderError};

impl TriangleMesh {
    /// The surface as parry's triangle mesh.
    ///
    /// # Errors
    /// Those of parry for meshes without triangles.
    pub fn to_parry(&self) -> Result<TriMesh, TriMeshBuilderError> {
        TriMesh::new(self.vertices.clone(), self.triangles.clone())
    }

    /// The solid as parry's convex polyhedron; the mesh must be convex and closed, as those of hulls and intersections are.
    ///
    /// parry merges faces whose normals agree to 1.5e-8 and gives up on some thin solids: none then.
    #[must_use]
    pub fn to_parry_convex(&self) -> Option<ConvexPolyhedron> {
        ConvexPolyhedron::from_convex_mesh(self.vertices.clone(), &self.triangles)
    }
}
