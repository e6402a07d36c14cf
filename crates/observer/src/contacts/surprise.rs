//! How probable a motion is together with all those near it: by that, and not by what its own point leaves, motions far from each other compare.
//!
//! A contact that is read beside where it is leaves its condition off by as much as the body spins, so that motions of faster bodies leave less of any log. What
//! conditions and links may be off by differs from one motion to another, and so does how much room there is about it: the logarithms of their determinants
//! belong to the probability (Laplace's approximation).

use super::body::CONSTANTS;
use super::elimination::Eliminated;
use super::problem::{Problem, Units};
use super::rows::Rows;
use super::solve::{Covariances, Solved, solve};
use super::state::{Motion, Tangent};
use nalgebra::SMatrix;

/// Twice the negative logarithm of it, but for what all motions of a problem in space have alike; in the plane what is left alone. Infinite where nothing
/// bounds the motion.
pub(super) fn surprise(problem: &mut Problem, solved: &Solved<CONSTANTS>) -> f64 {
    if problem.planar {
        return solved.equations.cost;
    }
    // What is held of the body is so for the search alone.
    let frozen = std::mem::take(&mut problem.frozen);
    let all = of_all_near(problem, solved);
    problem.frozen = frozen;
    all.filter(|all| all.is_finite()).unwrap_or(f64::INFINITY)
}

fn of_all_near(problem: &Problem, solved: &Solved<CONSTANTS>) -> Option<f64> {
    let free = solve::<CONSTANTS>(problem, solved.unknowns.clone(), 0, f64::INFINITY)?;
    let room = free.covariances(problem)?.log_information()?;
    let Units { length, speed, mass } = problem.units;
    let unit = Tangent::from_fn(|i, _| [length, speed, mass * length * speed, 1.0][i / 3]);
    let scale = unit * unit.transpose();
    // A link that leaves something free does so in every motion.
    let links = free.equations.links.iter();
    let links = links.filter_map(|link| log_det(link.information.component_mul(&scale))).sum::<f64>();
    let nodes = free.unknowns.motions.iter().zip(&problem.nodes);
    let conditions = nodes.map(|(motion, &k)| of_conditions(problem, &free, motion, k)).sum::<f64>();
    Some(solved.equations.cost + room - links - conditions)
}

/// Logarithm of the determinant of the information of the conditions of a sample.
fn of_conditions(problem: &Problem, free: &Solved<CONSTANTS>, motion: &Motion, k: usize) -> f64 {
    let turn = free.unknowns.body.turn(motion.q, motion.L);
    let noise = problem.noise_at(k);
    let rows = |contact| Rows::new(contact, motion, &turn, &noise, problem.friction);
    let rows = problem.record.contacts[k].iter().filter_map(rows);
    rows.map(|rows| rows.log_information(problem.units.speed)).sum()
}

impl Covariances<CONSTANTS> {
    /// Logarithm of the determinant of the information of all unknowns.
    fn log_information(&self) -> Option<f64> {
        Some(self.chain.iter().map(Eliminated::log_det).sum::<f64>() - log_det(self.body)?)
    }
}

/// None of a matrix that is not positive.
fn log_det<const N: usize>(of: SMatrix<f64, N, N>) -> Option<f64> {
    let factor = nalgebra::DMatrix::from_column_slice(N, N, of.as_slice()).cholesky()?;
    Some(2.0 * factor.l_dirty().diagonal().map(f64::ln).sum())
}

#[cfg(test)]
mod tests {
    use super::super::elimination::Eliminated;
    use super::super::state::MOTION;
    use super::*;
    use crate::random::Normal;

    /// The determinant of two nodes and a constant, eliminated one after the other, is that of the whole.
    #[test]
    fn determinants_of_a_chain_multiply() {
        const ALL: usize = 2 * MOTION + 1;
        let mut normal = Normal::seeded(5);
        let root = SMatrix::<f64, ALL, ALL>::from_fn(|_, _| normal.draw());
        let all = root * root.transpose() + SMatrix::identity();
        let own = |i: usize, j: usize| all.fixed_view::<MOTION, MOTION>(i * MOTION, j * MOTION).into_owned();
        let by = |i: usize| all.fixed_view::<MOTION, 1>(i * MOTION, 2 * MOTION).into_owned();
        let first = Eliminated::new(&own(0, 0), &own(0, 1), &by(0)).expect("positive");
        let inverse = own(0, 0).try_inverse().expect("positive");
        let left = own(1, 1) - own(1, 0) * inverse * own(0, 1);
        let cross = by(1) - own(1, 0) * inverse * by(0);
        let second = Eliminated::new(&left, &SMatrix::zeros(), &cross).expect("positive");
        let constant = all[(ALL - 1, ALL - 1)]
            - (by(0).transpose() * inverse * by(0))[(0, 0)]
            - (cross.transpose() * left.try_inverse().expect("positive") * cross)[(0, 0)];
        let chain = first.log_det() + second.log_det() + constant.ln();
        let whole = log_det(all).expect("positive");
        assert!((chain - whole).abs() < 1e-9, "{chain} {whole}");
    }
}
