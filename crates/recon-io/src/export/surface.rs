//! Closed surfaces.

use super::ExportError;
use crate::TriangleMesh;
use glam::{DQuat, DVec3};
use std::collections::HashMap;

/// Rows and columns of the net of normals on an ellipsoid: its facets are at most 0.11 % of the size inside of it.
const ROWS: u32 = 48;
const COLUMNS: u32 = 96;

/// Refuses a surface that is empty or has a hole.
pub(super) fn check(name: &str, mesh: &TriangleMesh) -> Result<(), ExportError> {
    if mesh.triangles.is_empty() {
        return Err(ExportError::Empty { name: name.to_owned() });
    }
    // Each edge must be passed once in each direction.
    let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *balance.entry((a.min(b), a.max(b))).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    match balance.values().filter(|&&count| count != 0).count() {
        0 => Ok(()),
        open => Err(ExportError::Open { name: name.to_owned(), open }),
    }
}

/// An ellipsoid as a mesh with its vertices on it.
pub(super) fn ellipsoid(centre: DVec3, orientation: DQuat, semi_axes: DVec3) -> TriangleMesh {
    TriangleMesh::net(ROWS, COLUMNS, |unit| centre + orientation * (semi_axes * unit))
}
