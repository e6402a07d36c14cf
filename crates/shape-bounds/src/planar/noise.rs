//! How uncertain contacts in the plane are.

use super::ContactSample;
use glam::DMat2;

/// How uncertain one measured contact is: normal noise, standard deviations.
///
/// `point` and `normal` are independent from contact to contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNoise {
    /// Covariance of the contact point in the body's frame, in m^2.
    pub point: DMat2,
    /// Standard deviation of the normal's direction, in rad.
    pub normal: f64,
}

impl ContactNoise {
    /// The same standard deviation of the point along both axes (m), and that of the normal (rad).
    #[must_use]
    pub fn isotropic(point: f64, normal: f64) -> Self {
        Self { point: DMat2::from_diagonal(glam::DVec2::splat(point * point)), normal }
    }

    /// The first entry that is not a standard deviation or covariance.
    pub(super) fn defect(&self) -> Option<(&'static str, f64)> {
        if !(self.normal.is_finite() && self.normal >= 0.0) {
            return Some(("normal", self.normal));
        }
        let [xx, xy, yx, yy] = self.point.to_cols_array();
        let limit = (xx * yy).sqrt() * (1.0 + 1e-9);
        // NaN fails every comparison.
        let fine = xx >= 0.0 && yy >= 0.0 && limit.is_finite() && xy.abs() <= limit && yx.abs() <= limit;
        (!fine)
            .then(|| ("point", [xx, yy, xy, yx].into_iter().find(|v| v.is_nan() || *v < 0.0).unwrap_or(xy)))
    }
}

/// A measured contact with its noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoisyContact {
    /// As measured.
    pub contact: ContactSample,
    /// How far it may be from the truth.
    pub noise: ContactNoise,
}
