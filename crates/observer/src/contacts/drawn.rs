//! Errors of the motions at some of the nodes, drawn together.
//!
//! Each motion goes with that at the next node and with the constants; those in between are summed over once, and not for each draw.

use super::elimination::Eliminated;
use super::flow::Transition;
use super::solve::Covariances;
use super::state::{MOTION, Tangent};
use crate::random::Normal;
use crate::rigid::{normals, root};
use nalgebra::{SMatrix, SVector};

/// The error of a motion, by that at the next node that is kept and by the constants, and a root of the covariance of what it has of its own.
struct Kept<const P: usize> {
    by_next: Transition,
    by_body: SMatrix<f64, MOTION, P>,
    own: Transition,
}

/// The nodes that are kept on either side of the root, from there outwards.
pub(super) struct Joint<const P: usize> {
    before: Vec<Kept<P>>,
    after: Vec<Kept<P>>,
    /// Whether the root is kept for both sides' sake alone.
    root_is_between: bool,
}

impl<const P: usize> Covariances<P> {
    /// Of the motions at those nodes, in order.
    pub(super) fn joint(&self, nodes: &[usize]) -> Joint<P> {
        let [before, after] = self.chain.both_sides();
        let asked = |j: usize| nodes.binary_search(&j).is_ok();
        let root = before.first().filter(|_| !after.is_empty()).map(|(j, _)| *j);
        Joint {
            before: kept(&before, |j| asked(j) || root == Some(j)),
            after: kept(&after, asked),
            root_is_between: root.is_some_and(|j| !asked(j)),
        }
    }
}

/// Of these nodes, each with the one before it, those that are to be kept.
fn kept<const P: usize>(nodes: &[(usize, &Eliminated<P>)], is_kept: impl Fn(usize) -> bool) -> Vec<Kept<P>> {
    let mut all = Vec::new();
    let none = (Transition::identity(), SMatrix::zeros(), Transition::zeros());
    let (mut by_next, mut by_body, mut own) = none;
    for &(j, node) in nodes {
        let (here, next, body) = node.inverse();
        own = here + next * own * next.transpose();
        by_body = -body - next * by_body;
        by_next = -next * by_next;
        if is_kept(j) {
            all.push(Kept { by_next, by_body, own: root(&own) });
            (by_next, by_body, own) = none;
        }
    }
    all
}

impl<const P: usize> Joint<P> {
    /// One draw that goes with an error of the constants, in the order of the nodes.
    pub(super) fn draw(&self, body: &SVector<f64, P>, random: &mut Normal) -> Vec<Tangent> {
        let mut drawn = |next: &mut Tangent, node: &Kept<P>| {
            let fresh: Tangent = normals(random);
            *next = node.by_next * *next + node.by_body * body + node.own * fresh;
            Some(*next)
        };
        let mut errors: Vec<_> = self.before.iter().scan(Tangent::zeros(), &mut drawn).collect();
        let root = errors.first().copied().unwrap_or_default();
        if self.root_is_between {
            errors.remove(0);
        }
        errors.reverse();
        errors.extend(self.after.iter().scan(root, &mut drawn));
        errors
    }
}

#[cfg(test)]
mod tests {
    use super::super::equations::{Equations, NodeEquations};
    use super::*;

    /// Of two nodes out of five, what is drawn has the covariances and the slopes that all five have there.
    #[test]
    fn what_lies_between_is_summed_over() {
        let mut normal = Normal::seeded(21);
        let mut square = || Transition::from_fn(|_, _| normal.draw());
        let node = |own: Transition, next: Transition, body: Transition| NodeEquations::<2> {
            own: own * own.transpose() + Transition::identity() * 20.0,
            next,
            body: body.fixed_columns::<2>(0).into_owned(),
            gradient: Tangent::zeros(),
            cost: 0.0,
            conditions: 0,
        };
        let mut nodes: Vec<_> = (0..5).map(|_| node(square(), square(), square())).collect();
        nodes[4].next.fill(0.0);
        let body = SMatrix::<f64, 2, 2>::identity() * 200.0;
        let body_gradient = SVector::zeros();
        let all = Equations { nodes, body, body_gradient, cost: 0.0, conditions: 0, links: Vec::new() };
        let covariances = all.covariances(&Tangent::zeros()).unwrap();
        let Joint { before: kept, .. } = covariances.joint(&[0, 3]);
        let own = |node: &Kept<2>| node.own * node.own.transpose();
        let (last, first) = (&kept[0], &kept[1]);
        let of_first = own(first) + first.by_next * own(last) * first.by_next.transpose();
        let slopes = first.by_body + first.by_next * last.by_body;
        for (j, found, slopes) in [(3, own(last), last.by_body), (0, of_first, slopes)] {
            let (covariance, follows) = &covariances.motions[j];
            assert!((found - covariance).amax() < 1e-12 * covariance.amax(), "{j}");
            assert!((slopes - follows).amax() < 1e-12 * follows.amax().max(1.0), "{j}");
        }
    }
}
