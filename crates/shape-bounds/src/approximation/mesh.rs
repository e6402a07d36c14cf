//! A sphere of triangles.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

/// Points of unit length and triangles, anticlockwise from outside: the faces of an octahedron, divided into `parts` along each
/// edge and projected.
pub(super) fn sphere(parts: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let parts = parts.max(1) as i32;
    let (mut numbers, mut points, mut triangles) = (HashMap::new(), Vec::new(), Vec::new());
    let mut number = |at: IVec3| {
        *numbers.entry(at).or_insert_with(|| {
            points.push(at.as_dvec3().normalize());
            points.len() as u32 - 1
        })
    };
    for octant in 0..8 {
        let signs = IVec3::new(1 - 2 * (octant & 1), 1 - (octant & 2), 1 - (octant >> 2) * 2);
        let mut corner = |i: i32, j: i32| number(signs * IVec3::new(i, j, parts - i - j));
        let mut add = |[a, b, c]: [u32; 3]| {
            triangles.push(if signs.element_product() > 0 { [a, b, c] } else { [a, c, b] });
        };
        for i in 0..parts {
            for j in 0..parts - i {
                add([corner(i, j), corner(i + 1, j), corner(i, j + 1)]);
                if i + j + 1 < parts {
                    add([corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
                }
            }
        }
    }
    (points, triangles)
}
