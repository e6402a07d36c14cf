//! One node of a chain eliminated: the innermost loop of every estimate.
//!
//! With `L L'` the node's own equations, all that later nodes need of them are the rows `L^-1 [next body]`: what they lose by the elimination
//! are products of these, and half of a solve is spared.

use super::flow::Transition;
use super::state::{MOTION, Tangent};
use super::triangular::{Rows, factor, forward, inverse_factor, product};
use nalgebra::{SMatrix, SVector};

/// A node of which the equations are solved for its own motion.
#[derive(Clone, Copy)]
pub(super) struct Eliminated<const P: usize> {
    /// Lower Cholesky factor of its own equations, with the reciprocals of the diagonal.
    factor: Rows<MOTION, MOTION>,
    /// The factor's inverse times the blocks with the next node and with the constants.
    next: Rows<MOTION, MOTION>,
    body: Rows<MOTION, P>,
}

impl<const P: usize> Eliminated<P> {
    /// Logarithm of the determinant of its own equations.
    pub(super) fn log_det(&self) -> f64 {
        (0..MOTION).map(|i| -2.0 * self.factor[i][i].ln()).sum()
    }

    /// Of symmetric equations, of which the lower half is read. None where they are not positive definite.
    pub(super) fn new(own: &Transition, next: &Transition, body: &SMatrix<f64, MOTION, P>) -> Option<Self> {
        let mut all = Self {
            factor: factor(own)?,
            next: std::array::from_fn(|i| std::array::from_fn(|j| next[(i, j)])),
            body: std::array::from_fn(|i| std::array::from_fn(|j| body[(i, j)])),
        };
        forward(&all.factor, &mut all.next);
        forward(&all.factor, &mut all.body);
        Some(all)
    }

    /// Takes what the elimination costs off the next node's equations, its block with the constants, and the constants' own.
    pub(super) fn lessen(
        &self,
        own: &mut Transition,
        to_body: &mut SMatrix<f64, MOTION, P>,
        body: &mut SMatrix<f64, P, P>,
    ) {
        let less = product(&self.next, &self.next);
        let less_body = product(&self.next, &self.body);
        let less_constants = product(&self.body, &self.body);
        for (j, row) in less.iter().enumerate() {
            // Symmetric: a row is a column.
            own.column_mut(j).iter_mut().zip(row).for_each(|(own, less)| *own -= less);
        }
        for (i, row) in less_body.iter().enumerate() {
            row.iter().enumerate().for_each(|(j, less)| to_body[(i, j)] -= less);
        }
        for (j, row) in less_constants.iter().enumerate() {
            body.column_mut(j).iter_mut().zip(row).for_each(|(own, less)| *own -= less);
        }
    }

    /// Takes the factor's inverse of a gradient, and what the next node and the constants then lose of theirs.
    pub(super) fn down(&self, own: &mut Tangent, next: &mut Tangent, body: &mut SVector<f64, P>) {
        for i in 0..MOTION {
            let sum: f64 = (0..i).map(|k| self.factor[i][k] * own[k]).sum();
            own[i] = (own[i] - sum) * self.factor[i][i];
            next.iter_mut().zip(&self.next[i]).for_each(|(next, of)| *next -= own[i] * of);
            body.iter_mut().zip(&self.body[i]).for_each(|(body, of)| *body -= own[i] * of);
        }
    }

    /// The motion whose equations, with those of the next node and the constants, come down to `left`.
    pub(super) fn up(&self, left: &Tangent, next: &Tangent, body: &SVector<f64, P>) -> Tangent {
        let dot = |row: &[f64], of: &[f64]| row.iter().zip(of).map(|(a, b)| a * b).sum::<f64>();
        let mut own = Tangent::from_fn(|i, _| {
            left[i] - dot(&self.next[i], next.as_slice()) - dot(&self.body[i], body.as_slice())
        });
        for i in (0..MOTION).rev() {
            own[i] *= self.factor[i][i];
            for k in 0..i {
                own[k] -= self.factor[i][k] * own[i];
            }
        }
        own
    }

    /// The inverse of the node's own equations, and by what its motion falls with that of the next node and with the constants.
    pub(super) fn inverse(&self) -> (Transition, Transition, SMatrix<f64, MOTION, P>) {
        let inverse = inverse_factor(&self.factor);
        let own = product(&inverse, &inverse);
        let (next, body) = (product(&inverse, &self.next), product(&inverse, &self.body));
        let square = |rows: &Rows<MOTION, MOTION>| Transition::from_fn(|i, j| rows[i][j]);
        (square(&own), square(&next), SMatrix::from_fn(|i, j| body[i][j]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;

    /// Against a dense solve of two nodes and two constants.
    #[test]
    fn an_eliminated_chain_solves_its_equations() {
        const ALL: usize = 2 * MOTION + 2;
        let mut normal = Normal::seeded(5);
        let root = SMatrix::<f64, ALL, ALL>::from_fn(|_, _| normal.draw());
        let mut all = root * root.transpose() + SMatrix::identity();
        let gradient = SVector::<f64, ALL>::from_fn(|_, _| normal.draw());
        let block =
            |i: usize, j: usize| all.fixed_view::<MOTION, MOTION>(MOTION * i, MOTION * j).into_owned();
        let to_body = |i: usize| all.fixed_view::<MOTION, 2>(MOTION * i, 2 * MOTION).into_owned();
        let first = Eliminated::<2>::new(&block(0, 0), &block(0, 1), &to_body(0)).unwrap();
        let (mut own, mut constants) = (block(1, 1), to_body(1));
        let mut body = all.fixed_view::<2, 2>(2 * MOTION, 2 * MOTION).into_owned();
        first.lessen(&mut own, &mut constants, &mut body);
        let second = Eliminated::<2>::new(&own, &Transition::zeros(), &constants).unwrap();
        second.lessen(&mut Transition::zeros(), &mut SMatrix::zeros(), &mut body);

        let mut left: [Tangent; 2] =
            std::array::from_fn(|i| gradient.fixed_rows::<MOTION>(MOTION * i).into_owned());
        let mut of_body = gradient.fixed_rows::<2>(2 * MOTION).into_owned();
        let [a, b] = &mut left;
        first.down(a, b, &mut of_body);
        second.down(b, &mut Tangent::zeros(), &mut of_body);
        let constants = body.try_inverse().unwrap() * of_body;
        let last = second.up(&left[1], &Tangent::zeros(), &constants);
        let motion = first.up(&left[0], &last, &constants);

        let expected = all.cholesky().unwrap().solve(&gradient);
        let found = expected.fixed_rows::<MOTION>(0) - motion;
        assert!(found.norm() < 1e-9 * expected.norm(), "{found}");
        assert!((expected.fixed_rows::<MOTION>(MOTION) - last).norm() < 1e-9 * expected.norm());
        let (inverse, by_next, by_body) = first.inverse();
        assert!((inverse * block(0, 0) - Transition::identity()).norm() < 1e-9);
        assert!((block(0, 0) * by_next - block(0, 1)).norm() < 1e-9);
        assert!((block(0, 0) * by_body - to_body(0)).norm() < 1e-9);
        // Determinants of what is eliminated one after the other multiply.
        let chain = first.log_det() + second.log_det() + body.determinant().ln();
        assert!((chain - all.determinant().ln()).abs() < 1e-9, "{chain}");

        // What is not positive definite has no factor, nor has what is no number.
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            all[(3, 3)] = value;
            let own = all.fixed_view::<MOTION, MOTION>(0, 0).into_owned();
            assert!(Eliminated::<2>::new(&own, &own, &SMatrix::zeros()).is_none(), "{value}");
        }
    }
}
