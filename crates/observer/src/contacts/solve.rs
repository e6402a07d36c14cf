//! Levenberg-Marquardt steps on a chain of nodes and the constants that all of them share.

use super::flow::Transition;
use super::problem::{Equations, Problem, Unknowns};
use super::state::{MOTION, Tangent};
use crate::least_squares::{LARGEST_DAMPING, RAISE, lowered};
use nalgebra::{DMatrix, SMatrix, SVector};

/// First damping, as a share of the conditions' mean information.
const FIRST_DAMPING: f64 = 1e-3;
/// Fall of chi-squared that an undamped step from the end may still promise: a seventh of a standard deviation is left then.
const SETTLED: f64 = 0.02;
/// A step shorter than this in natural units is none.
const NO_STEP: f64 = 1e-10;

/// Where an iteration ended.
#[derive(Clone, Debug)]
pub(super) struct Solved<const P: usize> {
    pub(super) unknowns: Unknowns,
    pub(super) equations: Equations<P>,
    pub(super) iterations: usize,
    /// Whether there is no more to gain.
    pub(super) settled: bool,
}

/// A step of all unknowns.
pub(super) struct Step<const P: usize> {
    pub(super) motions: Vec<Tangent>,
    pub(super) body: SVector<f64, P>,
}

/// A node's step as it follows from the next node's, from that of the constants, and by itself; and its information then.
struct Eliminated<const P: usize> {
    next: Transition,
    body: SMatrix<f64, MOTION, P>,
    alone: Tangent,
    own: Transition,
}

/// The chain with the nodes eliminated, first to last, and what is left for the constants.
struct Reduced<const P: usize> {
    nodes: Vec<Eliminated<P>>,
    body: SMatrix<f64, P, P>,
    body_gradient: SVector<f64, P>,
}

/// Covariances of the unknowns.
pub(super) struct Covariances<const P: usize> {
    /// Of each motion for given constants, and how it follows the constants.
    pub(super) motions: Vec<(Transition, SMatrix<f64, MOTION, P>)>,
    /// Of each motion with the next one, for given constants.
    pub(super) next: Vec<Transition>,
    pub(super) body: SMatrix<f64, P, P>,
}

impl<const P: usize> Equations<P> {
    /// None where the equations are not positive definite.
    fn reduced(&self, damping: &Tangent, body_damping: f64) -> Option<Reduced<P>> {
        let mut nodes: Vec<Eliminated<P>> = Vec::with_capacity(self.nodes.len());
        let mut body = self.body + SMatrix::identity() * body_damping;
        let mut body_gradient = self.body_gradient;
        let mut carried: Option<(Transition, SMatrix<f64, MOTION, P>, Tangent)> = None;
        for node in &self.nodes {
            let (mut own, mut to_body, mut gradient) = (node.own, node.body, node.gradient);
            for i in 0..MOTION {
                own[(i, i)] += damping[i];
            }
            if let Some((less, less_body, less_gradient)) = carried {
                own -= less;
                to_body -= less_body;
                gradient -= less_gradient;
            }
            let factor = own.cholesky()?;
            let next = factor.solve(&node.next);
            let to_constants = factor.solve(&to_body);
            let alone = factor.solve(&gradient);
            let back = node.next.transpose();
            carried = Some((back * next, back * to_constants, back * alone));
            if P > 0 {
                body -= to_body.transpose() * to_constants;
                body_gradient -= to_body.transpose() * alone;
            }
            nodes.push(Eliminated { next, body: to_constants, alone, own });
        }
        Some(Reduced { nodes, body, body_gradient })
    }

    fn step(&self, damping: &Tangent, body_damping: f64) -> Option<Step<P>> {
        let reduced = self.reduced(damping, body_damping)?;
        let body = -(inverse(&reduced.body)? * reduced.body_gradient);
        let mut motions = vec![Tangent::zeros(); self.nodes.len()];
        let mut after = Tangent::zeros();
        for (step, node) in motions.iter_mut().zip(&reduced.nodes).rev() {
            *step = -node.alone - node.body * body - node.next * after;
            after = *step;
        }
        Some(Step { motions, body })
    }

    /// Fall of the cost that the linear model promises of a step which solves the damped equations, the damping counted as
    /// a cost.
    fn promised(&self, step: &Step<P>) -> f64 {
        let nodes: f64 = step.motions.iter().zip(&self.nodes).map(|(s, node)| s.dot(&node.gradient)).sum();
        -(nodes + step.body.dot(&self.body_gradient))
    }

    /// `unit` is the information of a node whose deviations are the natural units.
    ///
    /// Where rounding leaves the equations indefinite, as little of it is added as mends them: a deviation then is no larger than a
    /// natural unit over the root of that share of all nodes. None where a tenth of it is not enough.
    pub(super) fn covariances(&self, unit: &Tangent) -> Option<Covariances<P>> {
        let with = |share: f64| {
            let reduced = self.reduced(&(unit * share), 0.0)?;
            let body = inverse(&reduced.body)?;
            Some((reduced, body))
        };
        let (reduced, body) = [0.0, 1e-4, 1e-3, 1e-2, 0.1].into_iter().find_map(with)?;
        let mut motions = Vec::with_capacity(self.nodes.len());
        let mut next = Vec::with_capacity(self.nodes.len());
        let (mut after, mut follows) = (Transition::zeros(), SMatrix::<f64, MOTION, P>::zeros());
        for node in reduced.nodes.iter().rev() {
            next.push(-node.next * after);
            after = node.own.cholesky()?.inverse() + node.next * after * node.next.transpose();
            follows = -node.body - node.next * follows;
            motions.push((after, follows));
        }
        motions.reverse();
        next.reverse();
        next.pop();
        Some(Covariances { motions, next, body })
    }
}

/// None unless it is positive definite.
fn inverse<const P: usize>(matrix: &SMatrix<f64, P, P>) -> Option<SMatrix<f64, P, P>> {
    if P == 0 {
        return Some(*matrix);
    }
    let inverse = DMatrix::from_column_slice(P, P, matrix.as_slice()).cholesky()?.inverse();
    Some(SMatrix::from_column_slice(inverse.as_slice()))
}

/// Minimises the cost from `start` by at most so many linearisations, until a step promises to lower it by less than
/// `enough`. None where the problem cannot be evaluated at the start.
pub(super) fn solve<const P: usize>(
    problem: &Problem,
    start: Unknowns,
    most: usize,
    enough: f64,
) -> Option<Solved<P>> {
    let mut unknowns = start;
    let mut equations = problem.linearise::<P>(&unknowns)?;
    let unit = problem.natural_information();
    let mean =
        problem.condition_information() * equations.conditions as f64 / (problem.nodes.len() * MOTION) as f64;
    let (mut damping, mut raise, mut iterations) = (FIRST_DAMPING, RAISE, 1);
    let mut done = false;
    while iterations < most && !done && damping < LARGEST_DAMPING {
        let step = equations.step(&(unit * (damping * mean)), damping * mean);
        let trial = step.as_ref().and_then(|step| problem.trial(&unknowns, step, &equations));
        let promised = step.as_ref().map_or(f64::INFINITY, |step| equations.promised(step));
        let short = step.as_ref().is_some_and(|step| length(step, &unit) < NO_STEP);
        done = promised < enough || short;
        match trial.filter(|(_, cost)| *cost < equations.cost) {
            Some((moved, cost)) => {
                damping = lowered(damping, (equations.cost - cost) / promised);
                raise = RAISE;
                let Some(next) = problem.linearise(&moved) else { break };
                (unknowns, equations) = (moved, next);
                iterations += 1;
            }
            None => {
                damping *= raise;
                raise *= 2.0;
            }
        }
    }
    // A heavily damped step promises little anywhere: what counts is what all of the step would gain.
    let whole = equations.step(&Tangent::zeros(), 0.0);
    let settled = whole.is_some_and(|step| equations.promised(&step) < SETTLED.max(enough));
    Some(Solved { unknowns, equations, iterations, settled })
}

/// Longest step of a node or of the constants, in natural units.
fn length<const P: usize>(step: &Step<P>, unit: &Tangent) -> f64 {
    let squares = step.motions.iter().map(|s| s.component_mul(s).dot(unit));
    squares.fold(step.body.norm_squared(), f64::max).sqrt()
}
