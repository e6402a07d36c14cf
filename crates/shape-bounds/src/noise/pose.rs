//! Errors of the pose in which a contact was made.

use glam::{DMat3, DVec3};

/// How uncertain a pose is: covariance of a small rigid displacement of the body's axes, which takes a point `x` to
/// `x + theta x x + d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseNoise {
    /// Covariance of the turn `theta` about the body's origin, in rad^2.
    pub rotation: DMat3,
    /// Covariance of the shift `d`, in m^2.
    pub translation: DMat3,
    /// Covariance `E[theta d']` of both, in rad m.
    pub cross: DMat3,
}

impl PoseNoise {
    /// An exact pose.
    pub const NONE: Self = Self { rotation: DMat3::ZERO, translation: DMat3::ZERO, cross: DMat3::ZERO };

    /// The same standard deviation of the shift along all axes (m), and of the turn about all of them (rad).
    #[must_use]
    pub fn isotropic(translation: f64, rotation: f64) -> Self {
        let square = |deviation: f64| DMat3::from_diagonal(DVec3::splat(deviation * deviation));
        Self { rotation: square(rotation), translation: square(translation), cross: DMat3::ZERO }
    }

    /// Whether it is none.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }

    /// The first block that cannot be part of a covariance, with an entry of it.
    pub(super) fn defect(&self) -> Option<(&'static str, f64)> {
        let variances = |m: &DMat3| DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
        let (turns, shifts) = (variances(&self.rotation), variances(&self.translation));
        let blocks = [
            ("pose.rotation", &self.rotation, turns, turns),
            ("pose.translation", &self.translation, shifts, shifts),
            ("pose.cross", &self.cross, turns, shifts),
        ];
        blocks.into_iter().find_map(|(name, block, rows, columns)| {
            let entries = (0..9).map(|k| (block.col(k / 3)[k % 3], rows[k % 3] * columns[k / 3]));
            // NaN fails every comparison.
            let fine = |v: f64, square: f64| v.is_finite() && v * v <= square * (1.0 + 1e-9);
            let own = |k: usize| rows[k] >= 0.0 && columns[k] >= 0.0;
            let wrong = entries.into_iter().find(|(v, square)| !fine(*v, *square)).map(|(v, _)| v);
            wrong.or_else(|| (0..3).find(|k| !own(*k)).map(|k| rows[k].min(columns[k]))).map(|v| (name, v))
        })
    }

    /// Covariance of the displacement of `x`.
    pub(crate) fn at(&self, x: DVec3) -> DMat3 {
        let arm = cross_matrix(x);
        let cross = arm * self.cross;
        arm * self.rotation * arm.transpose() - cross - cross.transpose() + self.translation
    }

    /// The displacement of points along `n`.
    pub(super) fn along(&self, n: DVec3) -> PlaneNoise {
        let arm = cross_matrix(n);
        PlaneNoise {
            square: arm.transpose() * self.rotation * arm,
            linear: -(arm.transpose() * (self.cross * n)),
            constant: n.dot(self.translation * n),
        }
    }

    /// The largest variance of a turn about any axis, or somewhat more.
    pub(super) fn turning(&self) -> f64 {
        bound(self.rotation)
    }
}

/// Variance of the displacement along a normal of a plane, as a quadratic function of the place.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneNoise {
    square: DMat3,
    linear: DVec3,
    constant: f64,
}

impl PlaneNoise {
    /// The mean of some. The deviation of a mean is at most the root of the mean variance.
    pub(super) fn mean(all: impl Iterator<Item = Self>, weight: f64) -> Self {
        let zero = Self { square: DMat3::ZERO, linear: DVec3::ZERO, constant: 0.0 };
        all.fold(zero, |sum, one| Self {
            square: sum.square + one.square * weight,
            linear: sum.linear + one.linear * weight,
            constant: sum.constant + one.constant * weight,
        })
    }

    /// No less than the deviation at any place within `reach` of `x`: a deviation is a seminorm of (place, 1).
    pub(super) fn deviation(&self, x: DVec3, reach: f64) -> f64 {
        let here = x.dot(self.square * x) + 2.0 * self.linear.dot(x) + self.constant;
        here.max(0.0).sqrt() + bound(self.square).sqrt() * reach
    }
}

/// No less than the largest eigenvalue: the largest sum of absolute values in a row.
pub(super) fn bound(m: DMat3) -> f64 {
    [m.x_axis, m.y_axis, m.z_axis].map(|row| row.abs().element_sum()).into_iter().fold(0.0, f64::max)
}

/// `[v]x`.
fn cross_matrix(v: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, v.z, -v.y), DVec3::new(-v.z, 0.0, v.x), DVec3::new(v.y, -v.x, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variances_are_those_of_the_displacement() {
        let (theta, d) = (DVec3::new(0.3, -0.2, 0.5), DVec3::new(-0.1, 0.4, 0.2));
        let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
        let pose =
            PoseNoise { rotation: outer(theta, theta), translation: outer(d, d), cross: outer(theta, d) };
        assert_eq!(pose.defect(), None);
        let (x, n) = (DVec3::new(1.0, 2.0, -0.7), DVec3::new(0.6, 0.0, 0.8));
        let moved = theta.cross(x) + d;
        let u = DVec3::new(0.2, -0.9, 0.4);
        assert!((u.dot(pose.at(x) * u) - u.dot(moved).powi(2)).abs() < 1e-14);
        assert!((pose.along(n).deviation(x, 0.0) - n.dot(moved).abs()).abs() < 1e-14);
        // Elsewhere it is no more than what the reach adds.
        let y = x + DVec3::new(0.3, -0.4, 1.2);
        assert!(n.dot(theta.cross(y) + d).abs() <= pose.along(n).deviation(x, 1.3));
        let wrong = PoseNoise { cross: outer(theta, d * 1.1), ..pose };
        assert_eq!(wrong.defect().map(|(name, _)| name), Some("pose.cross"));
    }
}
