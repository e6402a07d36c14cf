//! Tetrahedra with their neighbours, and what stands outside of the hull.

use crate::predicates::above;
use glam::DVec3;
use robust::Coord3D;

/// The vertex at infinity, fourth of every tetrahedron outside of the hull.
pub const OUTSIDE: u32 = u32::MAX;

/// Corners of the face opposite to each corner, anticlockwise seen from outside.
const FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// A tetrahedron whose fourth corner is above the first three, or a facet of the hull (anticlockwise seen from outside) with
/// the vertex at infinity.
#[derive(Clone, Copy, Debug)]
pub struct Tetrahedron {
    /// Indices of the points.
    pub corners: [u32; 4],
    /// The tetrahedron across the face opposite to each corner.
    pub neighbours: [u32; 4],
}

impl Tetrahedron {
    /// With the corners of a positive tetrahedron; the vertex at infinity is brought to the end.
    pub(super) fn new(mut corners: [u32; 4]) -> Self {
        if let Some(at) = corners[..3].iter().position(|c| *c == OUTSIDE) {
            // Two exchanges keep the orientation.
            corners.swap(at, 3);
            corners.swap((at + 1) % 3, (at + 2) % 3);
        }
        Self { corners, neighbours: [OUTSIDE; 4] }
    }

    /// Whether it is a facet of the hull, seen from outside.
    #[must_use]
    pub fn is_outside(&self) -> bool {
        self.corners[3] == OUTSIDE
    }

    /// Corners of a face, anticlockwise seen from outside.
    #[must_use]
    pub fn face(&self, opposite: usize) -> [u32; 3] {
        FACES[opposite].map(|k| self.corners[k])
    }

    /// Whether `p` is strictly inside of the sphere through the four corners, of those that are no facet of the hull; exact for
    /// points in the range of spheres ([`crate::ScaledPoints::for_spheres`]).
    #[must_use]
    pub fn sphere_holds(&self, points: &[DVec3], p: DVec3) -> bool {
        let at = |k: usize| {
            let DVec3 { x, y, z } = points[self.corners[k] as usize];
            Coord3D { x, y, z }
        };
        // `robust` wants the mirrored order.
        robust::insphere(at(1), at(0), at(2), at(3), Coord3D { x: p.x, y: p.y, z: p.z }) > 0.0
    }

    /// Positive where `p` is strictly outside of a finite face; exact for points in the range of planes.
    #[must_use]
    pub fn beyond(&self, points: &[DVec3], opposite: usize, p: DVec3) -> f64 {
        let [a, b, c] = self.face(opposite).map(|k| points[k as usize]);
        above(a, b, c, p)
    }
}
