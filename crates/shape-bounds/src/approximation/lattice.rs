//! Cubic B-splines on a lattice about the unit sphere, and how much they vary.

use super::basis::{cubic, grams};
use super::envelope::Envelope;
use nalgebra::SVector;

/// No B-spline.
const NONE: u32 = u32::MAX;

/// Products of cubic B-splines on a lattice of cubes in `D` dimensions, those that are not zero somewhere on the unit sphere: a
/// twice continuously differentiable function on the sphere is a function of space restricted to it, so that no chart is needed
/// and no pole or seam is to be glued (Lehmann, Maier, Odathuparambil and Reif, "Ambient
/// approximation on hypersurfaces", 2019).
#[derive(Clone, Debug)]
pub(super) struct Lattice<const D: usize> {
    /// Cells from the centre to the sphere along an axis.
    half: usize,
    /// The number of the B-spline at each place of the lattice.
    numbers: Vec<u32>,
    count: usize,
    /// Lowest corners of the cells that meet the sphere.
    cells: Vec<[usize; D]>,
}

impl<const D: usize> Lattice<D> {
    /// With `half` cells from the centre to the sphere.
    pub(super) fn new(half: usize) -> Self {
        let mut lattice =
            Self { half, numbers: vec![NONE; (2 * half + 3).pow(D as u32)], count: 0, cells: Vec::new() };
        let reach = half as i64;
        for place in 0..(2 * half).pow(D as u32) {
            let cell: [usize; D] =
                std::array::from_fn(|axis| place / (2 * half).pow(axis as u32) % (2 * half));
            // In units of the spacing all is whole numbers, and no cell is missed for rounding.
            let ends = cell.map(|c| (c as i64 - reach, c as i64 + 1 - reach));
            let near: i64 = ends.iter().map(|(a, b)| (a * a).min(b * b)).sum();
            let far: i64 = ends.iter().map(|(a, b)| (a * a).max(b * b)).sum();
            if near <= reach * reach && reach * reach <= far {
                places(cell, 2 * half + 3).for_each(|(_, place)| lattice.numbers[place] = 0);
                lattice.cells.push(cell);
            }
        }
        for number in lattice.numbers.iter_mut().filter(|number| **number != NONE) {
            *number = lattice.count as u32;
            lattice.count += 1;
        }
        lattice
    }

    /// Cells from the centre to the sphere along an axis.
    pub(super) fn half(&self) -> usize {
        self.half
    }

    /// How many B-splines there are.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Calls with the number, the value and the gradient of each B-spline at `u` of unit length, in order of their numbers.
    pub(super) fn each_at(&self, u: &SVector<f64, D>, mut visit: impl FnMut(usize, f64, SVector<f64, D>)) {
        let scale = self.half as f64;
        let (mut cell, mut along) = ([0; D], [[[0.0; 4]; 4]; D]);
        for axis in 0..D {
            let x = (u[axis] + 1.0) * scale;
            cell[axis] = (x.max(0.0) as usize).min(2 * self.half - 1);
            along[axis] = cubic(x - cell[axis] as f64);
        }
        for (steps, place) in places(cell, 2 * self.half + 3) {
            // A factor for each axis, of which the derivative along `by` takes one.
            let product =
                |by: usize| (0..D).map(|k| along[k][usize::from(k == by)][steps[k]]).product::<f64>();
            let gradient = SVector::from_fn(|axis, _| product(axis) * scale);
            visit(self.numbers[place] as usize, product(D), gradient);
        }
    }

    /// The integral of the squared second and third derivatives over all cells, over the thickness of the layer that they make: about
    /// that over the sphere. Zero for linear functions alone, which move a sphere or make it larger.
    ///
    /// The third ones are what makes the error fall with the fourth power of the spacing at once; the second ones fix what those leave
    /// open, as the square of the radius, which does not vary on the sphere.
    pub(super) fn energy(&self) -> Envelope {
        let own: Vec<Vec<usize>> = (self.cells.iter())
            .map(|cell| {
                places(*cell, 2 * self.half + 3).map(|(_, place)| self.numbers[place] as usize).collect()
            })
            .collect();
        let mut first: Vec<usize> = (0..self.count).collect();
        for numbers in &own {
            // In order, so that the first is the least.
            numbers.iter().for_each(|n| first[*n] = first[*n].min(numbers[0]));
        }
        let element = self.element();
        let mut energy = Envelope::zeros(first);
        for numbers in &own {
            for (row, i) in element.iter().zip(numbers) {
                row.iter().zip(numbers).filter(|(_, j)| *j <= i).for_each(|(e, j)| energy.add(*i, *j, *e));
            }
        }
        energy
    }

    /// The energy of one cell.
    fn element(&self) -> Vec<Vec<f64>> {
        let grams = grams();
        let all: Vec<[usize; D]> = places([0; D], 4).map(|(steps, _)| steps).collect();
        // Derivatives scale with the number of cells, the volume of a cell and the thickness inversely.
        let half = self.half as f64;
        let entry = |i: &[usize; D], j: &[usize; D]| {
            let sum = |rank: u32| -> f64 {
                let one = |derivative: usize| {
                    let along: Vec<usize> = (0..rank).map(|k| derivative / D.pow(k) % D).collect();
                    let order = |axis: usize| along.iter().filter(|a| **a == axis).count();
                    (0..D).map(|axis| grams[order(axis)][i[axis]][j[axis]]).product::<f64>()
                };
                (0..D.pow(rank)).map(one).sum::<f64>() * half.powi(2 * rank as i32 + 1 - D as i32)
            };
            sum(3) + sum(2)
        };
        all.iter().map(|i| all.iter().map(|j| entry(i, j)).collect()).collect()
    }
}

/// The `4^D` steps from a cell's lowest corner, the first axis the fastest, and their places in a lattice with so many along an axis.
fn places<const D: usize>(
    cell: [usize; D],
    along: usize,
) -> impl Iterator<Item = ([usize; D], usize)> + use<D> {
    (0..4_usize.pow(D as u32)).map(move |k| {
        let steps: [usize; D] = std::array::from_fn(|axis| k >> (2 * axis) & 3);
        let place = (0..D).rev().fold(0, |sum, axis| sum * along + cell[axis] + steps[axis]);
        (steps, place)
    })
}
