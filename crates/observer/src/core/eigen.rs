//! Eigenvalues of small symmetric matrices.

use nalgebra::{SMatrix, SVector};

/// Sweeps of Jacobi's method; convergence is quadratic and takes at most about ten for any size used here.
const SWEEPS: usize = 40;

/// Eigenvalues in ascending order and, as columns, their unit eigenvectors.
pub(super) struct Eigen<const N: usize> {
    pub(super) values: SVector<f64, N>,
    pub(super) vectors: SMatrix<f64, N, N>,
}

/// Cyclic Jacobi rotations. Chosen over a reduction to tridiagonal form because it keeps small eigenvalues of a graded
/// positive matrix to high relative accuracy, and these are what observability is about.
/// G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., section 8.5.
pub(super) fn symmetric_eigen<const N: usize>(matrix: &SMatrix<f64, N, N>) -> Eigen<N> {
    let mut a = *matrix;
    let mut v = SMatrix::<f64, N, N>::identity();
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..N {
            for q in p + 1..N {
                rotated |= rotate(&mut a, &mut v, p, q);
            }
        }
        if !rotated {
            break;
        }
    }
    sorted(&a, &v)
}

/// Makes entry `(p, q)` zero; false where it is already negligible against its diagonal entries.
fn rotate<const N: usize>(
    a: &mut SMatrix<f64, N, N>,
    v: &mut SMatrix<f64, N, N>,
    p: usize,
    q: usize,
) -> bool {
    let off = a[(p, q)];
    let size = (a[(p, p)] * a[(q, q)]).abs().sqrt();
    if off == 0.0 || off.is_nan() || off.abs() <= f64::EPSILON * size {
        return false;
    }
    let tau = (a[(q, q)] - a[(p, p)]) / (2.0 * off);
    let t = tau.signum() / (tau.abs() + (tau * tau + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for k in 0..N {
        let (x, y) = (a[(k, p)], a[(k, q)]);
        (a[(k, p)], a[(k, q)]) = (c * x - s * y, s * x + c * y);
    }
    for k in 0..N {
        let (x, y) = (a[(p, k)], a[(q, k)]);
        (a[(p, k)], a[(q, k)]) = (c * x - s * y, s * x + c * y);
        let (x, y) = (v[(k, p)], v[(k, q)]);
        (v[(k, p)], v[(k, q)]) = (c * x - s * y, s * x + c * y);
    }
    (a[(p, q)], a[(q, p)]) = (0.0, 0.0);
    true
}

fn sorted<const N: usize>(a: &SMatrix<f64, N, N>, v: &SMatrix<f64, N, N>) -> Eigen<N> {
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    order.sort_unstable_by(|&i, &j| a[(i, i)].total_cmp(&a[(j, j)]));
    let values = SVector::from_fn(|i, _| a[(order[i], order[i])]);
    Eigen { values, vectors: SMatrix::from_fn(|i, j| v[(i, order[j])]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn eigenpairs_rebuild_the_matrix(entries in proptest::collection::vec(-1.0..1.0f64, 36)) {
            let b = SMatrix::<f64, 6, 6>::from_column_slice(&entries);
            let a = b.transpose() * b;
            let e = symmetric_eigen(&a);
            let back = e.vectors * SMatrix::from_diagonal(&e.values) * e.vectors.transpose();
            prop_assert!((back - a).abs().max() < 1e-14 * a.abs().max().max(1.0) * 10.0);
            prop_assert!((1..6).all(|i| e.values[i - 1] <= e.values[i]));
        }
    }

    /// A graded matrix D A D with D = diag(1, 1e-5, 1e-10): its small eigenvalues to 1e-12 relative, checked by the
    /// determinant, which is exact by construction.
    #[test]
    fn small_eigenvalues_of_graded_matrices_are_accurate() {
        let a = SMatrix::<f64, 3, 3>::new(2.0, 1.0, 0.5, 1.0, 2.0, 1.0, 0.5, 1.0, 2.0);
        let d = SMatrix::<f64, 3, 3>::from_diagonal(&SVector::<f64, 3>::new(1.0, 1e-5, 1e-10));
        let e = symmetric_eigen(&(d * a * d));
        let determinant = 4.5 * 1e-30;
        assert!((e.values.product() / determinant - 1.0).abs() < 1e-12, "{}", e.values.product());
    }
}
