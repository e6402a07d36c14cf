//! Triangle meshes as Wavefront OBJ text, which MuJoCo, Drake, Bullet and ROS read.

use crate::TriangleMesh;
use crate::number::exact;
use std::fmt::Write;

pub(super) fn write(mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = String::new();
    // Writing to a string does not fail.
    for v in &mesh.vertices {
        let _ = writeln!(text, "v {} {} {}", exact(v.x), exact(v.y), exact(v.z));
    }
    for t in &mesh.triangles {
        let _ = writeln!(text, "f {} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    text.into_bytes()
}
