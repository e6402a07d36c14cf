//! A Gaussian process over implicit surfaces: the planner that others are measured against.
//!
//! The surface is where a random function is zero. Its prior mean is a sphere, its kernel Matern's of order 5/2,
//! `(1 + a + a^2 / 3) exp(-a)` with `a = sqrt 5 |d| / l`; a Gaussian kernel of such lengths is so smooth that rounding is left of its
//! variance after ten contacts. At each contact the function is known to be zero, with the normal as its gradient (Williams and Fitzgibbon, "Gaussian process implicit surfaces", 2007;
//! gradients as in Solak et al., "Derivative observations in Gaussian process models of dynamic systems", 2003). Everything is in
//! units of the sphere: lengths over its radius, about its centre.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Length of the kernel over the radius of the sphere: of 1, 2 and 4, tried on twenty bodies, none needed clearly fewer touches.
pub(crate) const LENGTH: f64 = 2.0;
/// Variance of what is observed: far below what is asked of the shape. Raised tenfold until the matrix can be factored.
const NUGGET: f64 = 1e-9;
/// As many times of a normal: at an edge that is nearly sharp, contacts at one place have different ones.
const OF_NORMALS: f64 = 1e5;
const RAISES: usize = 6;
/// Halvings when the surface is looked for along a ray.
const HALVINGS: usize = 40;
/// Rays are followed to this many radii, in so many steps.
const FAR: f64 = 4.0;
const STEPS: i32 = 40;

/// The process after some contacts.
pub(crate) struct ImplicitSurface<const D: usize> {
    points: Vec<[f64; D]>,
    factor: Cholesky<f64, Dyn>,
    weights: DVector<f64>,
}

/// The kernel between two places, and what its derivatives are made of.
struct Kernel<const D: usize> {
    /// `x - y`.
    d: [f64; D],
    value: f64,
    /// The derivative by a coordinate of `x` is minus this times that of `d`.
    slope: f64,
    /// The second derivative by two of them is `bend` times both of `d`, less `slope` where they are one.
    bend: f64,
}

impl<const D: usize> Kernel<D> {
    fn of(x: &[f64; D], y: &[f64; D]) -> Self {
        let d: [f64; D] = std::array::from_fn(|i| x[i] - y[i]);
        let l2 = LENGTH * LENGTH;
        let a = (5.0 * d.iter().map(|c| c * c).sum::<f64>() / l2).sqrt();
        let falling = (-a).exp();
        let slope = 5.0 / (3.0 * l2) * (1.0 + a) * falling;
        let bend = 25.0 / (3.0 * l2 * l2) * falling;
        Self { d, value: (1.0 + a + a * a / 3.0) * falling, slope, bend }
    }
}

impl<const D: usize> ImplicitSurface<D> {
    /// From contacts anywhere, about their centre and scaled to a mean distance of one from it.
    pub(crate) fn about(contacts: &[([f64; D], [f64; D])]) -> Option<Self> {
        let mean = |of: &dyn Fn(&[f64; D]) -> f64| {
            contacts.iter().map(|(point, _)| of(point)).sum::<f64>() / contacts.len() as f64
        };
        let centre: [f64; D] = std::array::from_fn(|i| mean(&|point| point[i]));
        let from = |point: &[f64; D]| -> [f64; D] { std::array::from_fn(|i| point[i] - centre[i]) };
        let radius = mean(&|point| from(point).iter().map(|c| c * c).sum::<f64>().sqrt());
        let scaled: Vec<_> = contacts.iter().map(|(p, n)| (from(p).map(|c| c / radius), *n)).collect();
        Self::new(&scaled)
    }

    /// From contacts (points, outward unit normals); none if the matrix cannot be factored.
    pub(crate) fn new(contacts: &[([f64; D], [f64; D])]) -> Option<Self> {
        let (count, block) = (contacts.len(), D + 1);
        let mut matrix = DMatrix::zeros(count * block, count * block);
        let mut residual = DVector::zeros(count * block);
        for (a, (x, n)) in contacts.iter().enumerate() {
            // The prior mean is (|x|^2 - 1) / 2, whose gradient is x.
            residual[a * block] = -0.5 * (x.iter().map(|c| c * c).sum::<f64>() - 1.0);
            for i in 0..D {
                residual[a * block + 1 + i] = n[i] - x[i];
            }
            for (b, (y, _)) in contacts.iter().enumerate() {
                fill(&mut matrix, [a * block, b * block], x, y);
            }
        }
        let mut nugget = NUGGET;
        for _ in 0..RAISES {
            let mut with = matrix.clone();
            (0..count * block)
                .for_each(|k| with[(k, k)] += if k % block == 0 { nugget } else { nugget * OF_NORMALS });
            if let Some(factor) = Cholesky::new(with) {
                let weights = factor.solve(&residual);
                let points = contacts.iter().map(|c| c.0).collect();
                return Some(Self { points, factor, weights });
            }
            nugget *= 10.0;
        }
        None
    }

    /// Covariances of the value at `x` with everything that is known.
    fn row(&self, x: &[f64; D]) -> DVector<f64> {
        let block = D + 1;
        let mut row = DVector::zeros(self.points.len() * block);
        for (b, y) in self.points.iter().enumerate() {
            let k = Kernel::of(x, y);
            row[b * block] = k.value;
            for j in 0..D {
                row[b * block + 1 + j] = k.slope * k.d[j];
            }
        }
        row
    }

    /// Mean at `x`: below zero inside.
    fn value(&self, x: &[f64; D]) -> f64 {
        0.5 * (x.iter().map(|c| c * c).sum::<f64>() - 1.0) + self.row(x).dot(&self.weights)
    }

    /// Gradient of the mean at `x`.
    fn gradient(&self, x: &[f64; D]) -> [f64; D] {
        let block = D + 1;
        let mut gradient = *x;
        for (b, y) in self.points.iter().enumerate() {
            let k = Kernel::of(x, y);
            let weight = |j: usize| self.weights[b * block + j];
            let along: f64 = (0..D).map(|j| k.d[j] * weight(1 + j)).sum();
            for i in 0..D {
                gradient[i] += k.slope * (weight(1 + i) - weight(0) * k.d[i]) - k.bend * k.d[i] * along;
            }
        }
        gradient
    }

    /// Where a ray from the centre leaves the mean surface, the gradient there and the variance; none if it does not.
    pub(crate) fn along(&self, ray: &[f64; D]) -> Option<([f64; D], f64)> {
        let at = |t: f64| -> [f64; D] { std::array::from_fn(|i| ray[i] * t) };
        // The first crossing: far from all contacts the mean may return.
        let step =
            (1..=STEPS).map(|k| FAR * f64::from(k) / f64::from(STEPS)).find(|t| self.value(&at(*t)) > 0.0)?;
        let (mut inside, mut outside) = (step - FAR / f64::from(STEPS), step);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if self.value(&at(middle)) < 0.0 { inside = middle } else { outside = middle }
        }
        let x = at(inside);
        let whitened = self.factor.l().solve_lower_triangular(&self.row(&x))?;
        Some((self.gradient(&x), 1.0 - whitened.norm_squared()))
    }
}

/// Covariances of value and gradient at `x` with those at `y`.
fn fill<const D: usize>(matrix: &mut DMatrix<f64>, [row, column]: [usize; 2], x: &[f64; D], y: &[f64; D]) {
    let k = Kernel::of(x, y);
    matrix[(row, column)] = k.value;
    for i in 0..D {
        matrix[(row + 1 + i, column)] = -k.slope * k.d[i];
        matrix[(row, column + 1 + i)] = k.slope * k.d[i];
        for j in 0..D {
            let same = if i == j { k.slope } else { 0.0 };
            matrix[(row + 1 + i, column + 1 + j)] = same - k.bend * k.d[i] * k.d[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a unit circle shifted by a tenth the mean surface passes through the contacts with their normals, and is sure of them.
    #[test]
    fn the_mean_surface_passes_through_its_contacts() {
        let contact = |angle: f64| ([angle.cos() + 0.1, angle.sin()], [angle.cos(), angle.sin()]);
        let contacts: Vec<_> = (0..7).map(|k| contact(0.9 * f64::from(k))).collect();
        let surface = ImplicitSurface::new(&contacts).unwrap();
        for (x, n) in &contacts {
            assert!(surface.value(x).abs() < 1e-5);
            let g = surface.gradient(x);
            assert!((g[0] - n[0]).abs() < 1e-3 && (g[1] - n[1]).abs() < 1e-3, "{g:?} {n:?}");
            let (_, variance) = surface.along(x).unwrap();
            assert!(variance.abs() < 1e-5);
        }
        // The gradient is that of the value.
        let (x, h) = ([0.4, -0.7], 1e-5);
        let slope = (surface.value(&[x[0] + h, x[1]]) - surface.value(&[x[0] - h, x[1]])) / (2.0 * h);
        assert!((surface.gradient(&x)[0] - slope).abs() < 1e-6);
        // Far from all contacts it is less sure.
        let few = ImplicitSurface::new(&contacts[..2]).unwrap();
        assert!(few.along(&[-1.0, 0.0]).unwrap().1 > 1e-3);
    }
}
