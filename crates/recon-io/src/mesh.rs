//! Triangle meshes as PLY files.

use certificate::{Surface, SurfaceError};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use std::io::{self, BufWriter, Write};
use thiserror::Error;

/// A triangle mesh: counter-clockwise seen from outside. Units and frame are those of its user (here: m, body axes).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertices.
    pub vertices: Vec<DVec3>,
    /// Triangles as indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
}

/// Why vertices and triangles are not a mesh.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {vertex}, but the mesh has {vertices}")]
    NoSuchVertex {
        /// Which triangle, from 0.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A vertex has a coordinate that is not a number.
    #[error("vertex {vertex} is ({}, {}, {}); it must be finite", position.x, position.y, position.z)]
    NotFinite {
        /// Which vertex, from 0.
        vertex: usize,
        /// As given.
        position: DVec3,
    },
}

/// The middles of the `cuts` by `cuts` equal triangles of one.
fn in_the_middle([a, b, c]: &[DVec3; 3], cuts: usize, points: &mut Vec<DVec3>) {
    let step = 1.0 / cuts as f64;
    let at = |i: f64, k: f64| *a + step * (i * (*b - *a) + k * (*c - *a));
    for i in 0..cuts {
        for k in 0..cuts - i {
            let (along, across) = (i as f64, k as f64);
            points.push(at(along + 1.0 / 3.0, across + 1.0 / 3.0));
            if i + k + 1 < cuts {
                points.push(at(along + 2.0 / 3.0, across + 2.0 / 3.0));
            }
        }
    }
}

impl TriangleMesh {
    /// Checks and takes a mesh.
    ///
    /// # Errors
    /// [`MeshError`] names the first triangle or vertex that is wrong.
    pub fn new(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if let Some((vertex, &position)) = vertices.iter().enumerate().find(|(_, v)| !v.is_finite()) {
            return Err(MeshError::NotFinite { vertex, position });
        }
        let count = vertices.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
                return Err(MeshError::NoSuchVertex { triangle, vertex, vertices: count });
            }
        }
        Ok(Self { vertices, triangles })
    }

    /// Its vertices, and points all over its triangles, for viewers that draw points alone: each triangle is cut into equal ones, as many along an edge as
    /// make about `most` in all, with a point in the middle of each; no triangle has fewer than one.
    #[must_use]
    pub fn spread(&self, most: usize) -> Vec<DVec3> {
        let corners = |triangle: &[u32; 3]| triangle.map(|index| self.vertices.get(index as usize).copied());
        let triangles = self.triangles.iter().filter_map(|triangle| match corners(triangle) {
            [Some(a), Some(b), Some(c)] => Some([a, b, c]),
            _ => None,
        });
        let triangles: Vec<[DVec3; 3]> = triangles.collect();
        let area = |[a, b, c]: &[DVec3; 3]| (b - a).cross(c - a).length();
        let whole: f64 = triangles.iter().map(area).sum();
        let mut points = self.vertices.clone();
        for triangle in &triangles {
            // A cast from f64 saturates, and of nothing by nothing it is 0.
            let cuts = ((most as f64 * area(triangle) / whole).sqrt() as usize).clamp(1, most.max(1));
            in_the_middle(triangle, cuts, &mut points);
        }
        points
    }

    /// Whether every edge is passed as often forwards as backwards, so that the triangles leave no hole and are turned one
    /// way.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.surface().is_ok_and(|surface| surface.open_edge().is_none())
    }

    /// For what is certified of it: its fields can be changed, so that it is checked again.
    pub(crate) fn surface(&self) -> Result<Surface, SurfaceError> {
        Surface::new(self.vertices.clone(), self.triangles.clone())
    }

    /// The closed surface of the points that `at` gives for unit vectors, on a net of `rows` by `columns` between the
    /// poles; degenerate triangles at the poles are left out.
    #[must_use]
    pub fn net(rows: u32, columns: u32, at: impl Fn(DVec3) -> DVec3) -> Self {
        let point = |row: u32, column: u32| {
            let (polar, around) =
                (PI * f64::from(row) / f64::from(rows), TAU * f64::from(column) / f64::from(columns));
            at(DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos()))
        };
        let index = |row: u32, column: u32| match row {
            0 => 0,
            last if last == rows => 1,
            _ => 2 + (row - 1) * columns + column % columns,
        };
        let places = || (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let mut vertices = vec![point(0, 0), point(rows, 0)];
        vertices.extend(places().filter(|(row, _)| *row > 0).map(|(row, column)| point(row, column)));
        let mut triangles = Vec::new();
        for (row, column) in places() {
            let [a, b, c, d] = [
                index(row, column),
                index(row + 1, column),
                index(row + 1, column + 1),
                index(row, column + 1),
            ];
            triangles.extend(
                [[a, b, c], [a, c, d]].into_iter().filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]),
            );
        }
        Self { vertices, triangles }
    }
}

/// Writes a mesh as binary little-endian PLY with double precision, which MeshLab, Blender, Open3D and trimesh open.
///
/// # Errors
/// Those of `to`.
pub fn write_ply(mesh: &TriangleMesh, comment: &str, to: impl Write) -> io::Result<()> {
    let mut to = BufWriter::new(to);
    write!(
        to,
        "ply\nformat binary_little_endian 1.0\ncomment {}\nelement vertex {}\nproperty double x\n\
         property double y\nproperty double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        comment.replace(['\n', '\r'], " "),
        mesh.vertices.len(),
        mesh.triangles.len()
    )?;
    for coordinate in mesh.vertices.iter().flat_map(DVec3::to_array) {
        to.write_all(&coordinate.to_le_bytes())?;
    }
    for triangle in &mesh.triangles {
        to.write_all(&[3])?;
        for vertex in triangle {
            to.write_all(&vertex.to_le_bytes())?;
        }
    }
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_meshes_are_named() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let missing = TriangleMesh::new(vertices.clone(), vec![[0, 1, 2], [0, 1, 3]]);
        assert_eq!(missing, Err(MeshError::NoSuchVertex { triangle: 1, vertex: 3, vertices: 3 }));
        assert!(matches!(
            TriangleMesh::new(vec![DVec3::X, DVec3::NAN], vec![]),
            Err(MeshError::NotFinite { vertex: 1, .. })
        ));
    }

    #[test]
    fn net_is_closed_and_turned_outwards() {
        let mesh = TriangleMesh::net(36, 72, |unit| unit);
        // Every edge is passed once in each direction.
        let mut edges = std::collections::HashMap::new();
        for t in &mesh.triangles {
            for k in 0..3 {
                *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
            }
        }
        assert!(edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1)));
        let solid = recon::shape_bounds::exact_hull::TriangleMesh {
            vertices: mesh.vertices,
            triangles: mesh.triangles,
        };
        let missing = 4.0 / 3.0 * PI - solid.moments().volume;
        assert!(missing > 0.0 && missing < 0.03, "{missing}");
    }

    /// Points lie over a triangle as its area does: their mean and their second moments are those of the triangle, the latter up to a part in the number of
    /// points (the triangles that they stand for have moments of their own).
    #[test]
    fn points_are_spread_by_area() {
        let vertices = vec![DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 1.0, 2.0), DVec3::Z];
        // The second triangle has no area, and the third a corner that is not there.
        let mesh = TriangleMesh { vertices, triangles: vec![[0, 1, 2], [0, 0, 1], [0, 1, 9]] };
        let points = mesh.spread(400);
        assert_eq!((points.len(), &points[..4]), (4 + 400 + 1, &mesh.vertices[..]));
        let over = &points[4..404];
        let mean = over.iter().sum::<DVec3>() / 400.0;
        assert!(mean.distance(DVec3::new(1.0, 1.0 / 3.0, 2.0 / 3.0)) < 1e-14, "{mean}");
        // That of a triangle along an edge: a sixth of the square of its length.
        let second = over.iter().map(|point| point.x * point.x).sum::<f64>() / 400.0;
        assert!((second / (9.0 / 6.0) - 1.0).abs() < 1.0 / 400.0, "{second}");
        assert!(mesh.spread(0).len() == 6 && TriangleMesh::default().spread(9).is_empty());
    }

    #[test]
    fn ply_holds_every_byte_that_its_header_promises() {
        let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.0, 0.0, 0.1)];
        let mesh = TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
        let mut bytes = Vec::new();
        write_ply(&mesh, "two\nlines", &mut bytes).unwrap();
        let end = b"end_header\n";
        let start = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
        let header = std::str::from_utf8(&bytes[..start]).unwrap();
        assert!(
            header.contains("comment two lines\nelement vertex 4\n") && header.contains("element face 4\n")
        );
        assert_eq!(bytes.len() - start, 4 * 24 + 4 * 13);
        let z = &bytes[start + 3 * 24 + 16..start + 4 * 24];
        assert_eq!(f64::from_le_bytes(z.try_into().unwrap()), 0.1);
        let last = &bytes[bytes.len() - 13..];
        assert_eq!(last, [3, 2, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0]);
    }
}
