use super::Model;
use crate::matrix::outer;
use contact_kinematics::{CurvatureRadii, Direction, ShapeError, SupportFunction, SupportJet};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{DVector, Matrix3};

/// An ellipsoid with any centre and any axes: `h(n) = c . n + sqrt(n' A n)`, the general bounded quadric.
///
/// `A` is the inverse of the matrix of the quadric `(y - c)' A^-1 (y - c) = 1`; its eigenvalues are the squares of the
/// semi-axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkewEllipsoid {
    centre: DVec3,
    matrix: DMat3,
    semi_axes: DVec3,
    rotation: DQuat,
}

impl SkewEllipsoid {
    /// From the centre (m) and the symmetric matrix `A` (m^2), whose upper triangle is taken.
    ///
    /// # Errors
    /// [`ShapeError::Length`] unless all semi-axes are positive and finite.
    pub fn new(centre: DVec3, matrix: DMat3) -> Result<Self, ShapeError> {
        let bad = |what, value| Err(ShapeError::Length { what, value });
        if !centre.is_finite() {
            return bad("centre", centre.length());
        }
        if !matrix.is_finite() {
            return bad("semi-axis", f64::NAN);
        }
        let (x, y, z) = (matrix.x_axis, matrix.y_axis, matrix.z_axis);
        let symmetric = Matrix3::new(x.x, y.x, z.x, y.x, y.y, z.y, z.x, z.y, z.z);
        let eigen = symmetric.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
        let squares = order.map(|i| eigen.eigenvalues[i]);
        // Below this share of the largest, an eigenvalue is rounding.
        if squares[2] <= 1e-14 * squares[0] || !squares[0].is_finite() {
            return bad("smallest semi-axis squared", squares[2]);
        }
        let axis = |i: usize| {
            let column = eigen.eigenvectors.column(order[i]);
            DVec3::new(column[0], column[1], column[2])
        };
        let frame = DMat3::from_cols(axis(0), axis(1), axis(0).cross(axis(1)));
        Ok(Self {
            centre,
            matrix: DMat3::from_cols(
                DVec3::new(x.x, y.x, z.x),
                DVec3::new(y.x, y.y, z.y),
                DVec3::new(z.x, z.y, z.z),
            ),
            semi_axes: DVec3::from_array(squares.map(f64::sqrt)),
            rotation: DQuat::from_mat3(&frame),
        })
    }

    /// Centre in m.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Semi-axes in m, descending.
    #[must_use]
    pub fn semi_axes(&self) -> DVec3 {
        self.semi_axes
    }

    /// Turns the X, Y and Z axis onto the first, second and third semi-axis.
    #[must_use]
    pub fn rotation(&self) -> DQuat {
        self.rotation
    }

    /// Volume in m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * self.semi_axes.element_product()
    }
}

impl SupportFunction for SkewEllipsoid {
    fn jet(&self, n: Direction) -> SupportJet {
        let scaled = self.matrix * n.get();
        // At least the square of the smallest semi-axis, which the constructor keeps above zero.
        let value = scaled.dot(n.get()).sqrt();
        let own = scaled / value;
        SupportJet {
            value: value + self.centre.dot(n.get()),
            point: own + self.centre,
            hessian: (self.matrix - outer(own, own)) * (1.0 / value),
        }
    }

    /// Exact: `c^2 / a` at the end of the longest axis, `a^2 / c` at the end of the shortest.
    fn curvature_radii(&self) -> CurvatureRadii {
        let (long, short) = (self.semi_axes.x, self.semi_axes.z);
        CurvatureRadii { min: short * short / long, max: long * long / short }
    }
}

/// Centre and the lower triangle `L` of `A = L L'`, row by row: lengths all, and positive definite by construction.
pub(in crate::fit) struct EllipsoidModel;

/// Row and column of each entry of `L`.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];

impl EllipsoidModel {
    pub(in crate::fit) fn body(theta: &DVector<f64>) -> Result<SkewEllipsoid, ShapeError> {
        let l = triangle(theta);
        SkewEllipsoid::new(DVec3::new(theta[0], theta[1], theta[2]), l * l.transpose())
    }

    /// `A` has two triangles for each sign of a diagonal entry; the one with positive entries is kept.
    pub(in crate::fit) fn with_positive_diagonal(theta: &DVector<f64>) -> DVector<f64> {
        let diagonal = [theta[3], theta[5], theta[8]];
        let mut own = theta.clone();
        for (k, (_, column)) in ENTRIES.iter().enumerate() {
            own[3 + k] *= diagonal[*column].signum();
        }
        own
    }
}

fn triangle(theta: &DVector<f64>) -> DMat3 {
    let mut l = DMat3::ZERO;
    for (k, (row, column)) in ENTRIES.iter().enumerate() {
        l.col_mut(*column)[*row] = theta[3 + k];
    }
    l
}

impl Model for EllipsoidModel {
    fn count(&self) -> usize {
        9
    }

    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn SupportFunction>> {
        Some(Box::new(Self::body(theta).ok()?))
    }

    fn columns(&self, theta: &DVector<f64>, n: Direction, columns: &mut [DVec3]) -> Option<()> {
        let l = triangle(theta);
        let n = n.get();
        let inner = l.transpose() * n;
        let value = inner.length();
        let size = l.x_axis.length() + l.y_axis.length() + l.z_axis.length();
        // Flat in this direction: the point is not defined.
        if value.is_nan() || value <= 1e-9 * size {
            return None;
        }
        columns[..3].copy_from_slice(&DVec3::AXES);
        // x = L w / |w|, w = L'n; dL = e_row e_col', dw = n_row e_col.
        let unit = inner / value;
        for (k, (row, column)) in ENTRIES.iter().enumerate() {
            let turned = l.col(*column) * n[*row] - l * unit * (n[*row] * unit[*column]);
            columns[3 + k] = DVec3::AXES[*row] * unit[*column] + turned / value;
        }
        Some(())
    }

    fn name(&self, parameter: usize) -> String {
        match parameter {
            0..3 => ["centre x", "centre y", "centre z"][parameter].to_owned(),
            _ => {
                let (row, column) = ENTRIES[parameter - 3];
                format!("axes {}{}", ["x", "y", "z"][row], ["x", "y", "z"][column])
            }
        }
    }

    fn ball(&self, centre: DVec3, radius: f64) -> DVector<f64> {
        DVector::from_column_slice(&[centre.x, centre.y, centre.z, radius, 0.0, radius, 0.0, 0.0, radius])
    }
}
