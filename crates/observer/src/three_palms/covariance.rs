//! Covariance of the estimate: white sensor noise carried through the linearised estimator.
//!
//! The estimate minimises the contact residuals; noise reaches them directly, through the contact coordinates, and
//! with a memory, through the impulses and moments that the forces are integrated to. Both are carried to the
//! unknowns by the adjoint of the linearised motion.

use super::momentum::{MomentumProblem, Row, StateRow, UNKNOWNS};
use nalgebra::{SMatrix, SVector};

type Square = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// Standard deviations of white sensor noise, per sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLevel {
    /// Of each contact coordinate, m.
    pub contact: f64,
    /// Of each contact force, N.
    pub force: f64,
}

/// What the linearised motion says at one sample.
pub(super) struct Linearised {
    /// Derivatives of the residuals by the scaled unknowns.
    pub(super) rows: [Row; 3],
    /// Derivatives of the residuals by position, velocity, angular momentum and orientation at the sample.
    pub(super) by_state: [StateRow; 3],
    /// Derivatives of the residuals by the contact coordinates `(s1, s2)`.
    pub(super) by_contact: [[f64; 2]; 3],
    /// What a unit of force for a unit of time does to the state.
    pub(super) by_force: [SVector<f64, UNKNOWNS>; 3],
    /// What a unit of contact coordinate for a unit of time does to the state, through the torque.
    pub(super) through_torque: [[SVector<f64, UNKNOWNS>; 2]; 3],
    /// Rate of the state's deviation.
    pub(super) flow: Square,
    /// Time to the next sample, s.
    pub(super) step: f64,
}

/// Covariance of the scaled unknowns, and the variance of a residual that noise alone leaves.
pub(super) struct Propagated {
    pub(super) covariance: Square,
    pub(super) residual_variance: f64,
}

/// `stride`: samples of the log for each sample of the problem's track.
pub(super) fn propagate(
    problem: &MomentumProblem<'_>,
    start: &super::StartState,
    information_inverse: &Square,
    noise: &NoiseLevel,
    stride: f64,
) -> Propagated {
    let steps = problem.linearised(start);
    let (vs, vf) = (noise.contact.powi(2), noise.force.powi(2));
    let mut adjoint = Square::zeros();
    let mut spread = Square::zeros();
    for k in (0..steps.len()).rev() {
        let here = &steps[k];
        if here.step > 0.0 {
            adjoint = adjoint + adjoint * here.flow * here.step;
        }
        for i in 0..3 {
            // In units of the log's samples: `stride` of them act alike.
            adjoint += here.rows[i] * here.by_state[i].transpose() * stride;
        }
        // Each of the `stride` samples holds its reading for step / stride seconds.
        let hold = here.step / stride;
        for i in 0..3 {
            let kick: Row = adjoint * here.by_force[i] * hold;
            spread.ger(vf * stride, &kick, &kick, 1.0);
            for axis in 0..2 {
                let kick: Row =
                    here.rows[i] * here.by_contact[i][axis] + adjoint * here.through_torque[i][axis] * hold;
                spread.ger(vs * stride, &kick, &kick, 1.0);
            }
        }
    }
    let covariance = information_inverse * spread * information_inverse;
    Propagated { covariance, residual_variance: residual_variance(&steps, noise, stride) }
}

/// Mean variance of the residuals at the true unknowns.
pub(super) fn residual_variance(steps: &[Linearised], noise: &NoiseLevel, stride: f64) -> f64 {
    let (vs, vf) = (noise.contact.powi(2), noise.force.powi(2));
    let mut state = Square::zeros();
    let mut sum = 0.0;
    for here in steps {
        for i in 0..3 {
            let [s1, s2] = here.by_contact[i];
            sum += here.by_state[i].dot(&(state * here.by_state[i])) + vs * (s1 * s1 + s2 * s2);
        }
        let transition = Square::identity() + here.flow * here.step;
        state = transition * state * transition.transpose();
        let hold = here.step * here.step / stride;
        for i in 0..3 {
            state.ger(vf * hold, &here.by_force[i], &here.by_force[i], 1.0);
            for column in &here.through_torque[i] {
                state.ger(vs * hold, column, column, 1.0);
            }
        }
    }
    sum / (3 * steps.len().max(1)) as f64
}
