//! Normal equations of a chain of nodes: what [`Problem`](super::problem::Problem) is linearised to.

use super::body::Body;
use super::flow::{Carried, Transition};
use super::solve::Step;
use super::state::{MOTION, Motion, Tangent, tangent};
use glam::DVec3;
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
    /// What the motion at its node comes to, with derivatives.
    pub(super) carried: Carried<P>,
    /// Inverse covariance of the residual, and by what of motion and body it falls, at adjusted impulses.
    pub(super) information: Transition,
    pub(super) adjusted: Carried<P>,
}

/// A condition, linearised: its value and its derivatives by a motion (centre of mass, velocity, angular momentum, turn) and by the
/// body's constants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<const P: usize> {
    pub(super) by_motion: [DVec3; 4],
    pub(super) by_body: SVector<f64, P>,
    pub(super) value: f64,
}

impl<const P: usize> Row<P> {
    pub(super) fn tangent(&self) -> Tangent {
        tangent(&self.by_motion)
    }

    pub(super) fn zero() -> Self {
        Self { by_motion: [DVec3::ZERO; 4], by_body: SVector::zeros(), value: 0.0 }
    }

    /// Adds a multiple of another one.
    pub(super) fn add(&mut self, factor: f64, other: &Self) {
        for (own, other) in self.by_motion.iter_mut().zip(other.by_motion) {
            *own += factor * other;
        }
        self.by_body.axpy(factor, &other.by_body, 1.0);
        self.value += factor * other.value;
    }
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
    /// Of so many nodes of which nothing is known.
    pub(super) fn none(count: usize) -> Self {
        let zero = NodeEquations {
            own: Transition::zeros(),
            next: Transition::zeros(),
            body: SMatrix::zeros(),
            gradient: Tangent::zeros(),
            cost: 0.0,
            conditions: 0,
        };
        Self {
            nodes: vec![zero; count],
            body: SMatrix::zeros(),
            body_gradient: SVector::zeros(),
            cost: 0.0,
            conditions: 0,
            links: Vec::with_capacity(count),
        }
    }

    /// Together with those of the nodes from the last of these on, of which these tell what the link before it says.
    pub(super) fn followed_by(mut self, rest: Self) -> Self {
        let before = self.nodes.pop();
        let boundary = self.nodes.len();
        self.nodes.extend(rest.nodes);
        if let Some((own, before)) = self.nodes.get_mut(boundary).zip(before) {
            own.own += before.own;
            own.body += before.body;
            own.gradient += before.gradient;
        }
        self.links.extend(rest.links);
        self.body += rest.body;
        self.body_gradient += rest.body_gradient;
        self.cost += rest.cost;
        self.conditions += rest.conditions;
        self
    }

    pub(super) fn gradient(&self) -> Gradient<P> {
        Gradient { motions: self.nodes.iter().map(|node| node.gradient).collect(), body: self.body_gradient }
    }

    /// As far as it comes from links with other residuals.
    pub(super) fn gradient_of(&self, residuals: &[Tangent]) -> Gradient<P> {
        let mut all = Gradient { motions: vec![Tangent::zeros(); self.nodes.len()], body: SVector::zeros() };
        for (j, (link, residual)) in self.links.iter().zip(residuals).enumerate() {
            let weighted = link.information * residual;
            let (motion, body) = link.adjusted.pulled(&weighted);
            all.motions[j] -= motion;
            all.motions[j + 1] += weighted;
            all.body -= body;
        }
        all
    }

    /// A condition in its deviation, by the motion at node `j`.
    pub(super) fn add(&mut self, j: usize, row: &Row<P>) {
        let own = row.tangent();
        let node = &mut self.nodes[j];
        node.own.ger(1.0, &own, &own, 1.0);
        node.gradient.axpy(row.value, &own, 1.0);
        node.cost += row.value * row.value;
        node.conditions += 1;
        self.cost += row.value * row.value;
        self.conditions += 1;
        if P > 0 {
            node.body.ger(1.0, &own, &row.by_body, 1.0);
            self.body.ger(1.0, &row.by_body, &row.by_body, 1.0);
            self.body_gradient.axpy(row.value, &row.by_body, 1.0);
        }
    }

    /// The same where the condition falls with the motion at the next node too.
    pub(super) fn add_split(&mut self, j: usize, row: &Row<P>, next: &[DVec3; 4]) {
        self.add(j, row);
        let own = row.tangent();
        let after = tangent(next);
        self.nodes[j].next.ger(1.0, &own, &after, 1.0);
        let node = &mut self.nodes[j + 1];
        node.own.ger(1.0, &after, &after, 1.0);
        node.gradient.axpy(row.value, &after, 1.0);
        if P > 0 {
            node.body.ger(1.0, &after, &row.by_body, 1.0);
        }
    }

    /// The link from node `i` to the next one, at whose end the motion comes to `carried` and is `next`, with the inverse covariance of the difference.
    pub(super) fn add_link(
        &mut self,
        i: usize,
        next: &Motion,
        carried: &Carried<P>,
        information: &Transition,
        body: &Body,
    ) {
        let residual = next.from(&carried.motion);
        let weighted = information * residual;
        let adjusted = carried.adjusted(body, &residual);
        let (by_motion, by_body) = adjusted.pulled(information);
        let by_body = by_body.transpose();
        let (of_motion, of_body) = adjusted.pulled(&by_motion.transpose());
        let (gradient, body_gradient) = adjusted.pulled(&weighted);
        let cost = weighted.dot(&residual);
        self.cost += cost;
        let node = &mut self.nodes[i];
        node.cost += cost;
        node.own += of_motion;
        node.next -= by_motion;
        node.gradient -= gradient;
        node.body += of_body.transpose();
        self.body += adjusted.pulled(&by_body).1;
        self.body_gradient -= body_gradient;
        let next = &mut self.nodes[i + 1];
        next.own += information;
        next.gradient += weighted;
        next.body -= by_body;
        self.links.push(LinkEquation { residual, carried: *carried, information: *information, adjusted });
    }
}
