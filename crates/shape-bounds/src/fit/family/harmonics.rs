use super::Model;
use contact_kinematics::{Direction, PolynomialSupport, ShapeError, SupportFunction, SupportJet};
use glam::{DMat3, DVec3};
use nalgebra::DVector;
use std::f64::consts::PI;

/// Coefficients of real orthonormal spherical harmonics up to a degree, all in m: linear.
pub(in crate::fit) struct HarmonicModel {
    basis: Vec<PolynomialSupport>,
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
        Ok(Self { basis })
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

    fn jet(&self, theta: &DVector<f64>, n: Direction, mut columns: Option<&mut [DVec3]>) -> Option<SupportJet> {
        let mut sum = SupportJet { value: 0.0, point: DVec3::ZERO, hessian: DMat3::ZERO };
        for (k, harmonic) in self.basis.iter().enumerate() {
            let jet = harmonic.jet(n);
            sum.value += jet.value * theta[k];
            sum.point += jet.point * theta[k];
            sum.hessian += jet.hessian * theta[k];
            if let Some(columns) = &mut columns {
                columns[k] = jet.point;
            }
        }
        Some(sum)
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
