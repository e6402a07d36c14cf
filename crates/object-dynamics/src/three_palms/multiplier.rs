//! The same motion in maximal coordinates with the contact forces as multipliers: the paper's (30) to (34).
//!
//! Kept as the simple oracle of the minimal form, and for the charts: it solves a 9 x 9 system where the minimal form
//! solves a 3 x 3 one, and its integrated positions drift off the palms.

use super::{Accelerations, ThreePalmScene};
use crate::BodyState;
use contact_kinematics::{PalmError, SupportFunction, body_normal, body_normal_rate};
use glam::{DMat3, DVec3};
use nalgebra::{SMatrix, SVector};

/// Solution of the multiplier form, with the departures of the state from its constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MultiplierSolution {
    /// Accelerations and forces.
    pub accelerations: Accelerations,
    /// Distance of each contact point from its palm, m.
    pub gaps: [f64; 3],
    /// Rate of each gap at the material contact points, m/s.
    pub gap_rates: [f64; 3],
}

impl<S: SupportFunction> ThreePalmScene<S> {
    /// Accelerations and forces by Newton's and Euler's equations with three unilateral contacts taken as bilateral
    /// (paper, (30) to (34), and the acceleration constraint (24) as the closing equations).
    ///
    /// None when the 9 x 9 system is singular, which it is only where the palms are parallel.
    ///
    /// # Errors
    /// [`PalmError::Parallel`].
    pub fn multiplier_form(
        &self,
        t: f64,
        state: &BodyState,
    ) -> Result<Option<MultiplierSolution>, PalmError> {
        let (palms, _) = self.palms_at(t)?;
        let R = DMat3::from_quat(state.R_WO);
        let inertia = R * self.mass().inertia() * R.transpose();
        let (w, v) = (state.w_WO, state.v_WCm);
        let mut matrix = SMatrix::<f64, 9, 9>::zeros();
        let mut rhs = SVector::<f64, 9>::zeros();
        let gyration = -w.cross(inertia * w);
        for row in 0..3 {
            matrix[(row, row)] = self.mass().mass();
            rhs[row] = self.mass().mass() * self.gravity()[row];
            rhs[3 + row] = gyration[row];
            for column in 0..3 {
                matrix[(3 + row, 3 + column)] = inertia.col(column)[row];
            }
        }
        let (mut gaps, mut gap_rates) = ([0.0; 3], [0.0; 3]);
        for (i, palm) in palms.iter().enumerate() {
            let (n, w_P) = (palm.frame.n, palm.omega());
            let jet = self.body().jet(body_normal(R, n));
            let b = R * jet.point;
            let c = state.p_WCm + b;
            let b_dot = w.cross(b) + R * (jet.hessian * body_normal_rate(R, palm, w));
            let slip = v + w.cross(b) - w_P.cross(c);
            let surface = palm.alpha().cross(c) + w_P.cross(v + b_dot);
            let moment = b.cross(n);
            for axis in 0..3 {
                matrix[(axis, 6 + i)] = -n[axis];
                matrix[(3 + axis, 6 + i)] = -moment[axis];
                matrix[(6 + i, axis)] = n[axis];
                matrix[(6 + i, 3 + axis)] = moment[axis];
            }
            rhs[6 + i] = -(n.dot(w.cross(b_dot) - surface) + w_P.cross(n).dot(slip));
            gaps[i] = n.dot(c);
            gap_rates[i] = n.dot(slip);
        }
        let solution = matrix.lu().solve(&rhs).filter(|x| x.iter().all(|v| v.is_finite()));
        Ok(solution.map(|x| {
            let vector = |k: usize| DVec3::new(x[k], x[k + 1], x[k + 2]);
            let accelerations =
                Accelerations { a_WCm: vector(0), alpha_WO: vector(3), forces: vector(6).to_array() };
            MultiplierSolution { accelerations, gaps, gap_rates }
        }))
    }
}
