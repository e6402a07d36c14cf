//! An ellipsoid in general position as a support function, and its free numbers.

use contact_kinematics::{CurvatureRadii, Direction, SupportFunction, SupportJet};
use glam::{DMat3, DQuat, DVec3};

/// Free numbers of the shape: six of the matrix, three of the centre.
pub(super) const SHAPE_NUMBERS: usize = 9;

/// `h(n) = sqrt(n' D n) + c . n` with `D` positive definite, `D = C C'`.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeEllipsoid {
    factor: DMat3,
    matrix: DMat3,
    centre: DVec3,
}

impl FreeEllipsoid {
    /// From the logarithms of the diagonal of `C`, its entries below, and the centre: any numbers are an ellipsoid.
    pub(super) fn new(numbers: &[f64; SHAPE_NUMBERS]) -> Self {
        let [a, b, c, d, e, f, x, y, z] = *numbers;
        let factor = DMat3::from_cols(
            DVec3::new(a.exp(), d, e),
            DVec3::new(0.0, b.exp(), f),
            DVec3::new(0.0, 0.0, c.exp()),
        );
        Self { factor, matrix: factor * factor.transpose(), centre: DVec3::new(x, y, z) }
    }

    /// The numbers of an ellipsoid with the given semi-axes (m), turned, about the centre of mass.
    pub(super) fn numbers(semi_axes: DVec3, turn: DQuat) -> [f64; SHAPE_NUMBERS] {
        let axes = DMat3::from_quat(turn);
        let d = axes * DMat3::from_diagonal(semi_axes * semi_axes) * axes.transpose();
        // Positive pivots: the semi-axes are above zero.
        let c00 = d.x_axis.x.sqrt();
        let (c10, c20) = (d.x_axis.y / c00, d.x_axis.z / c00);
        let c11 = (d.y_axis.y - c10 * c10).sqrt();
        let c21 = (d.y_axis.z - c20 * c10) / c11;
        let c22 = (d.z_axis.z - c20 * c20 - c21 * c21).sqrt();
        [c00.ln(), c11.ln(), c22.ln(), c10, c20, c21, 0.0, 0.0, 0.0]
    }

    pub(super) fn matrix(&self) -> DMat3 {
        self.matrix
    }

    pub(super) fn centre(&self) -> DVec3 {
        self.centre
    }
}

impl SupportFunction for FreeEllipsoid {
    fn jet(&self, n: Direction) -> SupportJet {
        let across = self.matrix * n.get();
        // Above zero: the factor's diagonal is a exponential.
        let root = (self.factor.transpose() * n.get()).length();
        let point = across / root;
        let outer = DMat3::from_cols(point * point.x, point * point.y, point * point.z);
        SupportJet {
            value: root + self.centre.dot(n.get()),
            point: point + self.centre,
            hessian: (self.matrix - outer) * (1.0 / root),
        }
    }

    /// Bounds by the norms of the factor and its inverse.
    fn curvature_radii(&self) -> CurvatureRadii {
        let norm = |m: DMat3| m.to_cols_array().iter().map(|v| v * v).sum::<f64>().sqrt();
        let (long, short) = (norm(self.factor), 1.0 / norm(self.factor.inverse()));
        CurvatureRadii { min: short * short / long, max: long * long / short }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact_kinematics::{Ellipsoid, Translated};

    #[test]
    fn it_is_a_turned_and_translated_ellipsoid() {
        let (axes, offset) = (DVec3::new(1.0, 2.0, 2.5), DVec3::new(0.1, -0.2, 0.3));
        let turn = DQuat::from_scaled_axis(DVec3::new(0.4, -0.9, 0.7));
        let mut numbers = FreeEllipsoid::numbers(axes, turn);
        numbers[6..].copy_from_slice(&(turn * offset).to_array());
        let (free, own) =
            (FreeEllipsoid::new(&numbers), Translated { body: Ellipsoid::new(axes).unwrap(), offset });
        for k in 0..20 {
            let n = DVec3::new(f64::from(k).sin(), (1.3 * f64::from(k)).cos(), 0.1 * f64::from(k) - 1.0);
            let n = Direction::new(n).unwrap();
            let jet = free.jet(n);
            let other = own.jet(Direction::new(turn.inverse() * n.get()).unwrap());
            let R = DMat3::from_quat(turn);
            assert!((jet.value - other.value).abs() < 1e-13);
            assert!((jet.point - turn * other.point).length() < 1e-13);
            let hessian = R * other.hessian * R.transpose() - jet.hessian;
            assert!(hessian.to_cols_array().iter().all(|v| v.abs() < 1e-12));
            let radii = free.curvature_radii();
            assert!(radii.min <= 0.4 && radii.max >= 6.25);
        }
    }
}
