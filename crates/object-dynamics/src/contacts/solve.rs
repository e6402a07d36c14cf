//! A small dense system that may be singular in a harmless way.

use super::MOST_PALMS;

const N: usize = 3 * MOST_PALMS;

/// A pivot below this share of its row's largest entry is zero: exact zeros come out at some units of rounding times the
/// number of rows, true ones of constraints that hardly differ stay above.
const SMALLEST_PIVOT: f64 = 1e-11;
/// The same for singular values, which take the whole matrix as their scale.
const SMALLEST_SINGULAR: f64 = 1e-10;
/// Largest part of a sliding contact's force in a combination of forces that moves nothing.
const LARGEST_SHARE: f64 = 1e-6;

/// Matrix and right side; the leading `n` rows and columns are used.
pub(crate) struct Dense {
    pub(crate) matrix: [[f64; N]; N],
    pub(crate) right: [f64; N],
}

/// Unknowns, and whether there are no others.
pub(crate) struct Solved {
    pub(crate) x: [f64; N],
    pub(crate) unique: bool,
    /// By how much constraints that hang together contradict each other, as a share of the right sides.
    pub(crate) unmet: f64,
}

/// A mode set without forces: constraints that hang together while a contact slides, which is at a critical friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unsolvable;

impl Default for Dense {
    fn default() -> Self {
        Self { matrix: [[0.0; N]; N], right: [0.0; N] }
    }
}

impl Dense {
    /// Solves by elimination; where rows hang together, by singular values, if what is left free moves nothing: the unknowns
    /// `squeezes` alone, which are forces of sticking contacts against each other. Of those solutions the shortest.
    pub(crate) fn solve(&self, n: usize, squeezes: &[bool; N]) -> Result<Solved, Unsolvable> {
        match self.eliminate(n) {
            Some(x) => Ok(Solved { x, unique: true, unmet: 0.0 }),
            None => self.shortest(n, squeezes),
        }
    }

    /// Gaussian elimination with partial pivoting; none where a pivot is zero.
    pub(crate) fn eliminate(&self, n: usize) -> Option<[f64; N]> {
        let (mut m, mut x) = (self.matrix, self.right);
        let mut scales = [0.0; N];
        for r in 0..n {
            scales[r] = m[r][..n].iter().fold(0.0_f64, |s, v| s.max(v.abs()));
        }
        for k in 0..n {
            let mut pivot = k;
            for r in k + 1..n {
                if m[r][k].abs() * scales[pivot] > m[pivot][k].abs() * scales[r] {
                    pivot = r;
                }
            }
            let size = m[pivot][k].abs();
            if size.is_nan() || size <= SMALLEST_PIVOT * scales[pivot] {
                return None;
            }
            m.swap(k, pivot);
            x.swap(k, pivot);
            scales.swap(k, pivot);
            for r in k + 1..n {
                let factor = m[r][k] / m[k][k];
                if factor != 0.0 {
                    for c in k + 1..n {
                        m[r][c] -= factor * m[k][c];
                    }
                    x[r] -= factor * x[k];
                }
            }
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|c| m[k][c] * x[c]).sum();
            x[k] = (x[k] - known) / m[k][k];
        }
        Some(x)
    }

    fn shortest(&self, n: usize, squeezes: &[bool; N]) -> Result<Solved, Unsolvable> {
        let matrix = nalgebra::DMatrix::from_fn(n, n, |r, c| self.matrix[r][c]);
        let right = nalgebra::DVector::from_column_slice(&self.right[..n]);
        if !matrix.iter().chain(right.iter()).all(|v| v.is_finite()) {
            return Err(Unsolvable);
        }
        let svd = matrix.svd(true, true);
        let (Some(u), Some(v_t)) = (&svd.u, &svd.v_t) else { return Err(Unsolvable) };
        let largest = svd.singular_values.amax();
        let parts = u.transpose() * &right;
        let (mut x, mut unmet, mut unique) = (nalgebra::DVector::zeros(n), 0.0_f64, true);
        for k in 0..n {
            let direction = v_t.row(k);
            if svd.singular_values[k] > SMALLEST_SINGULAR * largest {
                x += direction.transpose() * (parts[k] / svd.singular_values[k]);
                continue;
            }
            unique = false;
            unmet = unmet.max(parts[k].abs());
            if (0..n).any(|c| !squeezes[c] && direction[c].abs() > LARGEST_SHARE) {
                return Err(Unsolvable);
            }
        }
        let mut result = [0.0; N];
        result[..n].copy_from_slice(x.as_slice());
        Ok(Solved { x: result, unique, unmet: unmet / right.amax().max(f64::MIN_POSITIVE) })
    }
}
