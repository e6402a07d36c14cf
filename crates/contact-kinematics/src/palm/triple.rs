use super::PalmError;
use glam::{DMat3, DVec3};

/// Largest condition of the matrix of normals for which the centre of mass is taken from the radius functions,
/// `p_WCm = N^-1 r`. It loses `log10(condition)` digits; at 1e6, ten are left.
const LARGEST_CONDITION: f64 = 1e6;

/// The three palm normals as the rows of `N`, with its inverse: `N p_WCm = r` (palms through the origin).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmTriple {
    normals: [DVec3; 3],
    inverse: DMat3,
    condition: f64,
}

impl PalmTriple {
    /// From the three unit normals in world axes.
    ///
    /// # Errors
    /// [`PalmError::Parallel`] when the normals are so near to a common plane that the inverse is worthless.
    pub fn new(normals: [DVec3; 3]) -> Result<Self, PalmError> {
        let n = DMat3::from_cols(normals[0], normals[1], normals[2]).transpose();
        let determinant = n.determinant();
        let inverse = n.inverse();
        // Frobenius norms bound the spectral ones from above by a factor of at most sqrt(3) each.
        let condition = frobenius(n) * frobenius(inverse) / 3.0;
        if condition.is_nan() || condition > LARGEST_CONDITION || !inverse.is_finite() {
            let condition = if condition.is_nan() { f64::INFINITY } else { condition };
            return Err(PalmError::Parallel { determinant, condition, limit: LARGEST_CONDITION });
        }
        Ok(Self { normals, inverse, condition })
    }

    /// The normals, in world axes.
    #[must_use]
    pub fn normals(&self) -> &[DVec3; 3] {
        &self.normals
    }

    /// Solves `n_i . x = rhs_i` for `x`.
    #[must_use]
    pub fn solve(&self, rhs: DVec3) -> DVec3 {
        self.inverse * rhs
    }

    /// Solves `sum_i f_i n_i = force` for the `f_i`.
    #[must_use]
    pub fn solve_transposed(&self, force: DVec3) -> DVec3 {
        self.inverse.transpose() * force
    }

    /// `N^-1`.
    #[must_use]
    pub fn inverse(&self) -> DMat3 {
        self.inverse
    }

    /// Condition of `N`, as the product of Frobenius norms over 3: 1 for perpendicular palms.
    #[must_use]
    pub fn condition(&self) -> f64 {
        self.condition
    }
}

fn frobenius(m: DMat3) -> f64 {
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PalmFrame;

    #[test]
    fn perpendicular_palms_have_condition_one() {
        let triple = PalmTriple::new([DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
        assert!((triple.condition() - 1.0).abs() < 1e-15);
        assert_eq!(triple.solve(DVec3::new(1.0, 2.0, 3.0)), DVec3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn parallel_palms_are_an_error_and_near_parallel_ones_report_their_condition() {
        let palm = |azimuth: f64| PalmFrame::from_azimuth_slope(azimuth, 1.0).n;
        assert!(matches!(
            PalmTriple::new([palm(0.0), palm(0.0), palm(2.0)]),
            Err(PalmError::Parallel { .. })
        ));
        assert!(matches!(
            PalmTriple::new([DVec3::NAN, palm(0.0), palm(2.0)]),
            Err(PalmError::Parallel { .. })
        ));
        let near = PalmTriple::new([palm(0.0), palm(1e-3), palm(2.0)]).unwrap();
        assert!(near.condition() > 1e3 && near.condition() < 1e4);
    }
}
