//! States that hold an orientation, and the mean of several.
//!
//! An orientation is stored as a rotation vector `r`, `R = Exp(r)`; a step `xi` turns it about the body's axes, `R Exp(xi)`.
//! A [`Model`](crate::Model) with such states calls these functions in its own `retract`, `difference` and
//! `difference_slope`, on the three entries in question.

use super::error::BankError;
use super::gaussian::{Branch, Gaussian};
use super::merge::{Space, merge};
use super::system::check_sum;
use nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3};

/// Angle (rad) below which a series takes the place of a difference of large numbers.
const SERIES: f64 = 0.1;

/// Rotation vector of `Exp(rotation) Exp(step)`.
#[must_use]
pub fn rotation_retract(rotation: &Vector3<f64>, step: &Vector3<f64>) -> Vector3<f64> {
    (UnitQuaternion::from_scaled_axis(*rotation) * UnitQuaternion::from_scaled_axis(*step)).scaled_axis()
}

/// The step that leads from `from` to `to`: `Log(Exp(from)' Exp(to))`, no longer than half a turn.
#[must_use]
pub fn rotation_difference(to: &Vector3<f64>, from: &Vector3<f64>) -> Vector3<f64> {
    (UnitQuaternion::from_scaled_axis(*from).inverse() * UnitQuaternion::from_scaled_axis(*to)).scaled_axis()
}

/// Inverse of the right Jacobian at `difference` (rad): `Log(Exp(d) Exp(xi)) = d + slope xi` to first order.
/// `1 + [d]x / 2 + c [d]x^2` with `c = 1 / a^2 - cot(a / 2) / (2 a)`, `a = |d|`; J. Sola, J. Deray, D. Atchuthan, A micro Lie
/// theory for state estimation in robotics (2018), eq. 144.
#[must_use]
pub fn rotation_slope(difference: &Vector3<f64>) -> Matrix3<f64> {
    let (a, cross) = (difference.norm(), difference.cross_matrix());
    let squared = a * a;
    let c = if a < SERIES {
        1.0 / 12.0 + squared * (1.0 / 720.0 + squared * (1.0 / 30_240.0 + squared / 1_209_600.0))
    } else {
        1.0 / squared - 0.5 / (a * (0.5 * a).tan())
    };
    Matrix3::identity() + cross * 0.5 + cross * cross * c
}

struct Rotations;

impl Space<3> for Rotations {
    fn retract(&self, at: &SVector<f64, 3>, step: &SVector<f64, 3>) -> SVector<f64, 3> {
        rotation_retract(at, step)
    }
    fn difference(&self, to: &SVector<f64, 3>, from: &SVector<f64, 3>) -> SVector<f64, 3> {
        rotation_difference(to, from)
    }
    fn slope(&self, to: &SVector<f64, 3>, from: &SVector<f64, 3>) -> SMatrix<f64, 3, 3> {
        rotation_slope(&rotation_difference(to, from))
    }
}

/// Mean rotation and covariance (rad^2, turns about the body's axes) of several orientations with weights that sum to one,
/// each a rotation vector with such a covariance.
///
/// Quaternions are never averaged, whose sign is arbitrary. Within half a radian of each other the covariance is good to
/// about a percent; orientations much more than a radian apart should not be merged at all.
///
/// # Errors
/// [`BankError::Sum`] for weights that do not sum to one, as none do; [`BankError::Value`] for one that is negative or not
/// finite; [`BankError::NotFinite`] for rotations or covariances that are not.
pub fn match_rotations(
    weighted: &[(f64, Vector3<f64>, Matrix3<f64>)],
) -> Result<(Vector3<f64>, Matrix3<f64>), BankError> {
    check_sum("weights of the rotations", weighted.iter().map(|(weight, ..)| *weight))?;
    let branches: Vec<Branch> = weighted
        .iter()
        .map(|(weight, rotation, covariance)| Branch {
            weight: *weight,
            gaussian: Gaussian::new(rotation, covariance),
        })
        .collect();
    if let Some(mode) = branches.iter().position(|b| !b.gaussian.is_finite()) {
        return Err(BankError::NotFinite { what: "rotation", mode, sample: 0 });
    }
    let mut matched = Gaussian::zeros(3);
    merge(&Rotations, &branches, &mut matched);
    Ok(matched.read())
}
