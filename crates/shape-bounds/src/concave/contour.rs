//! The zero surface of a function as triangles: marching tetrahedra.

use exact_hull::TriangleMesh;
use glam::DVec3;
use std::collections::HashMap;

/// Corners of a cell, by bits for x, y and z, of the six tetrahedra about its diagonal (Kuhn): neighbouring cells cut the
/// face between them along the same line, so that the surface has no cracks.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// A function on the corners of a lattice of cubes.
struct Lattice {
    low: DVec3,
    step: f64,
    /// Corners along each axis.
    counts: [usize; 3],
    values: Vec<f64>,
}

impl Lattice {
    fn sample(low: DVec3, high: DVec3, cells: usize, value: impl Fn(DVec3) -> f64) -> Self {
        let step = (high - low).max_element() / cells as f64;
        let counts = (high - low).to_array().map(|span| (span / step).ceil() as usize + 1);
        let mut lattice = Self { low, step, counts, values: Vec::new() };
        let all = counts.iter().product();
        lattice.values = (0..all).map(|k| value(lattice.place(k))).collect();
        lattice
    }

    fn place(&self, k: usize) -> DVec3 {
        let [nx, ny, _] = self.counts;
        let at = DVec3::new((k % nx) as f64, (k / nx % ny) as f64, (k / nx / ny) as f64);
        self.low + at * self.step
    }

    /// The corners of each cell.
    fn cells(&self) -> impl Iterator<Item = [usize; 8]> + '_ {
        let [nx, ny, nz] = self.counts;
        let steps = [1, nx, nx * ny];
        let first = move |k: usize| k % nx + 1 < nx && k / nx % ny + 1 < ny && k / nx / ny + 1 < nz;
        (0..self.values.len()).filter(move |k| first(*k)).map(move |k| {
            std::array::from_fn(|bits| k + (0..3).map(|axis| (bits >> axis & 1) * steps[axis]).sum::<usize>())
        })
    }
}

/// Triangles of the surface where `value` is zero, counter-clockwise seen from where it is positive, on a lattice of
/// `cells` along the longest side of the box from `low` to `high`.
///
/// Corners lie where a straight line between the values at the ends of a lattice edge is zero: off by the square of the
/// spacing. What crosses the box is open there.
pub(super) fn zero_surface(
    low: DVec3,
    high: DVec3,
    cells: usize,
    value: impl Fn(DVec3) -> f64,
) -> TriangleMesh {
    let lattice = Lattice::sample(low, high, cells, value);
    let mut net = Net { lattice: &lattice, known: HashMap::new(), mesh: TriangleMesh::default() };
    for cell in lattice.cells() {
        for corners in TETRAHEDRA {
            net.cut(corners.map(|c| cell[c]));
        }
    }
    net.mesh
}

struct Net<'a> {
    lattice: &'a Lattice,
    /// The vertex on each lattice edge that was cut.
    known: HashMap<(usize, usize), u32>,
    mesh: TriangleMesh,
}

impl Net<'_> {
    fn cut(&mut self, corners: [usize; 4]) {
        let inside = |k: &usize| self.lattice.values[*k] < 0.0;
        let (inner, outer): (Vec<usize>, Vec<usize>) = corners.iter().partition(|k| inside(k));
        let between = |net: &mut Self, pairs: &[(usize, usize)]| -> Vec<u32> {
            pairs.iter().map(|(a, b)| net.vertex(*a, *b)).collect()
        };
        let ring = match (&inner[..], &outer[..]) {
            ([a], [b, c, d]) | ([b, c, d], [a]) => between(self, &[(*a, *b), (*a, *c), (*a, *d)]),
            ([a, b], [c, d]) => between(self, &[(*a, *c), (*a, *d), (*b, *d), (*b, *c)]),
            _ => return,
        };
        let outwards = self.lattice.place(outer[0]) - self.lattice.place(inner[0]);
        for k in 1..ring.len() - 1 {
            self.triangle([ring[0], ring[k], ring[k + 1]], outwards);
        }
    }

    /// The vertex on the edge between two lattice corners of different sign.
    fn vertex(&mut self, a: usize, b: usize) -> u32 {
        let (a, b) = (a.min(b), a.max(b));
        let (lattice, mesh) = (self.lattice, &mut self.mesh);
        *self.known.entry((a, b)).or_insert_with(|| {
            let (from, to) = (lattice.values[a], lattice.values[b]);
            let (p, q) = (lattice.place(a), lattice.place(b));
            mesh.vertices.push(p + (q - p) * (from / (from - to)));
            (mesh.vertices.len() - 1) as u32
        })
    }

    /// Adds a triangle that faces `outwards`, which leads from a corner inside to one outside.
    fn triangle(&mut self, corners: [u32; 3], outwards: DVec3) {
        let [a, b, c] = corners.map(|k| self.mesh.vertices[k as usize]);
        let normal = (b - a).cross(c - a);
        let turned = [corners[0], corners[2], corners[1]];
        self.mesh.triangles.push(if normal.dot(outwards) >= 0.0 { corners } else { turned });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_torus_is_closed_and_its_volume_is_right_to_second_order() {
        let (ring, tube) = (1.0, 0.4);
        let value = |p: DVec3| (p.x.hypot(p.y) - ring).hypot(p.z) - tube;
        let truth = 2.0 * std::f64::consts::PI.powi(2) * ring * tube * tube;
        let error = |cells: usize| {
            let mesh = zero_surface(DVec3::splat(-1.6), DVec3::splat(1.57), cells, value);
            let mut edges = std::collections::HashMap::new();
            for t in &mesh.triangles {
                for k in 0..3 {
                    *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
                }
            }
            assert!(edges.iter().all(|((a, b), count)| *count == 1 && edges.get(&(*b, *a)) == Some(&1)));
            assert_eq!(mesh.vertices.len() + mesh.triangles.len() - edges.len() / 2, 0, "Euler's number");
            (mesh.moments().volume - truth).abs()
        };
        let (coarse, fine) = (error(20), error(40));
        let order = (coarse / fine).log2();
        assert!((1.6..2.6).contains(&order), "{coarse} {fine}");
    }
}
