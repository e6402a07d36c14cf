//! Normal equations of a chain of nodes: what [`Problem`](super::problem::Problem) is linearised to.

use super::flow::Transition;
use super::solve::Step;
use super::state::{MOTION, Tangent};
use nalgebra::{SMatrix, SVector};

/// Normal equations of one node.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeEquations<const P: usize> {
    pub(super) own: Transition,
    /// Block with the next node.
    pub(super) next: Transition,
    pub(super) body: SMatrix<f64, MOTION, P>,
    pub(super) gradient: Tangent,
    /// Squared residuals of the conditions and of the link from here on, and how many conditions.
    pub(super) cost: f64,
    pub(super) conditions: usize,
}

/// Normal equations at some unknowns.
#[derive(Clone, Debug)]
pub(super) struct Equations<const P: usize> {
    pub(super) nodes: Vec<NodeEquations<P>>,
    pub(super) body: SMatrix<f64, P, P>,
    pub(super) body_gradient: SVector<f64, P>,
    pub(super) cost: f64,
    pub(super) conditions: usize,
    pub(super) links: Vec<LinkEquation<P>>,
}

/// A link at some unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinkEquation<const P: usize> {
    pub(super) residual: Tangent,
    pub(super) by_motion: Transition,
    pub(super) by_body: SMatrix<f64, MOTION, P>,
    /// Inverse covariance of the residual, and by what of the motion before it falls, at adjusted impulses.
    pub(super) information: Transition,
    pub(super) adjusted: Transition,
    /// By what of the body it falls, at adjusted impulses.
    pub(super) adjusted_body: SMatrix<f64, MOTION, P>,
}

/// Normal equations of the conditions of one sample, by the motion at it.
pub(super) struct SampleEquations<const P: usize> {
    pub(super) own: Transition,
    pub(super) to_body: SMatrix<f64, MOTION, P>,
    pub(super) gradient: Tangent,
    pub(super) body: SMatrix<f64, P, P>,
    pub(super) body_gradient: SVector<f64, P>,
    pub(super) cost: f64,
    pub(super) conditions: usize,
}

/// Half the gradient of a cost.
pub(super) struct Gradient<const P: usize> {
    pub(super) motions: Vec<Tangent>,
    pub(super) body: SVector<f64, P>,
}

impl<const P: usize> Gradient<P> {
    /// Along a step.
    pub(super) fn dot(&self, step: &Step<P>) -> f64 {
        self.motions.iter().zip(&step.motions).map(|(a, b)| a.dot(b)).sum::<f64>() + self.body.dot(&step.body)
    }
}

impl<const P: usize> Equations<P> {
    pub(super) fn gradient(&self) -> Gradient<P> {
        Gradient { motions: self.nodes.iter().map(|node| node.gradient).collect(), body: self.body_gradient }
    }

    /// As far as it comes from links with other residuals.
    pub(super) fn gradient_of(&self, residuals: &[Tangent]) -> Gradient<P> {
        let mut all = Gradient { motions: vec![Tangent::zeros(); self.nodes.len()], body: SVector::zeros() };
        for (j, (link, residual)) in self.links.iter().zip(residuals).enumerate() {
            let weighted = link.information * residual;
            all.motions[j] -= link.adjusted.transpose() * weighted;
            all.motions[j + 1] += weighted;
            if P > 0 {
                all.body -= link.adjusted_body.transpose() * weighted;
            }
        }
        all
    }

    /// Conditions at a motion whose derivatives are `F` by that of node `j` and `E` by the body.
    pub(super) fn add(
        &mut self,
        j: usize,
        rows: &SampleEquations<P>,
        F: &Transition,
        E: &SMatrix<f64, MOTION, P>,
    ) {
        self.cost += rows.cost;
        self.conditions += rows.conditions;
        if rows.conditions == 0 {
            return;
        }
        let node = &mut self.nodes[j];
        node.cost += rows.cost;
        node.conditions += rows.conditions;
        let carried = rows.own * F;
        node.own += F.transpose() * carried;
        node.gradient += F.transpose() * rows.gradient;
        if P > 0 {
            node.body += F.transpose() * rows.to_body + carried.transpose() * E;
            let mixed = E.transpose() * rows.to_body;
            self.body += E.transpose() * rows.own * E + mixed + mixed.transpose() + rows.body;
            self.body_gradient += E.transpose() * rows.gradient + rows.body_gradient;
        }
    }
}
