use super::Model;
use contact_kinematics::{Direction, Monomial, PolynomialSupport, ShapeError, SupportFunction};
use glam::{DMat3, DVec3};
use nalgebra::DVector;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Coefficients of real orthonormal spherical harmonics up to a degree, all in m: linear.
pub(in crate::fit) struct HarmonicModel {
    degree: usize,
    basis: Vec<PolynomialSupport>,
    /// For each harmonic its monomials: place in [`monomials`] and coefficient.
    sums: Vec<Vec<(usize, f64)>>,
}

impl HarmonicModel {
    /// # Errors
    /// [`ShapeError::Degree`] above the degree that [`PolynomialSupport`] takes.
    pub(in crate::fit) fn new(degree: usize) -> Result<Self, ShapeError> {
        let mut basis = Vec::new();
        for l in 0..=degree {
            for index in 0..=2 * l {
                let mut rows: Vec<Vec<f64>> = (0..=l).map(|l| vec![0.0; 2 * l + 1]).collect();
                rows[l][index] = 1.0;
                basis.push(PolynomialSupport::from_harmonics(&rows)?);
            }
        }
        let places: HashMap<[usize; 3], usize> =
            monomials(degree).enumerate().map(|(place, powers)| (powers, place)).collect();
        let sums = basis
            .iter()
            .map(|harmonic| {
                let place = |t: &Monomial| Some((*places.get(&t.powers.map(|p| p as usize))?, t.coefficient));
                harmonic.terms().iter().filter_map(place).collect()
            })
            .collect();
        Ok(Self { degree, basis, sums })
    }

    /// The support function with coefficients `theta`.
    pub(in crate::fit) fn body(theta: &DVector<f64>) -> Result<PolynomialSupport, ShapeError> {
        let mut rows = Vec::new();
        let mut start = 0;
        while start < theta.len() {
            let length = 2 * rows.len() + 1;
            rows.push(theta.as_slice()[start..start + length].to_vec());
            start += length;
        }
        PolynomialSupport::from_harmonics(&rows)
    }

    /// Hessian of each harmonic at `n`.
    pub(in crate::fit) fn hessians(&self, n: Direction) -> Vec<DMat3> {
        self.basis.iter().map(|harmonic| harmonic.jet(n).hessian).collect()
    }
}

impl Model for HarmonicModel {
    fn count(&self) -> usize {
        self.basis.len()
    }

    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn SupportFunction>> {
        Some(Box::new(Self::body(theta).ok()?))
    }

    fn columns(&self, _theta: &DVector<f64>, n: Direction, columns: &mut [DVec3]) -> Option<()> {
        // Harmonics share monomials: each of those is evaluated once.
        let points: Vec<DVec3> = each_point(self.degree, n.get());
        for (column, sum) in columns.iter_mut().zip(&self.sums) {
            *column = sum.iter().map(|(place, coefficient)| points[*place] * *coefficient).sum();
        }
        Some(())
    }

    fn name(&self, parameter: usize) -> String {
        let l = parameter.isqrt();
        format!("harmonic {l},{}", parameter as i64 - (l * l + l) as i64)
    }

    /// `Y_00 = 1 / sqrt(4 pi)`; `Y_1m = sqrt(3 / 4 pi)` times y, z, x.
    fn ball(&self, centre: DVec3, radius: f64) -> DVector<f64> {
        let mut theta = DVector::zeros(self.count());
        theta[0] = radius * (4.0 * PI).sqrt();
        for (k, c) in [centre.y, centre.z, centre.x].into_iter().enumerate().take(self.count() - 1) {
            theta[1 + k] = c * (4.0 * PI / 3.0).sqrt();
        }
        theta
    }
}

/// Powers of x, y, z of all monomials up to a degree.
fn monomials(degree: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..=degree)
        .flat_map(move |i| (0..=degree - i).flat_map(move |j| (0..=degree - i - j).map(move |k| [i, j, k])))
}

/// Gradient at the unit vector `n` of the 1-homogeneous extension of each monomial, in the order of [`monomials`].
fn each_point(degree: usize, n: DVec3) -> Vec<DVec3> {
    let mut powers = vec![DVec3::ONE; degree + 1];
    for i in 1..=degree {
        powers[i] = powers[i - 1] * n;
    }
    let slope = |axis: usize, p: usize| if p > 0 { p as f64 * powers[p - 1][axis] } else { 0.0 };
    monomials(degree)
        .map(|[i, j, k]| {
            let (x, y, z) = (powers[i].x, powers[j].y, powers[k].z);
            let gradient = DVec3::new(slope(0, i) * y * z, x * slope(1, j) * z, x * y * slope(2, k));
            gradient + n * ((1.0 - (i + j + k) as f64) * x * y * z)
        })
        .collect()
}
