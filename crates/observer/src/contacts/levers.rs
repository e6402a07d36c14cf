//! Noise of contacts that poses as information on the motion, and errors that it may hide.
//!
//! A condition falls with the angular velocity by the lever of its contact. Where noise makes much of that lever, its square adds to the information what is
//! not there, as in regression on noisy regressors: with `M` the information along a direction as the equations have it, `N` what noise adds to it
//! on average and `C = M - N` the rest, the estimate is off by a score of variance `M` over `C`. What noise adds in one log scatters about `N`, which
//! counts against `C`: of the spin of a body of revolution about its axis conditions tell nothing, and noise alone would tell it by chance.

use super::body::{CONSTANTS, INERTIA};
use super::chain::Chain;
use super::equations::Gradient;
use super::problem::{Problem, Unknowns};
use super::record::Contact;
use super::rows::Rows;
use super::solve::{Solved, Step};
use super::state::{MOTION, Tangent};
use glam::DVec3;
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};

/// Directions that are looked for, those of which noise adds most: turns about the axes of the world and of the body come first, and so many times
/// those that the equations make of them.
const SOUGHT: usize = 6;
const ROUNDS: usize = 3;
/// Standard deviations of what noise adds by which the rest must exceed nothing, so that it is there at all.
const CHANCE: f64 = 2.0;
/// What is left of the information at least, as a share of it: a deviation is then twenty times what the equations claim.
const LEAST: f64 = 0.05;
/// Share of a direction's information, products of two taken for none, that such a direction must have of its own among those that are looked for.
const OWN: f64 = 1e-9;

pub(super) type Spin = Vector3<f64>;

/// Noise of levers at the nodes of a chain, and what turns its motions.
pub(super) struct Levers {
    /// Of each contact, its node and what it adds to the information on the angular velocity there.
    each: Vec<(usize, Matrix3<f64>)>,
    /// The same of all contacts of a node.
    at_nodes: Vec<Matrix3<f64>>,
    spins: Vec<(SMatrix<f64, 3, MOTION>, SMatrix<f64, 3, INERTIA>)>,
}

impl Levers {
    pub(super) fn new(problem: &Problem, at: &Unknowns) -> Self {
        let mut all = Vec::new();
        for (j, motion) in at.motions.iter().enumerate() {
            let turn = at.body.turn(motion.q, motion.L);
            let end = problem.nodes.get(j + 1).copied().unwrap_or(problem.nodes[j] + 1);
            for k in problem.nodes[j]..end {
                let of =
                    |(contact, rows): (&Contact, Rows)| (j, rows.of_levers(contact, problem.noise.contact));
                all.extend(problem.conditions(k, motion, &turn).map(of));
            }
        }
        let spins = at.motions.iter().map(|motion| motion.spin_derivatives(&at.body)).collect();
        let mut at_nodes = vec![Matrix3::zeros(); at.motions.len()];
        all.iter().for_each(|(j, noise)| at_nodes[*j] += noise);
        Self { each: all, at_nodes, spins }
    }

    /// Changes of the angular velocities by a step.
    pub(super) fn turned(&self, step: &Step<CONSTANTS>) -> Vec<Spin> {
        let inertia = step.body.fixed_rows::<INERTIA>(1);
        let one = |((by_motion, by_body), motion): (&(_, SMatrix<f64, 3, INERTIA>), &Tangent)| -> Spin {
            let by_motion: &SMatrix<f64, 3, MOTION> = by_motion;
            by_motion * motion + by_body * inertia
        };
        self.spins.iter().zip(&step.motions).map(one).collect()
    }

    /// What noise adds to the information times changes of the angular velocities, as half a gradient against them.
    fn against(&self, turned: &[Spin]) -> Gradient<CONSTANTS> {
        let mut body = SVector::<f64, CONSTANTS>::zeros();
        let mut motions = Vec::with_capacity(turned.len());
        for (((by_motion, by_body), noise), turned) in self.spins.iter().zip(&self.at_nodes).zip(turned) {
            let pull = noise * -turned;
            motions.push(by_motion.tr_mul(&pull));
            let mut inertia = body.fixed_rows_mut::<INERTIA>(1);
            inertia += by_body.tr_mul(&pull);
        }
        Gradient { motions, body }
    }

    /// Directions of which noise adds most to the information, independent of each other.
    pub(super) fn most_claimed(&self, at: &Unknowns, chain: &Chain<CONSTANTS>) -> Vec<Claimed> {
        let start = |i: usize| -> Vec<Spin> {
            let axis = DVec3::AXES[i % 3];
            at.motions.iter().map(|motion| Spin::from(if i < 3 { axis } else { motion.q * axis })).collect()
        };
        let mut turned: Vec<Vec<Spin>> = (0..SOUGHT).map(start).collect();
        let mut steps = Vec::new();
        for _ in 0..ROUNDS {
            if !turned.is_empty() {
                steps = self.more_claimed(chain, &turned);
            }
            turned = steps.iter().map(|step| self.turned(step)).collect();
        }
        let one = |(step, turned): (_, &Vec<Spin>)| {
            let (added, chance) = self.added(turned);
            Claimed { step, left: left(added, chance) }
        };
        steps.into_iter().zip(&turned).map(one).collect()
    }

    /// Steps of unit information, independent of each other, in the space of those that the equations make of what noise adds to these changes.
    fn more_claimed(&self, chain: &Chain<CONSTANTS>, turned: &[Vec<Spin>]) -> Vec<Step<CONSTANTS>> {
        let pulls: Vec<_> = turned.iter().map(|turned| self.against(turned)).collect();
        let steps: Vec<_> = pulls.iter().map(|pull| chain.step(pull)).collect();
        let count = steps.len();
        // A step is the inverse of the information times its pull.
        let shared = |i: usize, k: usize| -0.5 * (pulls[i].dot(&steps[k]) + pulls[k].dot(&steps[i]));
        let lengths: Vec<f64> = (0..count).map(|i| shared(i, i).max(f64::MIN_POSITIVE).sqrt()).collect();
        let cosines =
            nalgebra::DMatrix::from_fn(count, count, |i, k| shared(i, k) / (lengths[i] * lengths[k]));
        if cosines.iter().any(|of| !of.is_finite()) {
            return Vec::new();
        }
        let eigen = SymmetricEigen::new(cosines);
        let own = (0..count).filter(|&m| eigen.eigenvalues[m] > OWN);
        let basis: Vec<_> = own
            .map(|m| {
                let root = eigen.eigenvalues[m].sqrt();
                sum(&steps, |i| eigen.eigenvectors[(i, m)] / (lengths[i] * root))
            })
            .collect();
        if basis.is_empty() {
            return basis;
        }
        let turned: Vec<_> = basis.iter().map(|step| self.turned(step)).collect();
        let pulls: Vec<_> = turned.iter().map(|turned| self.against(turned)).collect();
        let claimed = nalgebra::DMatrix::from_fn(basis.len(), basis.len(), |i, k| {
            -0.5 * (pulls[i].dot(&basis[k]) + pulls[k].dot(&basis[i]))
        });
        let eigen = SymmetricEigen::new(claimed);
        (0..basis.len()).map(|m| sum(&basis, |i| eigen.eigenvectors[(i, m)])).collect()
    }

    /// What noise adds along changes of the angular velocities on average, and the deviation of that.
    pub(super) fn added(&self, turned: &[Spin]) -> (f64, f64) {
        let each = self.each.iter().map(|(j, noise)| turned[*j].dot(&(noise * turned[*j])));
        let (sum, squares) = each.fold((0.0, 0.0), |(sum, squares), of| (sum + of, squares + of * of));
        (sum, (2.0 * squares).sqrt())
    }
}

/// A direction of unit information of which noise of levers may make much.
pub(super) struct Claimed {
    pub(super) step: Step<CONSTANTS>,
    /// Share of the information that is there without it; zero where that may be chance.
    pub(super) left: f64,
}

/// Of which noise adds `added` with a deviation of `chance`: by the mean of the inverse of its square, to second order.
fn left(added: f64, chance: f64) -> f64 {
    let rest = 1.0 - added;
    if rest > CHANCE * chance { rest / (1.0 + 3.0 * (chance / rest).powi(2)).sqrt() } else { 0.0 }
}

/// Angular velocities at the nodes.
pub(super) fn spins(at: &Unknowns) -> Vec<Spin> {
    at.motions.iter().map(|motion| at.body.spin(motion.q, motion.L).into()).collect()
}

/// Steps of independent errors beside those that the equations claim: along directions of which noise of contacts poses as information; and the
/// one of what is taken for noise of conditions and may be none, so that levers are taken for better than they are.
pub(super) fn errors_of_levers(problem: &Problem, solved: &Solved<CONSTANTS>) -> Vec<Step<CONSTANTS>> {
    let at = &solved.unknowns;
    let Some((chain, _)) = solved.equations.solver(&problem.natural_information()) else {
        return Vec::new();
    };
    let levers = Levers::new(problem, at);
    let claimed = levers.most_claimed(at, &chain);
    let wider =
        |Claimed { step, left }: &Claimed| step.scaled((left.clamp(LEAST, 1.0).powi(-2) - 1.0).sqrt());
    let mut errors: Vec<_> = claimed.iter().map(wider).collect();
    errors.push(chain.step(&levers.against(&spins(at))));
    errors
}

/// With weights.
fn sum(steps: &[Step<CONSTANTS>], weight: impl Fn(usize) -> f64) -> Step<CONSTANTS> {
    let nodes = steps.first().map_or(0, |step| step.motions.len());
    let mut all = Step { motions: vec![Tangent::zeros(); nodes], body: SVector::zeros() };
    for (i, step) in steps.iter().enumerate() {
        let by = weight(i);
        all.motions.iter_mut().zip(&step.motions).for_each(|(all, of)| *all += of * by);
        all.body += step.body * by;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::left;

    /// Nothing is taken off where noise adds nothing, all where the rest may be chance, and more the larger that is.
    #[test]
    fn what_may_be_chance_is_not_left() {
        assert_eq!([left(0.0, 0.0), left(0.25, 0.0)], [1.0, 0.75]);
        assert!(left(0.5, 0.1) < 0.5 && left(0.5, 0.2) < left(0.5, 0.1) && left(0.5, 0.2) > 0.0);
        assert_eq!([left(0.5, 0.26), left(1.0, 0.1), left(1.5, 0.0)], [0.0; 3]);
    }
}
