//! Levenberg-Marquardt steps on a chain of nodes and the constants that all of them share.

use super::flow::Transition;
use super::problem::{Equations, Problem, Unknowns};
use super::state::{MOTION, Tangent};
use crate::least_squares::{LARGEST_DAMPING, RAISE, lowered};
use nalgebra::{SMatrix, SVector};

/// How a fit ended.
#[derive(Clone, Debug)]
pub(super) struct Solved<const P: usize> {
    pub(super) unknowns: Unknowns,
    pub(super) equations: Equations<P>,
    pub(super) iterations: usize,
    pub(super) settled: bool,
}

struct Eliminated<const P: usize> {
    /// What follows from the next node's step, the constants' step, and nothing.
    next: Transition,
    body: SMatrix<f64, MOTION, P>,
    alone: Tangent,
}

impl<const P: usize> Equations<P> {
    /// Steps that solve the normal equations with `damping` added; none where they are not positive definite.
    fn step(&self, damping: &Tangent, body_damping: f64) -> Option<(Vec<Tangent>, SVector<f64, P>)> {
        let mut kept: Vec<Eliminated<P>> = Vec::with_capacity(self.nodes.len());
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
            kept.push(Eliminated { next, body: to_constants, alone });
        }
        let shared = if P > 0 {
            -nalgebra::DMatrix::from_column_slice(P, P, body.as_slice())
                .cholesky()?
                .solve(&nalgebra::DVector::from_column_slice(body_gradient.as_slice()))
        } else {
            nalgebra::DVector::zeros(0)
        };
        let shared = SVector::<f64, P>::from_fn(|i, _| shared[i]);
        let mut steps = vec![Tangent::zeros(); self.nodes.len()];
        let mut after = Tangent::zeros();
        for (step, node) in steps.iter_mut().zip(&kept).rev() {
            *step = -node.alone - node.body * shared - node.next * after;
            after = *step;
        }
        Some((steps, shared))
    }

    fn gain(&self, steps: &[Tangent], body: &SVector<f64, P>) -> f64 {
        let nodes: f64 = steps.iter().zip(&self.nodes).map(|(step, node)| step.dot(&node.gradient)).sum();
        -(nodes + body.dot(&self.body_gradient))
    }
}

/// Minimises the cost from `start` by at most so many linearisations.
pub(super) fn solve<const P: usize>(problem: &Problem, start: Unknowns, most: usize) -> Option<Solved<P>> {
    let mut unknowns = start;
    let mut equations = problem.linearise::<P>(&unknowns)?;
    let units = problem.units;
    let natural = [units.length, units.speed, units.mass * units.length * units.speed, 1.0];
    let unit = Tangent::from_fn(|i, _| natural[i / 3].powi(-2));
    // Of the conditions, per node and number.
    let mut damping = 1e-3;
    let mean = equations.conditions as f64 / problem.nodes.len() as f64 * (units.speed / problem.noise.floor.max(problem.noise.contact * units.speed / units.length)).powi(2) / MOTION as f64;
    for iteration in 1..=most {
        let mut raise = RAISE;
        loop {
            let Some((steps, body)) = equations.step(&(unit * (damping * mean)), damping * mean) else {
                damping *= raise;
                raise *= 2.0;
                if damping > LARGEST_DAMPING { return None; }
                continue;
            };
            let promised = equations.gain(&steps, &body);
            let trial = problem.trial(&unknowns, &steps, &body, &equations);
            let gain = trial.as_ref().map_or(f64::NEG_INFINITY, |trial| equations.cost - trial.1);
            let longest = steps.iter().map(|s| s.component_mul(s).dot(&unit)).fold(body.norm_squared(), f64::max).sqrt();
            if std::env::var_os("TRACE").is_some() {
                eprintln!("{iteration:3} cost {:.6e} per {:.4} gain {gain:.3e} promised {promised:.3e} damping {damping:.1e} step {longest:.2e} mass {:.6}", equations.cost, equations.cost / equations.conditions as f64, unknowns.body.log_mass.exp());
            }
            if let Some((moved, _)) = trial.filter(|_| gain > 0.0) {
                unknowns = moved;
                damping = lowered(damping, gain / promised);
                equations = problem.linearise(&unknowns)?;
                if longest < 1e-9 || promised < 1e-6 * 1.0_f64.min(equations.cost) {
                    return Some(Solved { unknowns, equations, iterations: iteration, settled: true });
                }
                break;
            }
            if longest < 1e-9 || promised < 1e-6 {
                return Some(Solved { unknowns, equations, iterations: iteration, settled: true });
            }
            damping *= raise;
            raise *= 2.0;
            if damping > LARGEST_DAMPING {
                return Some(Solved { unknowns, equations, iterations: iteration, settled: false });
            }
        }
    }
    Some(Solved { unknowns, equations, iterations: most, settled: false })
}
