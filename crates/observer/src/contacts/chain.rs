//! A chain of nodes, and the constants that all of them share, eliminated.
//!
//! From either end nodes are eliminated towards one between, the root, which comes last: of long chains the two sides are work of two threads. All that is
//! asked of a chain afterwards goes down the sides to the root, and up from there. Of short chains the root is the last node, and there is one side.

use super::elimination::Eliminated;
use super::equations::{Equations, Gradient};
use super::flow::Transition;
use super::solve::Step;
use super::state::{MOTION, Tangent};
use super::triangular::{factor, inverse};
use contact_kinematics::at_once;
use nalgebra::{SMatrix, SVector};

/// Nodes from which on two threads work. Of whole logs alone: the windows of a stream are fewer, and leave the other cores to the robot.
pub(super) const SHARED: usize = 500;

/// The nodes of a chain, each solved for its own motion by that of the next one towards the root, and what is left for the constants.
pub(super) struct Chain<const P: usize> {
    /// From the first node to the root.
    first: Vec<Eliminated<P>>,
    /// From the last node back to the one after the root.
    rest: Vec<Eliminated<P>>,
    /// Covariance of the constants.
    pub(super) body: SMatrix<f64, P, P>,
}

/// Covariance of a motion for given constants, and how it follows the constants.
pub(super) type Known<const P: usize> = (Transition, SMatrix<f64, MOTION, P>);

/// What the nodes that are eliminated leave of the equations of the next one and of the constants.
struct Left<const P: usize> {
    own: Transition,
    to_body: SMatrix<f64, MOTION, P>,
    body: SMatrix<f64, P, P>,
}

impl<const P: usize> Left<P> {
    fn of(body: SMatrix<f64, P, P>) -> Self {
        Self { own: Transition::zeros(), to_body: SMatrix::zeros(), body }
    }
}

/// A gradient on its way down a side.
struct Down<const P: usize> {
    carried: Tangent,
    body: SVector<f64, P>,
    /// Its square by the inverse of the equations, as far as it comes from the nodes so far.
    square: f64,
}

impl<const P: usize> Down<P> {
    fn of(body: SVector<f64, P>) -> Self {
        Self { carried: Tangent::zeros(), body, square: 0.0 }
    }

    /// Takes a node's gradient, and gives what is left of it.
    fn take(&mut self, node: &Eliminated<P>, gradient: &Tangent) -> Tangent {
        let (mut own, mut next) = (gradient + self.carried, Tangent::zeros());
        node.down(&mut own, &mut next, &mut self.body);
        self.carried = next;
        self.square += own.norm_squared();
        own
    }

    /// Where two sides meet.
    fn meet(self, other: Self) -> Self {
        let Self { carried, body, square } = other;
        Self { carried: self.carried + carried, body: self.body + body, square: self.square + square }
    }
}

/// Which of so many nodes is eliminated last.
fn root(count: usize) -> usize {
    if count < SHARED { count.saturating_sub(1) } else { count / 2 }
}

/// Both, at once where there is a second one.
fn sides<A: Send, B>(two: bool, first: impl FnOnce() -> A + Send, rest: impl FnOnce() -> B) -> (A, B) {
    if two { at_once(first, rest) } else { (first(), rest()) }
}

impl<const P: usize> Default for Chain<P> {
    fn default() -> Self {
        Self { first: Vec::new(), rest: Vec::new(), body: SMatrix::zeros() }
    }
}

impl<const P: usize> Equations<P> {
    /// Eliminates nodes one after the other, each with its neighbour behind or, on the way `back`, before it, and gives them to `each`. None where
    /// the equations are not positive definite.
    fn side(
        &self,
        (order, back): (impl Iterator<Item = usize>, bool),
        damping: &Tangent,
        mut left: Left<P>,
        mut each: impl FnMut(usize, Eliminated<P>),
    ) -> Option<Left<P>> {
        for j in order {
            let (own, to_body) = self.of_node(j, damping, &left);
            let node = match back {
                false => Eliminated::new(&own, &self.nodes[j].next, &to_body),
                true => Eliminated::new(&own, &self.nodes[j - 1].next.transpose(), &to_body),
            }?;
            left = Left::of(left.body);
            node.lessen(&mut left.own, &mut left.to_body, &mut left.body);
            each(j, node);
        }
        Some(left)
    }

    /// Equations of a node and its block with the constants, with what is left from before.
    fn of_node(&self, j: usize, damping: &Tangent, left: &Left<P>) -> (Transition, SMatrix<f64, MOTION, P>) {
        let mut own = self.nodes[j].own + left.own;
        for i in 0..MOTION {
            own[(i, i)] += damping[i];
        }
        (own, self.nodes[j].body + left.to_body)
    }

    /// Eliminates all nodes, the root last, and gives the others of both sides to `first` and `rest`. Gives the root and the covariance of the constants; none
    /// where the equations are not positive definite.
    fn eliminated(
        &self,
        root: usize,
        (damping, body_damping): (&Tangent, f64),
        first: impl FnMut(usize, Eliminated<P>) + Send,
        rest: impl FnMut(usize, Eliminated<P>),
    ) -> Option<(Eliminated<P>, SMatrix<f64, P, P>)> {
        let count = self.nodes.len();
        let body = self.body + SMatrix::identity() * body_damping;
        let (before, after) = sides(
            root + 1 < count,
            || self.side((0..root, false), damping, Left::of(body), first),
            || self.side(((root + 1..count).rev(), true), damping, Left::of(SMatrix::zeros()), rest),
        );
        let (before, after) = (before?, after?);
        let mut left = Left {
            own: before.own + after.own,
            to_body: before.to_body + after.to_body,
            body: before.body + after.body,
        };
        let (own, to_body) = self.of_node(root, damping, &left);
        let last = Eliminated::new(&own, &Transition::zeros(), &to_body)?;
        last.lessen(&mut Transition::zeros(), &mut SMatrix::zeros(), &mut left.body);
        Some((last, inverse(&factor(&left.body)?)))
    }

    /// The chain, in memory that is there. None where the equations are not positive definite.
    pub(super) fn chain(&self, damping: (&Tangent, f64), room: Chain<P>) -> Option<Chain<P>> {
        self.chain_to(root(self.nodes.len()), damping, room)
    }

    fn chain_to(&self, root: usize, damping: (&Tangent, f64), room: Chain<P>) -> Option<Chain<P>> {
        let Chain { mut first, mut rest, .. } = room;
        first.clear();
        rest.clear();
        first.reserve(root + 1);
        rest.reserve(self.nodes.len().saturating_sub(root + 1));
        let (last, body) =
            self.eliminated(root, damping, |_, node| first.push(node), |_, node| rest.push(node))?;
        first.push(last);
        Some(Chain { first, rest, body })
    }

    /// Fall of the cost that an undamped step promises.
    pub(super) fn left(&self) -> f64 {
        self.left_to(root(self.nodes.len()))
    }

    fn left_to(&self, root: usize) -> f64 {
        let (mut first, mut rest) = (Down::of(self.body_gradient), Down::of(SVector::zeros()));
        let gradient = |j: usize| &self.nodes[j].gradient;
        let take_first = |j: usize, node: Eliminated<P>| {
            first.take(&node, gradient(j));
        };
        let take_rest = |j: usize, node: Eliminated<P>| {
            rest.take(&node, gradient(j));
        };
        let Some((last, body)) = self.eliminated(root, (&Tangent::zeros(), 0.0), take_first, take_rest)
        else {
            return f64::INFINITY;
        };
        let mut all = first.meet(rest);
        all.take(&last, gradient(root));
        all.square + (body * all.body).dot(&all.body)
    }
}

impl<const P: usize> Chain<P> {
    fn is_split(&self) -> bool {
        !self.rest.is_empty()
    }

    /// Logarithm of the determinant of the equations, without the constants.
    pub(super) fn log_det(&self) -> f64 {
        self.first.iter().chain(&self.rest).map(Eliminated::log_det).sum()
    }

    /// The step that takes a gradient to zero.
    pub(super) fn step(&self, gradient: &Gradient<P>) -> Step<P> {
        let Some((root, first)) = self.first.split_last() else {
            return Step { motions: Vec::new(), body: SVector::zeros() };
        };
        let down = |nodes: &[Eliminated<P>], gradients: &mut dyn Iterator<Item = &Tangent>, of_body| {
            let mut down = Down::of(of_body);
            let left: Vec<Tangent> =
                nodes.iter().zip(gradients).map(|(node, own)| -down.take(node, own)).collect();
            (left, down)
        };
        let motions = &gradient.motions;
        let ((first_left, before), (rest_left, after)) = sides(
            self.is_split(),
            || down(first, &mut motions.iter(), gradient.body),
            || down(&self.rest, &mut motions.iter().rev(), SVector::zeros()),
        );
        let mut all = before.meet(after);
        let left = -all.take(root, &motions[first.len()]);
        let constants = -(self.body * all.body);
        let last = root.up(&left, &Tangent::zeros(), &constants);
        let up = |nodes: &[Eliminated<P>], mut left: Vec<Tangent>| {
            let mut next = last;
            for (node, left) in nodes.iter().zip(&mut left).rev() {
                next = node.up(left, &next, &constants);
                *left = next;
            }
            left
        };
        let (mut motions, rest) =
            sides(self.is_split(), || up(first, first_left), || up(&self.rest, rest_left));
        motions.push(last);
        motions.extend(rest.into_iter().rev());
        Step { motions, body: constants }
    }

    /// Of each motion what is known of it, and its covariance with the next one for given constants.
    pub(super) fn covariances(&self) -> (Vec<Known<P>>, Vec<Transition>) {
        let Some((root, first)) = self.first.split_last() else { return (Vec::new(), Vec::new()) };
        let last = known(root);
        let (first, rest) = sides(self.is_split(), || outwards(first, last), || outwards(&self.rest, last));
        let (mut motions, mut next) = first;
        motions.reverse();
        next.reverse();
        motions.push(last);
        motions.extend(rest.0);
        next.extend(rest.1.iter().map(Transition::transpose));
        (motions, next)
    }

    /// What is known of the last motion.
    pub(super) fn last(&self) -> Option<Known<P>> {
        let root = known(self.first.last()?);
        Some(outwards(&self.rest, root).0.last().copied().unwrap_or(root))
    }

    /// The nodes from the root to the first one, and those after the root to the last one, each with its number.
    pub(super) fn both_sides(&self) -> [Vec<(usize, &Eliminated<P>)>; 2] {
        let count = self.first.len();
        let after = |(i, node)| (count + i, node);
        [
            self.first.iter().enumerate().rev().collect(),
            self.rest.iter().rev().enumerate().map(after).collect(),
        ]
    }
}

fn known<const P: usize>(root: &Eliminated<P>) -> Known<P> {
    let (own, _, by_body) = root.inverse();
    (own, -by_body)
}

/// The same of the nodes of a side, from the root outwards, each with its covariance with the one before.
fn outwards<const P: usize>(nodes: &[Eliminated<P>], root: Known<P>) -> (Vec<Known<P>>, Vec<Transition>) {
    let (mut motions, mut beside) = (Vec::with_capacity(nodes.len()), Vec::with_capacity(nodes.len()));
    let (mut after, mut follows) = root;
    for node in nodes.iter().rev() {
        let (own, by_next, by_body) = node.inverse();
        let with_next = by_next * after;
        beside.push(-with_next);
        after = own + with_next * by_next.transpose();
        follows = -by_body - by_next * follows;
        motions.push((after, follows));
    }
    (motions, beside)
}

#[cfg(test)]
mod tests {
    use super::super::equations::NodeEquations;
    use super::super::solve::Covariances;
    use super::*;
    use crate::random::Normal;

    const NODES: usize = 6;
    const CONSTANTS: usize = 2;

    fn equations(normal: &mut Normal) -> Equations<CONSTANTS> {
        let mut square = || Transition::from_fn(|_, _| normal.draw());
        let node = |(own, next, body): (Transition, Transition, Transition)| NodeEquations {
            own: own * own.transpose() + Transition::identity() * 30.0,
            next,
            body: body.fixed_columns::<CONSTANTS>(0).into_owned(),
            gradient: body.column(CONSTANTS).into_owned(),
            cost: 0.0,
            conditions: 0,
        };
        let mut nodes: Vec<_> = (0..NODES).map(|_| node((square(), square(), square()))).collect();
        nodes[NODES - 1].next.fill(0.0);
        let (body, body_gradient) = (SMatrix::identity() * 300.0, SVector::from_fn(|i, _| 1.0 - i as f64));
        Equations { nodes, body, body_gradient, cost: 0.0, conditions: 0, links: Vec::new() }
    }

    /// The equations as one matrix, the constants last.
    fn dense(
        of: &Equations<CONSTANTS>,
        damping: &Tangent,
    ) -> (nalgebra::DMatrix<f64>, nalgebra::DVector<f64>) {
        let constants = MOTION * NODES;
        let mut all = nalgebra::DMatrix::zeros(constants + CONSTANTS, constants + CONSTANTS);
        let mut gradient = nalgebra::DVector::zeros(constants + CONSTANTS);
        for (j, node) in of.nodes.iter().enumerate() {
            let at = MOTION * j;
            all.view_mut((at, at), (MOTION, MOTION))
                .copy_from(&(node.own + Transition::from_diagonal(damping)));
            if j + 1 < NODES {
                all.view_mut((at, at + MOTION), (MOTION, MOTION)).copy_from(&node.next);
                all.view_mut((at + MOTION, at), (MOTION, MOTION)).copy_from(&node.next.transpose());
            }
            all.view_mut((at, constants), (MOTION, CONSTANTS)).copy_from(&node.body);
            all.view_mut((constants, at), (CONSTANTS, MOTION)).copy_from(&node.body.transpose());
            gradient.rows_mut(at, MOTION).copy_from(&node.gradient);
        }
        all.view_mut((constants, constants), (CONSTANTS, CONSTANTS)).copy_from(&of.body);
        gradient.rows_mut(constants, CONSTANTS).copy_from(&of.body_gradient);
        (all, gradient)
    }

    /// Whichever node comes last, a chain says what its equations as one matrix say.
    #[test]
    fn a_chain_is_its_equations_wherever_it_is_rooted() {
        let mut normal = Normal::seeded(33);
        let all = equations(&mut normal);
        let damping = Tangent::from_fn(|i, _| 0.1 * i as f64);
        let (matrix, gradient) = dense(&all, &damping);
        let whole = matrix.clone().cholesky().unwrap();
        let (covariance, expected) = (whole.inverse(), -whole.solve(&gradient));
        let constants = MOTION * NODES;
        let given = matrix.view((0, 0), (constants, constants)).into_owned().cholesky().unwrap();
        let of_motions = given.inverse();
        for root in 0..NODES {
            let chain = all.chain_to(root, (&damping, 0.0), Chain::default()).unwrap();
            let log_det = chain.log_det();
            assert!((log_det - 2.0 * given.l().diagonal().map(f64::ln).sum()).abs() < 1e-10 * log_det.abs());
            let body = covariance.view((constants, constants), (CONSTANTS, CONSTANTS));
            assert!((chain.body - body).norm() < 1e-12 * body.norm());

            let step = chain.step(&all.gradient());
            assert_eq!(step.motions.len(), NODES);
            let motions = step.motions.iter().enumerate();
            let off = motions.map(|(j, own)| (expected.rows(MOTION * j, MOTION) - own).norm()).sum::<f64>();
            assert!(off < 1e-12 * expected.norm(), "{root}: {off}");
            assert!((expected.rows(constants, CONSTANTS) - step.body).norm() < 1e-12 * expected.norm());

            let (motions, next) = chain.covariances();
            assert_eq!((motions.len(), next.len()), (NODES, NODES - 1));
            for (j, (own, follows)) in motions.iter().enumerate() {
                let at = MOTION * j;
                let block = |to: usize| of_motions.view((at, to), (MOTION, MOTION)).into_owned();
                assert!((block(at) - own).norm() < 1e-12 * own.norm(), "{root}, {j}");
                if let Some(with_next) = next.get(j) {
                    assert!((block(at + MOTION) - with_next).norm() < 1e-12 * own.norm(), "{root}, {j}");
                }
                let slopes = covariance.view((at, constants), (MOTION, CONSTANTS)) - follows * body;
                assert!(slopes.norm() < 1e-12 * covariance.norm(), "{root}, {j}");
            }
            assert_eq!(chain.last(), motions.last().copied());
            let (undamped, gradient) = dense(&all, &Tangent::zeros());
            let left = gradient.dot(&undamped.cholesky().unwrap().solve(&gradient));
            assert!((all.left_to(root) - left).abs() < 1e-12 * left, "{root}");
        }
    }

    /// What has no factor on either side or at the root is no chain.
    #[test]
    fn equations_that_are_not_positive_definite_are_none() {
        for bad in 0..NODES {
            let mut all = equations(&mut Normal::seeded(34));
            all.nodes[bad].own[(2, 2)] = -1.0;
            for root in 0..NODES {
                assert!(all.chain_to(root, (&Tangent::zeros(), 0.0), Chain::default()).is_none());
                assert_eq!(all.left_to(root), f64::INFINITY);
            }
        }
    }

    /// Errors that are drawn have the covariances that the chain has, and go with the constants as it says, wherever it is rooted.
    #[test]
    fn what_is_drawn_has_the_covariance_of_the_chain() {
        let mut normal = Normal::seeded(35);
        let all = equations(&mut normal);
        let asked = [0, 1, 4];
        for root in [0, 2, 4, NODES - 1] {
            let chain = all.chain_to(root, (&Tangent::zeros(), 0.0), Chain::default()).unwrap();
            let (motions, next) = chain.covariances();
            let (body, beyond, errors) = (chain.body, Vec::new(), Vec::new());
            let joint = Covariances { motions, next, body, chain, mended: 0.0, beyond, errors }.joint(&asked);
            let constants = SVector::<f64, CONSTANTS>::new(3.0, -2.0);
            let all_at = all.chain_to(root, (&Tangent::zeros(), 0.0), Chain::default()).unwrap();
            let (expected, beside) = all_at.covariances();
            let draws: Vec<_> = (0..4000).map(|_| joint.draw(&constants, &mut normal)).collect();
            let mean = |of: &dyn Fn(&Vec<Tangent>) -> Transition| {
                draws.iter().map(of).sum::<Transition>() / draws.len() as f64
            };
            for (i, j) in asked.into_iter().enumerate() {
                let (own, follows) = &expected[j];
                let shift = follows * constants;
                let found = mean(&|draw| (draw[i] - shift) * (draw[i] - shift).transpose());
                // A variance of 4000 draws is known to 2.2 %, and 144 of them are looked at.
                assert!((found - own).amax() < 0.12 * own.amax(), "{root}, {j}");
            }
            let shifts = [0, 1].map(|j| expected[j].1 * constants);
            let with = mean(&|draw| (draw[0] - shifts[0]) * (draw[1] - shifts[1]).transpose());
            assert!((with - beside[0]).amax() < 0.12 * expected[0].0.amax(), "{root}");
        }
    }
}
