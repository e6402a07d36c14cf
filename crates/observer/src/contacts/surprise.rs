//! How probable a motion is together with all those near it: by that, and not by what its own point leaves, motions far from each other compare.
//!
//! A contact that is read beside where it is leaves its condition off by as much as the body spins, so that motions of faster bodies leave less of any log. What
//! conditions and links may be off by differs from one motion to another, and so does how much room there is about it: the logarithms of their determinants
//! belong to the probability (Laplace's approximation).

use super::body::CONSTANTS;
use super::problem::Problem;
use super::solve::{Covariances, Solved};
use super::state::Motion;
use nalgebra::SMatrix;

/// Twice the negative logarithm of it, but for what all motions of a problem in space have alike; in the plane what is left alone. Infinite where nothing
/// bounds the motion.
pub(super) fn surprise(problem: &mut Problem, solved: &Solved<CONSTANTS>) -> f64 {
    if problem.planar {
        return solved.equations.cost;
    }
    // What is held of the body is so for the search alone.
    let equations = problem.unfrozen(&solved.equations, &solved.unknowns).into_owned();
    let free = Solved { equations, unknowns: solved.unknowns.clone(), ..*solved };
    let frozen = std::mem::take(&mut problem.frozen);
    let all = of_all_near(problem, &free).map(|all| all + solved.equations.cost);
    problem.frozen = frozen;
    all.filter(|all| all.is_finite()).unwrap_or(f64::INFINITY)
}

/// What a motion of which nothing is held adds to what it leaves.
fn of_all_near(problem: &Problem, free: &Solved<CONSTANTS>) -> Option<f64> {
    let room = free.covariances(problem)?.log_information()?;
    let unit = problem.natural_information().map(|information| information.sqrt().recip());
    let scale = unit * unit.transpose();
    // A link that leaves something free does so in every motion.
    let links = free.equations.links.iter();
    let links = links.filter_map(|link| log_det(link.information.component_mul(&scale))).sum::<f64>();
    let of_conditions = |(motion, &k): (&Motion, &usize)| {
        let turn = free.unknowns.body.turn(motion.q, motion.L);
        let conditions = problem.conditions(k, motion, &turn);
        conditions.map(|(_, rows)| rows.log_information(problem.units.speed)).sum::<f64>()
    };
    let conditions = free.unknowns.motions.iter().zip(&problem.nodes).map(of_conditions).sum::<f64>();
    Some(room - links - conditions)
}

impl Covariances<CONSTANTS> {
    /// Logarithm of the determinant of the information of all unknowns.
    fn log_information(&self) -> Option<f64> {
        Some(self.chain.log_det() - log_det(self.body)?)
    }
}

/// None of a matrix that is not positive.
fn log_det<const N: usize>(of: SMatrix<f64, N, N>) -> Option<f64> {
    let factor = nalgebra::DMatrix::from_column_slice(N, N, of.as_slice()).cholesky()?;
    Some(2.0 * factor.l_dirty().diagonal().map(f64::ln).sum())
}
