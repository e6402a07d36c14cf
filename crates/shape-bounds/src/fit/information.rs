//! Least squares in square-root form, one row at a time.

use nalgebra::{DMatrix, DVector};

/// The triangle `R` and right-hand side `z` with `|R x - z|^2` equal, but for a constant, to the sum of squares of all rows taken so far.
///
/// Rows enter by Givens rotations (Golub and Van Loan, section 5.1), so that the condition number is that of the rows and
/// not its square, and one row costs O(p^2) whatever came before.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SquareRoot {
    count: usize,
    /// Row-major upper triangle with the right-hand side as last column.
    rows: Vec<Vec<f64>>,
}

impl SquareRoot {
    pub(crate) fn new(count: usize) -> Self {
        Self { count, rows: vec![vec![0.0; count + 1]; count] }
    }

    /// Takes `row[..p] . x = row[p]`; the row is used up.
    pub(crate) fn insert(&mut self, row: &mut [f64]) {
        for i in 0..self.count {
            if row[i] == 0.0 {
                continue;
            }
            let own = &mut self.rows[i];
            let length = (own[i] * own[i] + row[i] * row[i]).sqrt();
            if length == 0.0 {
                // Squares that underflow: too small beside anything to count.
                continue;
            }
            let (c, s) = (own[i] / length, row[i] / length);
            own[i] = length;
            for j in i + 1..=self.count {
                let (a, b) = (own[j], row[j]);
                own[j] = c * a + s * b;
                row[j] = c * b - s * a;
            }
        }
    }

    pub(crate) fn triangle(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.count, self.count, |i, j| if j < i { 0.0 } else { self.rows[i][j] })
    }

    pub(crate) fn right(&self) -> DVector<f64> {
        DVector::from_fn(self.count, |i, _| self.rows[i][self.count])
    }

    /// The solution, with `damping` times the square of each column's own length added to the normal equations; `None`
    /// where a pivot vanishes.
    pub(crate) fn solve(&self, damping: f64) -> Option<DVector<f64>> {
        let mut own = self.clone();
        if damping > 0.0 {
            let triangle = self.triangle();
            for j in 0..self.count {
                let mut row = vec![0.0; self.count + 1];
                row[j] = damping.sqrt() * triangle.column(j).norm();
                own.insert(&mut row);
            }
        }
        own.triangle().solve_upper_triangular(&own.right()).filter(|x| x.iter().all(|v| v.is_finite()))
    }

    /// What is known about parameters whose natural sizes are `scales`.
    pub(crate) fn knowledge(&self, scales: &DVector<f64>) -> Option<Knowledge> {
        let mut scaled = self.triangle();
        for (j, scale) in scales.iter().enumerate() {
            scaled.column_mut(j).scale_mut(*scale);
        }
        if scaled.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let svd = scaled.svd(false, true);
        let right = svd.v_t?;
        let largest = svd.singular_values.max();
        let rank = svd.singular_values.iter().filter(|s| **s > RANK * largest).count();
        let weakest = svd.singular_values.imin();
        Some(Knowledge {
            rank,
            condition: largest / svd.singular_values[weakest],
            weakest_deviation: svd.singular_values[weakest].recip(),
            weakest_parameter: right.row(weakest).transpose().iamax(),
        })
    }

    /// `R^-1`; `None` where a pivot vanishes.
    pub(crate) fn inverse(&self) -> Option<DMatrix<f64>> {
        let inverse = self.triangle().solve_upper_triangular(&DMatrix::identity(self.count, self.count))?;
        inverse.iter().all(|v| v.is_finite()).then_some(inverse)
    }
}

/// Singular values below this share of the largest are rounding.
const RANK: f64 = 1e-11;

/// Which parameters the rows determine, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Knowledge {
    pub(crate) rank: usize,
    /// Condition number of the triangle in scaled parameters.
    pub(crate) condition: f64,
    /// Standard deviation of the least determined combination of scaled parameters.
    pub(crate) weakest_deviation: f64,
    /// The parameter with the largest share in it.
    pub(crate) weakest_parameter: usize,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::Source;

    #[test]
    fn rows_one_at_a_time_agree_with_the_normal_equations() {
        let mut s = Source::new(1);
        let rows = DMatrix::from_fn(40, 6, |_, _| s.normal());
        let right = DVector::from_fn(40, |_, _| s.normal());
        let mut root = SquareRoot::new(6);
        for i in 0..40 {
            let mut row: Vec<f64> = rows.row(i).iter().copied().collect();
            row.push(right[i]);
            root.insert(&mut row);
        }
        let information = rows.transpose() * &rows;
        let x = information.clone().cholesky().unwrap().solve(&(rows.transpose() * &right));
        assert!((root.solve(0.0).unwrap() - &x).norm() < 1e-13);
        let inverse = root.inverse().unwrap();
        assert!((&inverse * inverse.transpose() * &information - DMatrix::identity(6, 6)).norm() < 1e-13);
        // Damping is Levenberg's with Marquardt's scaling.
        let damped = &information + DMatrix::from_diagonal(&information.diagonal()) * 0.3;
        let expected = damped.cholesky().unwrap().solve(&(rows.transpose() * &right));
        assert!((root.solve(0.3).unwrap() - expected).norm() < 1e-13);
    }

    #[test]
    fn a_combination_that_no_row_sees_is_found() {
        let mut s = Source::new(2);
        let mut root = SquareRoot::new(3);
        for _ in 0..20 {
            let (a, b) = (s.normal(), s.normal());
            // Nothing along (0, 1, -1).
            root.insert(&mut [a, b, b, s.normal()]);
        }
        let known = root.knowledge(&DVector::from_element(3, 1.0)).unwrap();
        assert_eq!(known.rank, 2);
        assert!(known.weakest_parameter > 0 && known.condition > 1e12);
    }
}
