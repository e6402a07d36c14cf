//! How uncertain contacts in the plane are.

use crate::planar::{BoundsError, ContactSample};
use glam::{DMat2, DVec2};
use thiserror::Error;

/// How uncertain one measured contact is: normal noise, standard deviations.
///
/// `point` and `normal` are independent from contact to contact. The pose's part may be correlated along a curve in any
/// way, as the errors of an observer are, so nothing is gained on it by averaging.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNoise {
    /// Covariance of the contact point in the body's frame, in m^2.
    pub point: DMat2,
    /// Standard deviation of the normal's direction, in rad.
    pub normal: f64,
    /// Standard deviation per axis of the body pose's translation when the contact was made, in m.
    pub pose_translation: f64,
    /// Standard deviation of the body pose's rotation about the body's origin, in rad.
    pub pose_rotation: f64,
}

impl ContactNoise {
    /// The same standard deviation of the point along both axes (m), that of the normal (rad), and an exact pose.
    #[must_use]
    pub fn isotropic(point: f64, normal: f64) -> Self {
        let point = DMat2::from_diagonal(DVec2::splat(point * point));
        Self { point, normal, pose_translation: 0.0, pose_rotation: 0.0 }
    }

    /// The first entry that is not a standard deviation or covariance.
    pub(in crate::planar) fn defect(&self) -> Option<(&'static str, f64)> {
        for (name, value) in [
            ("normal", self.normal),
            ("pose_translation", self.pose_translation),
            ("pose_rotation", self.pose_rotation),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Some((name, value));
            }
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
#[non_exhaustive]
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
    /// A contact point with a coordinate that is not finite.
    #[error("curve {curve}, contact {index}: point ({}, {}) has a coordinate that is not finite", point.x, point.y)]
    NotFinite {
        /// Which curve.
        curve: usize,
        /// Which contact of it.
        index: usize,
        /// The point as given.
        point: DVec2,
    },
    /// A curve too short to tell its noise.
    #[error(
        "curve {curve} has {found} contacts; its noise takes {needed} to be judged: state the noise instead"
    )]
    TooFewToJudge {
        /// Which curve.
        curve: usize,
        /// Contacts in it.
        found: usize,
        /// Contacts needed.
        needed: usize,
    },
    /// Contacts contradict each other so much that right ones cannot be told from wrong ones.
    #[error(
        "at least {outliers} of {contacts} contacts contradict the others by more than their noise explains: the noise \
         is stated too small, or normals do not point outwards"
    )]
    Undecided {
        /// Contacts that would have to go.
        outliers: usize,
        /// Contacts in all.
        contacts: usize,
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

impl NoiseError {
    pub(super) fn check_confidence(confidence: f64) -> Result<(), Self> {
        if confidence > 0.5 && confidence < 1.0 { Ok(()) } else { Err(Self::Confidence(confidence)) }
    }

    /// Refuses noise levels that are none and points that are not finite.
    pub(super) fn check_contacts(curves: &[Vec<NoisyContact>]) -> Result<(), Self> {
        for (curve, contacts) in curves.iter().enumerate() {
            for (index, NoisyContact { contact, noise }) in contacts.iter().enumerate() {
                if let Some((name, value)) = noise.defect() {
                    return Err(Self::Noise { curve, index, name, value });
                }
                if !contact.point.is_finite() {
                    return Err(Self::NotFinite { curve, index, point: contact.point });
                }
            }
        }
        Ok(())
    }
}
