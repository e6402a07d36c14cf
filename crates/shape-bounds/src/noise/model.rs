use super::pose::PoseNoise;
use crate::sample::ContactSample;
use glam::{DMat3, DVec3};
use thiserror::Error;

/// How uncertain one measured contact is: normal noise, standard deviations.
///
/// `point` and `normal` are independent from contact to contact. The pose's part may be correlated along a curve in any
/// way, as the errors of an observer are, so nothing is gained on it by averaging.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNoise {
    /// Covariance of the contact point in the body's frame, in m^2.
    pub point: DMat3,
    /// Standard deviation of the normal about each tangent axis, in rad.
    pub normal: f64,
    /// Of the body's pose when the contact was made.
    pub pose: PoseNoise,
}

impl ContactNoise {
    /// The same standard deviation of the point along all axes (m) and of the normal (rad), and an exact pose.
    #[must_use]
    pub fn isotropic(point: f64, normal: f64) -> Self {
        Self { point: DMat3::from_diagonal(DVec3::splat(point * point)), normal, pose: PoseNoise::NONE }
    }

    /// The first entry that is not a standard deviation or covariance.
    pub(super) fn defect(&self) -> Option<(&'static str, f64)> {
        if !(self.normal.is_finite() && self.normal >= 0.0) {
            return Some(("normal", self.normal));
        }
        if let Some(defect) = self.pose.defect() {
            return Some(defect);
        }
        for column in 0..3 {
            for row in 0..3 {
                let value = self.point.col(column)[row];
                let limit = (self.point.col(column)[column] * self.point.col(row)[row]).sqrt();
                // A covariance is bounded by its variances (NaN fails every comparison).
                if !(value.is_finite() && value.abs() <= limit * (1.0 + 1e-9)) {
                    return Some(("point", value));
                }
            }
        }
        None
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
    /// Odds that are none.
    #[error("odds of {0} to 1: they must be above 1 and finite")]
    Odds(f64),
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
    #[error("curve {curve}, contact {index}: point ({}, {}, {}) has a coordinate that is not finite", point.x, point.y, point.z)]
    NotFinite {
        /// Which curve.
        curve: usize,
        /// Which contact of it.
        index: usize,
        /// The point as given.
        point: DVec3,
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
        "nothing finite certainly contains the body: normals are too uncertain, or leave some directions open"
    )]
    NoUpperBound,
    /// Limits on the radii of curvature that are none, or that contacts contradict by more than their noise.
    #[error(transparent)]
    Curvature(#[from] crate::curvature::CurvatureError),
    /// The measured contacts have no bounds whatever the noise.
    #[error(transparent)]
    Bounds(#[from] crate::bounds::BoundsError),
}

impl NoiseError {
    pub(super) fn check_confidence(confidence: f64) -> Result<(), Self> {
        if confidence > 0.5 && confidence < 1.0 { Ok(()) } else { Err(Self::Confidence(confidence)) }
    }

    /// Refuses noise levels that are none and points that are not finite.
    pub(crate) fn check_contacts(curves: &[Vec<NoisyContact>]) -> Result<(), Self> {
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
