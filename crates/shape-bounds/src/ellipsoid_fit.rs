//! The ellipsoid through contacts, where they are those of one.

use crate::sample::ContactSample;
use contact_kinematics::Direction;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen};
use thiserror::Error;

/// Unknowns: six entries of the quadric's matrix, three of its linear part.
const UNKNOWNS: usize = 9;
/// Contacts that determine them: each gives one equation by its point and two by its normal.
const FEWEST: usize = 3;
/// Smallest over largest pivot of the linear system below which some direction of the unknowns is not determined: the
/// contacts are given to no more than about ten digits.
const SMALLEST_PIVOT: f64 = 1e-9;

/// An ellipsoid in the body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidFit {
    /// Centre, m.
    pub centre: DVec3,
    /// Semi-axes, m, ascending.
    pub semi_axes: DVec3,
    /// Turns the ellipsoid's axes into those of the body.
    pub orientation: DQuat,
    /// Root mean square distance of the contacts from the ellipsoid's points with the same normals, m.
    pub misfit: f64,
}

/// Why contacts give no ellipsoid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum EllipsoidFitError {
    /// Too few contacts.
    #[error("{found} contact(s) given; an ellipsoid needs at least {FEWEST}")]
    TooFew {
        /// How many there are.
        found: usize,
    },
    /// Contacts that several ellipsoids go through, such as those of one place.
    #[error("the contacts do not determine an ellipsoid: smallest over largest pivot is {pivot:.1e}")]
    Undetermined {
        /// As computed; zero for contacts at one point.
        pivot: f64,
    },
    /// The quadric that fits best is open.
    #[error("the quadric that fits the contacts best is no ellipsoid")]
    NotEllipsoid,
}

impl EllipsoidFit {
    /// Fits an ellipsoid to points and normals.
    ///
    /// The quadric `x' A x + b . x = 1` about the contacts' mean shall hold the points and have its gradient along the
    /// normals: both are linear in `A` and `b`, so no start is needed. Exact for exact contacts of an ellipsoid; under
    /// noise the fit is biased by the square of the noise.
    ///
    /// # Errors
    /// [`EllipsoidFitError`]. Whether the contacts *are* those of an ellipsoid is what [`misfit`](Self::misfit) says.
    pub fn new(contacts: &[ContactSample]) -> Result<Self, EllipsoidFitError> {
        if contacts.len() < FEWEST {
            return Err(EllipsoidFitError::TooFew { found: contacts.len() });
        }
        let mean = contacts.iter().map(|c| c.point).sum::<DVec3>() / contacts.len() as f64;
        let size = contacts.iter().map(|c| c.point.distance(mean)).sum::<f64>() / contacts.len() as f64;
        if !(size > 0.0 && size.is_finite()) {
            return Err(EllipsoidFitError::Undetermined { pivot: 0.0 });
        }
        let (matrix, linear) = quadric(contacts, mean, size)?;
        Self::from_quadric(matrix, linear, mean, size, contacts)
    }

    fn from_quadric(
        matrix: DMat3,
        linear: DVec3,
        mean: DVec3,
        size: f64,
        contacts: &[ContactSample],
    ) -> Result<Self, EllipsoidFitError> {
        let eigen = SymmetricEigen::new(Matrix3::from(matrix));
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let values = order.map(|k| eigen.eigenvalues[k]);
        // The smallest eigenvalue must be more than rounding of the largest, or the centre is anywhere.
        if values[2].is_nan() || values[2] <= f64::EPSILON * values[0] {
            return Err(EllipsoidFitError::NotEllipsoid);
        }
        let axis = |k: usize| DVec3::from_array(eigen.eigenvectors.column(order[k]).into());
        let axes = DMat3::from_cols(axis(0), axis(1), axis(0).cross(axis(1)));
        let centre = axes * ((axes.transpose() * linear) / DVec3::from_array(values)) * -0.5;
        let level = 1.0 + centre.dot(matrix * centre);
        if level.is_nan() || level <= 0.0 {
            return Err(EllipsoidFitError::NotEllipsoid);
        }
        let mut fit = Self {
            centre: mean + size * centre,
            semi_axes: DVec3::from_array(values.map(|v| size * (level / v).sqrt())),
            orientation: DQuat::from_mat3(&axes).normalize(),
            misfit: 0.0,
        };
        let square: f64 = contacts.iter().map(|c| c.point.distance_squared(fit.point(c.normal))).sum();
        fit.misfit = (square / contacts.len() as f64).sqrt();
        Ok(fit)
    }

    /// The point with outward normal `n`, m, in the body's frame.
    #[must_use]
    pub fn point(&self, n: Direction) -> DVec3 {
        let along = self.semi_axes * (self.orientation.inverse() * n.get());
        // Semi-axes are positive and n is a unit vector.
        self.centre + self.orientation * (self.semi_axes * along / along.length())
    }
}

/// Matrix and linear part of `y' A y + b . y = 1`, `y = (x - mean) / size`, by least squares.
fn quadric(contacts: &[ContactSample], mean: DVec3, size: f64) -> Result<(DMat3, DVec3), EllipsoidFitError> {
    let mut rows = DMatrix::zeros(3 * contacts.len(), UNKNOWNS);
    let mut right = DVector::zeros(3 * contacts.len());
    for (k, contact) in contacts.iter().enumerate() {
        let y = (contact.point - mean) / size;
        let on = [
            y.x * y.x,
            y.y * y.y,
            y.z * y.z,
            2.0 * y.x * y.y,
            2.0 * y.x * y.z,
            2.0 * y.y * y.z,
            y.x,
            y.y,
            y.z,
        ];
        rows.row_mut(3 * k).copy_from_slice(&on);
        right[3 * k] = 1.0;
        let n = contact.normal.get();
        for (j, t) in [n.any_orthonormal_pair().0, n.any_orthonormal_pair().1].into_iter().enumerate() {
            // t . (2 A y + b) = 0.
            let across = [
                2.0 * t.x * y.x,
                2.0 * t.y * y.y,
                2.0 * t.z * y.z,
                2.0 * (t.x * y.y + t.y * y.x),
                2.0 * (t.x * y.z + t.z * y.x),
                2.0 * (t.y * y.z + t.z * y.y),
                t.x,
                t.y,
                t.z,
            ];
            rows.row_mut(3 * k + 1 + j).copy_from_slice(&across);
        }
    }
    let factors = rows.col_piv_qr();
    let triangle = factors.r();
    let pivots = triangle.diagonal().map(f64::abs);
    let pivot = pivots.min() / pivots.max();
    if pivot.is_nan() || pivot < SMALLEST_PIVOT {
        return Err(EllipsoidFitError::Undetermined { pivot });
    }
    let projected = factors.q().transpose() * right;
    let mut solution =
        triangle.solve_upper_triangular(&projected).ok_or(EllipsoidFitError::Undetermined { pivot })?;
    factors.p().inv_permute_rows(&mut solution);
    let u = solution;
    let matrix = DMat3::from_cols(
        DVec3::new(u[0], u[3], u[4]),
        DVec3::new(u[3], u[1], u[5]),
        DVec3::new(u[4], u[5], u[2]),
    );
    Ok((matrix, DVec3::new(u[6], u[7], u[8])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contacts of an ellipsoid along three curves of normals, as palms leave them.
    fn contacts(truth: &EllipsoidFit, spread: f64) -> Vec<ContactSample> {
        let curve = |k: u32| {
            let (s, t) = (f64::from(k) * 0.03, f64::from(k % 3) * 2.0);
            DVec3::new((t + spread * s).cos(), (t + spread * s).sin(), -0.5 + spread * (1.3 * s + t).sin())
        };
        let at = |n: DVec3| {
            let normal = Direction::new(n).unwrap();
            ContactSample { point: truth.point(normal), normal }
        };
        (0..90).map(|k| at(curve(k))).collect()
    }

    #[test]
    fn planted_ellipsoids_are_found() {
        for k in 0..40 {
            let wave = |step: f64| (f64::from(k) * step).sin();
            let truth = EllipsoidFit {
                centre: 2.0 * DVec3::new(wave(1.1), wave(1.7), wave(2.3)),
                semi_axes: DVec3::new(0.75 + 0.25 * wave(0.9), 1.6 + 0.4 * wave(1.3), 2.6 + 0.4 * wave(2.9)),
                orientation: DQuat::from_scaled_axis(3.0 * DVec3::new(wave(0.7), wave(1.9), wave(3.1))),
                misfit: 0.0,
            };
            let found = EllipsoidFit::new(&contacts(&truth, 1.0)).unwrap();
            // Rounding times the condition of the linear system, which is below 1e4 for these curves.
            assert!((found.centre - truth.centre).length() < 1e-10, "{k}");
            assert!((found.semi_axes - truth.semi_axes).length() < 1e-10, "{k}");
            let n = Direction::new(DVec3::new(0.3, 0.5, 0.9)).unwrap();
            assert!((found.point(n) - truth.point(n)).length() < 1e-10 && found.misfit < 1e-10, "{k}");
        }
    }

    #[test]
    fn contacts_of_no_ellipsoid_are_refused_or_have_a_misfit() {
        let n = Direction::Z;
        let one = ContactSample { point: DVec3::ONE, normal: n };
        assert_eq!(EllipsoidFit::new(&[one; 2]), Err(EllipsoidFitError::TooFew { found: 2 }));
        assert!(matches!(EllipsoidFit::new(&[one; 20]), Err(EllipsoidFitError::Undetermined { .. })));
        let saddle = (0..200).map(|k| {
            let (x, y) = (f64::from(k % 14) * 0.1 - 0.7, f64::from(k / 14) * 0.1 - 0.7);
            let normal = Direction::new(DVec3::new(-2.0 * x, 2.0 * y, 1.0)).unwrap();
            ContactSample { point: DVec3::new(x, y, x * x - y * y), normal }
        });
        assert_eq!(EllipsoidFit::new(&saddle.collect::<Vec<_>>()), Err(EllipsoidFitError::NotEllipsoid));
        let truth = EllipsoidFit {
            centre: DVec3::ZERO,
            semi_axes: DVec3::new(1.0, 1.5, 2.0),
            orientation: DQuat::IDENTITY,
            misfit: 0.0,
        };
        let mut rounded = contacts(&truth, 1.0);
        // A ball of radius 0.5 added to the ellipsoid makes no ellipsoid.
        rounded.iter_mut().for_each(|c| c.point += 0.5 * c.normal.get());
        let misfit = EllipsoidFit::new(&rounded).unwrap().misfit;
        assert!(misfit > 1e-3, "{misfit}");
    }
}
