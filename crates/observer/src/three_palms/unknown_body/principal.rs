//! Principal moments and axes of an inertia tensor with their covariance.

use super::estimate::IdentifiedBody;
use super::problem::{BODY_UNKNOWNS, MASS};
use crate::three_palms::equivalent_orientations;
use crate::three_palms::inertia::{inertia_slope, numbers_of_inertia};
use crate::three_palms::momentum::UNKNOWNS;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::SMatrix;
use object_dynamics::MassProperties;

/// A body in its principal axes.
pub(super) struct PrincipalFrame {
    pub(super) body: IdentifiedBody,
    /// Principal axes in the axes that the tensor was given in. Of the four choices the one nearest to those.
    pub(super) axes: DQuat,
    /// Covariance of centre of mass, velocity, angular momentum and the orientation of the principal axes.
    pub(super) covariance: SMatrix<f64, UNKNOWNS, UNKNOWNS>,
}

/// First-order perturbation of eigenvalues and eigenvectors: `dl_i = u_i' dI u_i`, and the axes turn about `u_k` by
/// `u_i' dI u_j / (l_i - l_j)`, `(i, j, k)` a cyclic order.
pub(super) fn principal_frame(
    mass: &MassProperties,
    covariance: &SMatrix<f64, BODY_UNKNOWNS, BODY_UNKNOWNS>,
) -> Option<PrincipalFrame> {
    let principal = mass.principal();
    let turns =
        equivalent_orientations(&MassProperties::from_principal(mass.mass(), principal.moments).ok()?);
    let axes =
        turns.into_iter().map(|turn| principal.axes * turn).max_by(|a, b| a.w.abs().total_cmp(&b.w.abs()))?;
    let moments = principal.moments;
    let numbers = numbers_of_inertia(mass.inertia());
    let (u, slopes): (DMat3, [DMat3; 6]) =
        (DMat3::from_quat(axes), std::array::from_fn(|k| inertia_slope(&numbers, k)));
    // Rows: three moments, then the turns about the three axes, by the six numbers.
    let by_numbers = SMatrix::<f64, 6, 6>::from_fn(|row, number| {
        let k = row % 3;
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        if row < 3 {
            u.col(k).dot(slopes[number] * u.col(k))
        } else {
            u.col(i).dot(slopes[number] * u.col(j)) / (moments[i] - moments[j])
        }
    });
    let of_numbers = covariance.fixed_view::<6, 6>(MASS + 1, MASS + 1);
    let found = by_numbers * of_numbers * by_numbers.transpose();
    let deviation = |k: usize| {
        let variance: f64 = found[(k, k)];
        if variance.is_finite() { variance.max(0.0).sqrt() } else { f64::INFINITY }
    };
    let three = |from: usize| DVec3::new(deviation(from), deviation(from + 1), deviation(from + 2));
    let mut jacobian = SMatrix::<f64, UNKNOWNS, BODY_UNKNOWNS>::zeros();
    for i in 0..MASS {
        jacobian[(i, i)] = 1.0;
    }
    for axis in 0..3 {
        for number in 0..6 {
            jacobian[(9 + axis, MASS + 1 + number)] =
                (0..3).map(|k| u.col(k)[axis] * by_numbers[(3 + k, number)]).sum();
        }
    }
    let body = IdentifiedBody {
        mass: MassProperties::from_principal(mass.mass(), moments).ok()?,
        mass_deviation: mass.mass() * covariance[(MASS, MASS)].max(0.0).sqrt(),
        moment_deviations: three(0),
        axis_deviations: three(3),
    };
    Some(PrincipalFrame { body, axes, covariance: jacobian * covariance * jacobian.transpose() })
}
