//! Triangular factors of small matrices: what every estimate spends its time in.
//!
//! Rows are kept as arrays, so that each loop runs over neighbours in memory.

use nalgebra::SMatrix;

/// Rows of a matrix of `M` by `N`.
pub(super) type Rows<const M: usize, const N: usize> = [[f64; N]; M];

/// Lower Cholesky factor with the reciprocals of its diagonal, of a symmetric matrix of which the lower half is read; None where there
/// is none.
pub(super) fn factor<const M: usize>(of: &SMatrix<f64, M, M>) -> Option<Rows<M, M>> {
    let mut rows = [[0.0; M]; M];
    for i in 0..M {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| rows[i][k] * rows[j][k]).sum();
            let left = of[(i, j)] - sum;
            rows[i][j] = if i == j { left.sqrt().recip() } else { left * rows[j][j] };
        }
        // Of what is not above zero the root is no number, or has no reciprocal; that of infinity is zero.
        if !(rows[i][i] > 0.0 && rows[i][i].is_finite()) {
            return None;
        }
    }
    Some(rows)
}

/// The factor's inverse times rows, in place.
pub(super) fn forward<const M: usize, const N: usize>(factor: &Rows<M, M>, rows: &mut Rows<M, N>) {
    for i in 0..M {
        let (before, from) = rows.split_at_mut(i);
        let own = &mut from[0];
        for (k, row) in before.iter().enumerate() {
            add(own, -factor[i][k], row);
        }
        own.iter_mut().for_each(|x| *x *= factor[i][i]);
    }
}

/// The inverse of what the factor is of.
pub(super) fn inverse<const M: usize>(factor: &Rows<M, M>) -> SMatrix<f64, M, M> {
    let rows = inverse_factor(factor);
    let product = product(&rows, &rows);
    SMatrix::from_fn(|i, j| product[i][j])
}

/// The inverse of the factor.
pub(super) fn inverse_factor<const M: usize>(factor: &Rows<M, M>) -> Rows<M, M> {
    let mut inverse = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    forward(factor, &mut inverse);
    inverse
}

/// The square of a vector by the inverse of what the factor is of.
pub(super) fn length_squared<const M: usize>(factor: &Rows<M, M>, of: [f64; M]) -> f64 {
    let mut column = of.map(|x| [x]);
    forward(factor, &mut column);
    column.iter().map(|[x]| x * x).sum()
}

/// The transpose of the one times the other.
pub(super) fn product<const M: usize, const A: usize, const B: usize>(
    a: &Rows<M, A>,
    b: &Rows<M, B>,
) -> Rows<A, B> {
    let mut sums = [[0.0; B]; A];
    for (a, b) in a.iter().zip(b) {
        sums.iter_mut().zip(a).for_each(|(sum, a)| add(sum, *a, b));
    }
    sums
}

/// Adds a multiple of a row.
fn add<const N: usize>(to: &mut [f64; N], factor: f64, row: &[f64; N]) {
    to.iter_mut().zip(row).for_each(|(to, x)| *to += factor * x);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;
    use nalgebra::Matrix6;

    #[test]
    fn a_factor_gives_the_inverse_and_squares() {
        let mut normal = Normal::seeded(8);
        let root = Matrix6::from_fn(|_, _| normal.draw());
        let matrix = root * root.transpose() + Matrix6::identity();
        let factor = factor(&matrix).unwrap();
        let inverse = inverse(&factor);
        assert!((inverse * matrix - Matrix6::identity()).amax() < 1e-13);
        let vector: [f64; 6] = std::array::from_fn(|_| normal.draw());
        let of = nalgebra::Vector6::from(vector);
        assert!((length_squared(&factor, vector) - (inverse * of).dot(&of)).abs() < 1e-13);
    }
}
