//! Normal equations of a chain of nodes: what [`Problem`](super::problem::Problem) is linearised to.

use super::feet::Foot;
use super::flow::{Carried, Transition};
use super::solve::Step;
use super::state::{MOTION, Tangent, tangent};
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
#[derive(Clone, Debug)]
pub(super) struct LinkEquation<const P: usize> {
    pub(super) residual: Tangent,
    /// The same without what conditions tell of contacts by whose moments it is off.
    pub(super) left: Tangent,
    /// What the motion at its node comes to, with derivatives.
    pub(super) carried: Carried<P>,
    /// Inverse covariance of what is left, and by what of motion and body the residual falls, at adjusted impulses.
    pub(super) information: Transition,
    pub(super) adjusted: Carried<P>,
    /// What tells of such contacts.
    pub(super) feet: Vec<Foot<P>>,
}

/// Derivatives of a number by the motions at a node and the next one and by the body's constants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split<const P: usize> {
    pub(super) own: Tangent,
    pub(super) next: Tangent,
    pub(super) body: SVector<f64, P>,
}

impl<const P: usize> Split<P> {
    /// Adds a multiple of another one.
    fn add(&mut self, factor: f64, other: &Self) {
        self.own.axpy(factor, &other.own, 1.0);
        self.next.axpy(factor, &other.next, 1.0);
        self.body.axpy(factor, &other.body, 1.0);
    }
}

impl<const P: usize> LinkEquation<P> {
    /// Derivatives along `weighted` of what is left.
    fn pulled(&self, weighted: &Tangent) -> Split<P> {
        let mut all = self.of_residual(weighted);
        for foot in &self.feet {
            all.add(-foot.by.dot(weighted), &foot.row);
        }
        all
    }

    /// The same of the residual.
    fn of_residual(&self, weighted: &Tangent) -> Split<P> {
        let (own, body) = self.adjusted.pulled(weighted);
        Split { own: -own, next: *weighted, body: -body }
    }
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

/// Memory of equations that are no longer needed, of a whole chain and of its second half. Pages of new memory would be as dear as what is written to them:
/// those of ten thousand nodes are 75 MB.
#[derive(Default)]
pub(super) struct Room<const P: usize> {
    pub(super) whole: Equations<P>,
    half: Equations<P>,
}

impl<const P: usize> Room<P> {
    /// For a chain of so many nodes, and for its second half.
    pub(super) fn taken(&mut self, count: usize) -> [&mut Equations<P>; 2] {
        let Self { whole: Equations { nodes, links, .. }, .. } = self;
        nodes.reserve(count.saturating_sub(nodes.len()));
        links.reserve(count.saturating_sub(links.len()));
        [&mut self.whole, &mut self.half]
    }
}

impl<const P: usize> Default for Equations<P> {
    fn default() -> Self {
        let (body, body_gradient) = (SMatrix::zeros(), SVector::zeros());
        Self { nodes: Vec::new(), body, body_gradient, cost: 0.0, conditions: 0, links: Vec::new() }
    }
}

impl<const P: usize> Equations<P> {
    /// Of so many nodes of which nothing is known, where these were.
    pub(super) fn cleared(&mut self, count: usize) {
        let zero = NodeEquations {
            own: Transition::zeros(),
            next: Transition::zeros(),
            body: SMatrix::zeros(),
            gradient: Tangent::zeros(),
            cost: 0.0,
            conditions: 0,
        };
        let (mut nodes, mut links) = (std::mem::take(&mut self.nodes), std::mem::take(&mut self.links));
        nodes.clear();
        nodes.resize(count, zero);
        links.clear();
        *self = Self { nodes, links, ..Self::default() };
    }

    /// Takes over those of the nodes from the last of these on, of which these tell what the link before it says.
    pub(super) fn take_on(&mut self, rest: &mut Self) {
        let before = self.nodes.pop();
        let boundary = self.nodes.len();
        self.nodes.append(&mut rest.nodes);
        if let Some((own, before)) = self.nodes.get_mut(boundary).zip(before) {
            own.own += before.own;
            own.body += before.body;
            own.gradient += before.gradient;
        }
        self.links.append(&mut rest.links);
        self.body += rest.body;
        self.body_gradient += rest.body_gradient;
        self.cost += rest.cost;
        self.conditions += rest.conditions;
    }

    pub(super) fn gradient(&self) -> Gradient<P> {
        Gradient { motions: self.nodes.iter().map(|node| node.gradient).collect(), body: self.body_gradient }
    }

    /// As far as it comes from links with other residuals.
    pub(super) fn gradient_of(&self, residuals: &[Tangent]) -> Gradient<P> {
        let mut all = Gradient { motions: vec![Tangent::zeros(); self.nodes.len()], body: SVector::zeros() };
        for (j, (link, residual)) in self.links.iter().zip(residuals).enumerate() {
            let slope = link.pulled(&(link.information * residual));
            all.motions[j] += slope.own;
            all.motions[j + 1] += slope.next;
            all.body += slope.body;
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

    /// A link after node number `j` of these.
    pub(super) fn add_link(&mut self, j: usize, link: LinkEquation<P>) {
        let LinkEquation { information, adjusted, .. } = &link;
        let weighted = information * link.left;
        let (by_motion, by_body) = adjusted.pulled(information);
        let by_body = by_body.transpose();
        let (of_motion, of_body) = adjusted.pulled(&by_motion.transpose());
        let slope = link.pulled(&weighted);
        let cost = weighted.dot(&link.left);
        self.cost += cost;
        let node = &mut self.nodes[j];
        node.cost += cost;
        node.own += of_motion;
        node.next -= by_motion;
        node.gradient += slope.own;
        node.body += of_body.transpose();
        self.body += adjusted.pulled(&by_body).1;
        self.body_gradient += slope.body;
        let next = &mut self.nodes[j + 1];
        next.own += information;
        next.gradient += slope.next;
        next.body -= by_body;
        // Of what is left the slope is that of the residual less that of what is told: squared, two terms more.
        for foot in &link.feet {
            let weighted = information * foot.by;
            let mut half = link.of_residual(&weighted);
            link.feet.iter().for_each(|other| half.add(-0.5 * other.by.dot(&weighted), &other.row));
            self.take_crossed(j, &foot.row, &half);
        }
        self.links.push(link);
    }

    /// Takes away the products of two slopes, both ways round.
    fn take_crossed(&mut self, j: usize, a: &Split<P>, b: &Split<P>) {
        for (a, b) in [(a, b), (b, a)] {
            let node = &mut self.nodes[j];
            node.own.ger(-1.0, &a.own, &b.own, 1.0);
            node.next.ger(-1.0, &a.own, &b.next, 1.0);
            self.nodes[j + 1].own.ger(-1.0, &a.next, &b.next, 1.0);
            if P > 0 {
                self.nodes[j].body.ger(-1.0, &a.own, &b.body, 1.0);
                self.nodes[j + 1].body.ger(-1.0, &a.next, &b.body, 1.0);
                self.body.ger(-1.0, &a.body, &b.body, 1.0);
            }
        }
    }
}
