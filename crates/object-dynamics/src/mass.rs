use glam::{DMat3, DQuat, DVec3};
use thiserror::Error;

/// Relative slack of the checks below, for inertias that are rounded to print (about 1e-12 in a 12-digit file).
const ROUNDING: f64 = 1e-9;

/// Mass and rotational inertia of a rigid body about its centre of mass, checked to be physically possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    mass: f64,
    inertia: DMat3,
    inverse_inertia: DMat3,
}

/// Principal moments of inertia, ascending, and the axes that they belong to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalInertia {
    /// Moments in kg m^2, ascending.
    pub moments: DVec3,
    /// Rotation `R_OI` from principal axes to body axes: its columns are the axes.
    pub axes: DQuat,
}

/// Which law a mass or an inertia breaks.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MassError {
    /// Mass is zero, negative or not a number.
    #[error("mass is {mass} kg; it must be positive and finite")]
    Mass {
        /// As given, in kg.
        mass: f64,
    },
    /// An inertia entry is not a number.
    #[error("inertia entry ({row}, {column}) is {value}; it must be finite")]
    NotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// As given.
        value: f64,
    },
    /// The tensor is not symmetric.
    #[error(
        "inertia tensor is not symmetric: entry ({row}, {column}) differs from its mirror image by {difference:.3e}"
    )]
    NotSymmetric {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// Difference of the two entries, in kg m^2.
        difference: f64,
    },
    /// A principal moment is zero or negative.
    #[error("principal moment of inertia {smallest:.6e} kg m^2 is not positive (moments {moments:?})")]
    NotPositive {
        /// The smallest moment.
        smallest: f64,
        /// All three, ascending.
        moments: [f64; 3],
    },
    /// The largest principal moment exceeds the sum of the others: no mass distribution has such an inertia.
    #[error(
        "principal moments of inertia {moments:?} kg m^2 break the triangle inequality: the largest exceeds the sum \
         of the others by {excess:.3e}"
    )]
    Triangle {
        /// All three, ascending.
        moments: [f64; 3],
        /// Largest minus the sum of the others.
        excess: f64,
    },
    /// A radius of gyration or semi-axis is zero, negative or not a number.
    #[error("{what} {index} is {value} m; it must be positive and finite")]
    Length {
        /// What the length is.
        what: &'static str,
        /// Which of the three, from 0.
        index: usize,
        /// As given, in m.
        value: f64,
    },
}

impl MassProperties {
    /// From the mass (kg) and the inertia tensor about the centre of mass in body axes (kg m^2; off-diagonal entries
    /// are those of the tensor, that is, minus the products of inertia).
    ///
    /// # Errors
    /// [`MassError`] names the law that fails: positive mass, finite and symmetric tensor, positive moments,
    /// triangle inequality.
    pub fn new(mass: f64, inertia: DMat3) -> Result<Self, MassError> {
        if !(mass > 0.0 && mass.is_finite()) {
            return Err(MassError::Mass { mass });
        }
        let largest = inertia.to_cols_array().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        for column in 0..3 {
            for row in 0..3 {
                let value = inertia.col(column)[row];
                if !value.is_finite() {
                    return Err(MassError::NotFinite { row, column, value });
                }
                let difference = value - inertia.col(row)[column];
                if difference.abs() > ROUNDING * largest {
                    return Err(MassError::NotSymmetric { row, column, difference });
                }
            }
        }
        let inertia = (inertia + inertia.transpose()) * 0.5;
        let moments = principal(inertia).moments.to_array();
        if moments[0].is_nan() || moments[0] <= 0.0 {
            return Err(MassError::NotPositive { smallest: moments[0], moments });
        }
        let excess = moments[2] - moments[0] - moments[1];
        if excess > ROUNDING * moments[2] {
            return Err(MassError::Triangle { moments, excess });
        }
        Ok(Self { mass, inertia, inverse_inertia: inertia.inverse() })
    }

    /// From principal moments of inertia (kg m^2) along the body axes.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_principal(mass: f64, moments: DVec3) -> Result<Self, MassError> {
        Self::new(mass, DMat3::from_diagonal(moments))
    }

    /// From radii of gyration (m) about the body axes: `I = m diag(rho^2)` (paper, section 4).
    ///
    /// # Errors
    /// [`MassError::Length`], and those of [`Self::new`].
    pub fn from_gyration(mass: f64, radii: DVec3) -> Result<Self, MassError> {
        check_lengths("radius of gyration", radii)?;
        Self::from_principal(mass, mass * radii * radii)
    }

    /// Of a uniform solid ellipsoid with the given semi-axes (m): `I_x = m (b^2 + c^2) / 5`.
    ///
    /// # Errors
    /// [`MassError::Length`], and those of [`Self::new`].
    pub fn uniform_ellipsoid(mass: f64, semi_axes: DVec3) -> Result<Self, MassError> {
        check_lengths("semi-axis", semi_axes)?;
        let square = semi_axes * semi_axes;
        Self::from_principal(mass, (DVec3::splat(square.element_sum()) - square) * (mass / 5.0))
    }

    /// Mass in kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Inertia tensor about the centre of mass, body axes, kg m^2.
    #[must_use]
    pub fn inertia(&self) -> DMat3 {
        self.inertia
    }

    /// Inverse of the inertia tensor, body axes.
    #[must_use]
    pub fn inverse_inertia(&self) -> DMat3 {
        self.inverse_inertia
    }

    /// Principal moments and axes.
    #[must_use]
    pub fn principal(&self) -> PrincipalInertia {
        principal(self.inertia)
    }
}

fn check_lengths(what: &'static str, lengths: DVec3) -> Result<(), MassError> {
    match (0..3).find(|&i| !(lengths[i] > 0.0 && lengths[i].is_finite())) {
        Some(index) => Err(MassError::Length { what, index, value: lengths[index] }),
        None => Ok(()),
    }
}

fn principal(inertia: DMat3) -> PrincipalInertia {
    let symmetric = nalgebra::SymmetricEigen::new(nalgebra::Matrix3::from(inertia));
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| symmetric.eigenvalues[a].total_cmp(&symmetric.eigenvalues[b]));
    let axis = |k: usize| {
        let v = symmetric.eigenvectors.column(order[k]);
        DVec3::new(v[0], v[1], v[2])
    };
    let (x, y) = (axis(0), axis(1));
    PrincipalInertia {
        moments: DVec3::from_array(order.map(|k| symmetric.eigenvalues[k])),
        axes: DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn each_law_has_its_own_error() {
        let diagonal = |x, y, z| MassProperties::from_principal(1.0, DVec3::new(x, y, z));
        assert!(matches!(MassProperties::from_principal(-1.0, DVec3::ONE), Err(MassError::Mass { .. })));
        assert!(matches!(MassProperties::from_principal(f64::NAN, DVec3::ONE), Err(MassError::Mass { .. })));
        assert!(matches!(diagonal(0.0, 1.0, 1.0), Err(MassError::NotPositive { .. })));
        assert!(matches!(diagonal(1.0, 1.0, 2.1), Err(MassError::Triangle { .. })));
        assert!(matches!(
            diagonal(1.0, f64::INFINITY, 1.0),
            Err(MassError::NotFinite { row: 1, column: 1, .. })
        ));
        let mut skew = DMat3::IDENTITY;
        skew.x_axis.y = 0.1;
        assert!(matches!(MassProperties::new(1.0, skew), Err(MassError::NotSymmetric { .. })));
        assert!(matches!(
            MassProperties::from_gyration(1.0, DVec3::new(1.0, -1.0, 1.0)),
            Err(MassError::Length { index: 1, .. })
        ));
    }

    #[test]
    fn flat_plate_is_the_limit_and_is_accepted() {
        assert!(MassProperties::from_principal(1.0, DVec3::new(1.0, 2.0, 3.0)).is_ok());
    }

    #[test]
    fn ellipsoid_of_the_papers_figure_5() {
        let mass = MassProperties::uniform_ellipsoid(1.0, DVec3::new(2.5, 2.0, 1.0)).unwrap();
        let diagonal = DVec3::new(1.0, 1.45, 2.05);
        assert!(
            (mass.inertia() - DMat3::from_diagonal(diagonal)).to_cols_array().iter().all(|v| v.abs() < 1e-15)
        );
    }

    proptest! {
        #[test]
        fn principal_axes_rebuild_the_tensor(a in 0.5..1.0f64, b in 0.5..1.0f64, c in 0.5..1.0f64,
                                             x in -3.0..3.0f64, y in -3.0..3.0f64, z in -3.0..3.0f64) {
            let r = DMat3::from_quat(DQuat::from_scaled_axis(DVec3::new(x, y, z)));
            let tensor = r * DMat3::from_diagonal(DVec3::new(a, b, c)) * r.transpose();
            let p = MassProperties::new(2.0, tensor).unwrap().principal();
            let axes = DMat3::from_quat(p.axes);
            let back = axes * DMat3::from_diagonal(p.moments) * axes.transpose();
            prop_assert!((back - tensor).to_cols_array().iter().all(|v| v.abs() < 1e-14));
            prop_assert!(p.moments.x <= p.moments.y && p.moments.y <= p.moments.z);
        }
    }
}
