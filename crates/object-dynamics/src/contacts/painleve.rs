//! Where rigid bodies with friction have no motion, or more than one.

/// The smallest principal minor of a matrix, each divided by the product of its diagonal entries' sizes in `scale`.
///
/// A matrix all of whose principal minors are positive (a P-matrix) makes the unilateral problem of its sliding contacts
/// solvable in exactly one way. At most 31 minors.
pub(crate) fn smallest_minor(matrix: &[Vec<f64>], scale: &[f64]) -> f64 {
    let n = matrix.len();
    let mut smallest = f64::INFINITY;
    for subset in 1_u32..(1 << n) {
        let chosen: Vec<usize> = (0..n).filter(|i| subset & (1 << i) != 0).collect();
        let size: f64 = chosen.iter().map(|&i| scale[i]).product();
        let minor =
            nalgebra::DMatrix::from_fn(chosen.len(), chosen.len(), |r, c| matrix[chosen[r]][chosen[c]]);
        smallest = smallest.min(minor.determinant() / size);
    }
    smallest
}
