//! Meshes for programs that do not open PLY: STL for printers and CAD, glTF for viewers and browsers.

use crate::TriangleMesh;
use glam::DVec3;
use serde_json::json;
use std::io::{self, BufWriter, Write};

/// Writes a mesh as binary STL, the numbers as they are in m. Coordinates have seven digits there, and corners belong to no two triangles.
///
/// # Errors
/// Those of `to`; more than 2^32 triangles.
pub fn write_stl(mesh: &TriangleMesh, comment: &str, to: impl Write) -> io::Result<()> {
    let mut to = BufWriter::new(to);
    let mut header = [b' '; 80];
    // Text that begins with `solid` is read as the other kind of STL.
    let text = format!("binary STL; {comment}");
    for (place, byte) in header.iter_mut().zip(text.bytes().filter(u8::is_ascii)) {
        *place = byte;
    }
    to.write_all(&header)?;
    to.write_all(&count(mesh.triangles.len())?.to_le_bytes())?;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|corner| mesh.vertices[corner as usize]);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        for coordinate in std::iter::once(normal).chain(corners).flat_map(single) {
            to.write_all(&coordinate.to_le_bytes())?;
        }
        to.write_all(&[0, 0])?;
    }
    to.flush()
}

/// Writes a mesh as binary glTF 2.0 (`.glb`) in m. Coordinates have seven digits there; the z axis of the mesh is up in viewers, whose own is y.
///
/// # Errors
/// Those of `to`; no triangle, or more corners or triangles than 2^32 bytes hold.
pub fn write_glb(mesh: &TriangleMesh, name: &str, to: impl Write) -> io::Result<()> {
    if mesh.triangles.is_empty() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "glTF has no meshes without triangles"));
    }
    let positions: Vec<u8> =
        mesh.vertices.iter().flat_map(|v| single(*v)).flat_map(f32::to_le_bytes).collect();
    let indices: Vec<u8> = mesh.triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes()).collect();
    let bound =
        |of: fn(DVec3, DVec3) -> DVec3| single(mesh.vertices.iter().copied().reduce(of).unwrap_or_default());
    let mut text = json!({
        "asset": { "version": "2.0", "generator": concat!("recon ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": name, "rotation": [-std::f32::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2] }],
        "meshes": [{ "name": name, "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "buffers": [{ "byteLength": positions.len() + indices.len() }],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": positions.len(), "target": ARRAY_BUFFER },
            { "buffer": 0, "byteOffset": positions.len(), "byteLength": indices.len(), "target": ELEMENT_ARRAY_BUFFER },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": FLOAT, "count": mesh.vertices.len(), "type": "VEC3", "min": bound(DVec3::min), "max": bound(DVec3::max) },
            { "bufferView": 1, "componentType": UNSIGNED_INT, "count": 3 * mesh.triangles.len(), "type": "SCALAR" },
        ],
    })
    .to_string();
    // Chunks are as long as a multiple of four; text is filled up with blanks.
    text.extend(std::iter::repeat_n(' ', text.len().next_multiple_of(4) - text.len()));
    let binary = positions.len() + indices.len();
    let mut to = BufWriter::new(to);
    to.write_all(b"glTF")?;
    to.write_all(&2u32.to_le_bytes())?;
    to.write_all(&count(12 + 8 + text.len() + 8 + binary)?.to_le_bytes())?;
    to.write_all(&count(text.len())?.to_le_bytes())?;
    to.write_all(b"JSON")?;
    to.write_all(text.as_bytes())?;
    to.write_all(&count(binary)?.to_le_bytes())?;
    to.write_all(b"BIN\0")?;
    to.write_all(&positions)?;
    to.write_all(&indices)?;
    to.flush()
}

/// Numbers of OpenGL, by which glTF calls its kinds (glTF 2.0 specification, 5.1.3 and 5.11.5).
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// In the single precision of both formats.
fn single(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn count(length: usize) -> io::Result<u32> {
    let large = |_| io::Error::new(io::ErrorKind::InvalidInput, "the mesh is too large for its format");
    u32::try_from(length).map_err(large)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> TriangleMesh {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.0, 0.0, 0.5)];
        TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap()
    }

    fn numbers(bytes: &[u8]) -> Vec<f32> {
        bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect()
    }

    #[test]
    fn stl_has_fifty_bytes_a_triangle_with_outward_normals() {
        let mut bytes = Vec::new();
        write_stl(&tetrahedron(), "a bound", &mut bytes).unwrap();
        assert_eq!(bytes.len(), 84 + 4 * 50);
        assert!(bytes.starts_with(b"binary STL; a bound ") && bytes[80..84] == 4u32.to_le_bytes());
        assert_eq!(numbers(&bytes[84..84 + 48])[..6], [0.0, 0.0, -1.0, 0.0, 0.0, 0.0]);
        assert_eq!(numbers(&bytes[84 + 50..84 + 98])[..3], [0.0, -1.0, 0.0]);
        // The volume by the triangles' corners (divergence theorem) is that of the mesh.
        let volume: f32 =
            (0..4).map(|k| numbers(&bytes[84 + 50 * k..84 + 50 * k + 48])).fold(0.0, |sum, t| {
                let corner = |i: usize| glam::Vec3::from_slice(&t[3 * i..3 * i + 3]);
                sum + corner(1).dot(corner(2).cross(corner(3))) / 6.0
            });
        assert!((volume - 1.0 / 12.0).abs() < 1e-7, "{volume}");
    }

    #[test]
    fn glb_says_of_its_parts_where_they_are() {
        let mut bytes = Vec::new();
        write_glb(&tetrahedron(), "a bound", &mut bytes).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
        let text = word(12);
        assert_eq!((text % 4, &bytes[16..20]), (0, &b"JSON"[..]));
        let said: serde_json::Value = serde_json::from_slice(&bytes[20..20 + text]).unwrap();
        let start = 20 + text + 8;
        assert_eq!((word(20 + text), &bytes[24 + text..start]), (bytes.len() - start, &b"BIN\0"[..]));
        assert_eq!(said["buffers"][0]["byteLength"], bytes.len() - start);
        let view = |i: usize, key: &str| said["bufferViews"][i][key].as_u64().unwrap() as usize;
        assert_eq!(numbers(&bytes[start..start + view(0, "byteLength")])[9..], [0.0, 0.0, 0.5]);
        assert_eq!((view(1, "byteOffset"), view(1, "byteLength")), (48, 48));
        assert_eq!(said["accessors"][0]["max"], json!([1.0, 1.0, 0.5]));
        assert_eq!(said["accessors"][1]["count"], 12);
    }

    #[test]
    fn an_empty_mesh_is_written_as_one_where_the_format_has_any() {
        let mut bytes = Vec::new();
        write_stl(&TriangleMesh::default(), "", &mut bytes).unwrap();
        assert_eq!(bytes.len(), 84);
        assert!(write_glb(&TriangleMesh::default(), "", &mut bytes).is_err());
    }
}
