//! Symmetric positive definite equations with few entries near the diagonal.

/// The lower triangle of a symmetric matrix, each row from its first entry that may be other than zero to the diagonal.
///
/// Cholesky's factor has its entries within the same rows (Jennings 1966).
#[derive(Clone, Debug)]
pub(super) struct Envelope {
    /// Column of the first entry of each row.
    first: Vec<usize>,
    /// Where each row begins in `values`, and the end of the last.
    start: Vec<usize>,
    values: Vec<f64>,
}

impl Envelope {
    /// All zero, with rows from these columns on.
    pub(super) fn zeros(first: Vec<usize>) -> Self {
        let mut start = vec![0];
        let mut end = 0;
        for (row, column) in first.iter().enumerate() {
            end += row + 1 - column;
            start.push(end);
        }
        Self { first, start, values: vec![0.0; end] }
    }

    /// Number of rows.
    pub(super) fn order(&self) -> usize {
        self.first.len()
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.values[self.start[i]..self.start[i + 1]]
    }

    /// Adds to the entry in row `i` and column `j`, which is not beyond the diagonal.
    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        self.values[self.start[i] + j - self.first[i]] += value;
    }

    /// The same matrix times a number.
    pub(super) fn times(&self, factor: f64) -> Self {
        let values = self.values.iter().map(|v| v * factor).collect();
        Self { values, ..self.clone() }
    }

    /// Cholesky's factor; `None` where a pivot is not above zero: the matrix is not definite but for rounding.
    pub(super) fn factor(mut self) -> Option<Factor> {
        for i in 0..self.order() {
            let (done, current) = self.values.split_at_mut(self.start[i]);
            let own = &mut current[..self.start[i + 1] - self.start[i]];
            for j in self.first[i]..i {
                let other = &done[self.start[j]..self.start[j + 1]];
                let from = self.first[i].max(self.first[j]);
                let sum = dot(&own[from - self.first[i]..j - self.first[i]], &other[from - self.first[j]..]);
                let k = j - self.first[i];
                own[k] = (own[k] - sum) / other[j - self.first[j]];
            }
            let (diagonal, left) = own.split_last_mut()?;
            let pivot = *diagonal - dot(left, left);
            if pivot.is_nan() || pivot <= *diagonal * (16.0 * f64::EPSILON) {
                return None;
            }
            *diagonal = pivot.sqrt();
        }
        Some(Factor(self))
    }
}

/// Cholesky's factor of an [`Envelope`].
#[derive(Clone, Debug)]
pub(super) struct Factor(Envelope);

impl Factor {
    /// The solution of `L z = b`, whose squared length is `b' (L L')^-1 b`.
    pub(super) fn half(&self, mut b: Vec<f64>) -> Vec<f64> {
        let begin = b.iter().position(|v| *v != 0.0).unwrap_or(b.len());
        for i in begin..b.len() {
            let Some((diagonal, left)) = self.0.row(i).split_last() else { continue };
            b[i] = (b[i] - dot(left, &b[self.0.first[i]..i])) / diagonal;
        }
        b
    }

    /// The solution of `L L' x = b`.
    pub(super) fn solve(&self, b: Vec<f64>) -> Vec<f64> {
        let mut x = self.half(b);
        for i in (0..x.len()).rev() {
            let Some((diagonal, left)) = self.0.row(i).split_last() else { continue };
            x[i] /= diagonal;
            let (before, at) = x.split_at_mut(i);
            before[self.0.first[i]..].iter_mut().zip(left).for_each(|(x, l)| *x -= l * at[0]);
        }
        x
    }
}

/// In eight sums, which the processor makes at once.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (heads, others) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest = heads.remainder().iter().zip(&b[a.len() - a.len() % 8..]).map(|(a, b)| a * b).sum::<f64>();
    let mut sums = [0.0; 8];
    for (a, b) in heads.zip(others) {
        (0..8).for_each(|k| sums[k] += a[k] * b[k]);
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_solution_is_found_and_a_singular_matrix_refused() {
        let first: Vec<usize> =
            (0..40_usize).map(|i| if i == 39 { 0 } else { i.saturating_sub(11) }).collect();
        let mut matrix = Envelope::zeros(first.clone());
        let entry = |i: usize, j: usize| if i == j { 30.0 } else { ((3 * i + 7 * j) % 5) as f64 - 2.0 };
        let planted: Vec<f64> = (0..40).map(|i| f64::from(i % 7) - 3.0).collect();
        let mut right = vec![0.0; 40];
        for i in 0..40 {
            for j in first[i]..=i {
                matrix.add(i, j, entry(i, j));
                right[i] += entry(i, j) * planted[j];
                if i != j {
                    right[j] += entry(i, j) * planted[i];
                }
            }
        }
        let found = matrix.factor().unwrap().solve(right);
        assert!(found.iter().zip(&planted).all(|(a, b)| (a - b).abs() < 1e-13));
        let mut ones = Envelope::zeros(vec![0; 3]);
        (0..3).for_each(|i| (0..=i).for_each(|j| ones.add(i, j, 1.0)));
        assert!(ones.factor().is_none());
    }
}
