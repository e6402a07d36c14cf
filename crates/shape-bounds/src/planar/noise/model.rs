//! How uncertain contacts in the plane are.

use crate::planar::{BoundsError, ContactSample};
use glam::DMat2;
use thiserror::Error;

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
    pub(in crate::planar) fn defect(&self) -> Option<(&'static str, f64)> {
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

/// Why noisy contacts give no bounds.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NoiseError {
    /// A confidence that is none.
    #[error("confidence {0}: it must lie between 0.5 and 1, both excluded")]
    Confidence(f64),
    /// A noise level that is negative, not finite or not a covariance.
    #[error("curve {curve}, contact {index}: noise `{name}` has the entry {value}, which is not possible")]
    Noise {
        /// Which curve.
        curve: usize,
        /// Which contact of it.
        index: usize,
        /// Which field.
        name: &'static str,
        /// The entry.
        value: f64,
    },
    /// The noise leaves nothing that is certainly in the body.
    #[error("nothing is certainly inside of the body: the noise is as large as the hull of the contacts")]
    NoLowerBound,
    /// With normals as uncertain as stated, no finite region certainly contains the body.
    #[error(
        "nothing finite certainly contains the body: normals are too uncertain, or leave some directions open \
         (tried regions up to {reach} m)"
    )]
    NoUpperBound {
        /// Radius of the largest region tried.
        reach: f64,
    },
    /// The measured contacts have no bounds whatever the noise.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
}
