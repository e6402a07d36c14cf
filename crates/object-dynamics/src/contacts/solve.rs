//! A small dense system that may be singular in a harmless way.

use super::MOST_PALMS;

const N: usize = 3 * MOST_PALMS;

/// A pivot below this share of its row's largest entry is zero: exact zeros come out at some units of rounding times the
/// number of rows, true ones of constraints that hardly differ stay above.
const SMALLEST_PIVOT: f64 = 1e-11;
/// The same for singular values, which take the whole matrix as their scale.
const SMALLEST_SINGULAR: f64 = 1e-10;
/// Sweeps of rotations: they converge quadratically, in six to ten.
const MOST_SWEEPS: u32 = 30;
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

    /// The shortest of the solutions that come nearest to the right sides.
    fn shortest(&self, n: usize, squeezes: &[bool; N]) -> Result<Solved, Unsolvable> {
        let all = self.matrix[..n].iter().flat_map(|row| &row[..n]).chain(&self.right[..n]);
        if !all.into_iter().all(|v| v.is_finite()) {
            return Err(Unsolvable);
        }
        let (images, directions) = self.orthogonal_images(n);
        let lengths: [f64; N] = std::array::from_fn(|k| dot(&images[k], &images[k], n).sqrt());
        let largest = lengths[..n].iter().fold(0.0_f64, |m, v| m.max(*v));
        let (mut x, mut unmet, mut unique) = ([0.0; N], self.right, true);
        for k in 0..n {
            if lengths[k] > SMALLEST_SINGULAR * largest {
                let share = dot(&images[k], &self.right, n) / (lengths[k] * lengths[k]);
                for c in 0..n {
                    x[c] += share * directions[k][c];
                    unmet[c] -= share * images[k][c];
                }
                continue;
            }
            unique = false;
            if (0..n).any(|c| !squeezes[c] && directions[k][c].abs() > LARGEST_SHARE) {
                return Err(Unsolvable);
            }
        }
        let size = |v: &[f64; N]| v[..n].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        Ok(Solved { x, unique, unmet: size(&unmet) / size(&self.right).max(f64::MIN_POSITIVE) })
    }

    /// Orthogonal directions of the unknowns whose images under the matrix are orthogonal as well: its singular vectors, by
    /// one-sided Jacobi rotations (Golub and Van Loan, 4th ed., 8.6.3). They are exact to rounding also where the rank is not
    /// full; the bidiagonal method of a library left 1e-3 of the right sides unmet there.
    fn orthogonal_images(&self, n: usize) -> ([[f64; N]; N], [[f64; N]; N]) {
        let (mut images, mut directions) = ([[0.0; N]; N], [[0.0; N]; N]);
        for k in 0..n {
            directions[k][k] = 1.0;
            for r in 0..n {
                images[k][r] = self.matrix[r][k];
            }
        }
        let size = images[..n].iter().map(|v| dot(v, v, n)).sum::<f64>();
        for _ in 0..MOST_SWEEPS {
            let mut turned = false;
            for p in 0..n {
                for q in p + 1..n {
                    let [a, b] = [p, q].map(|k| dot(&images[k], &images[k], n));
                    let c = dot(&images[p], &images[q], n);
                    // What is below rounding of the largest stays as it is.
                    if c.abs() <= f64::EPSILON * ((a * b).sqrt() + f64::EPSILON * size) {
                        continue;
                    }
                    turned = true;
                    let zeta = (b - a) / (2.0 * c);
                    let tangent = zeta.signum() / (zeta.abs() + (zeta * zeta + 1.0).sqrt());
                    let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                    rotate(&mut images, (p, q), cosine, tangent * cosine, n);
                    rotate(&mut directions, (p, q), cosine, tangent * cosine, n);
                }
            }
            if !turned {
                break;
            }
        }
        (images, directions)
    }
}

fn dot(a: &[f64; N], b: &[f64; N], n: usize) -> f64 {
    a[..n].iter().zip(b).map(|(a, b)| a * b).sum()
}

fn rotate(vectors: &mut [[f64; N]; N], (p, q): (usize, usize), cosine: f64, sine: f64, n: usize) {
    for r in 0..n {
        let (a, b) = (vectors[p][r], vectors[q][r]);
        (vectors[p][r], vectors[q][r]) = (cosine * a - sine * b, sine * a + cosine * b);
    }
}
