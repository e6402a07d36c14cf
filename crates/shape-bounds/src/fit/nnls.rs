//! Least squares under inequalities.

use nalgebra::{DMatrix, DVector};

/// Gradients below this share of their largest possible size are zero.
const OPTIMAL: f64 = 1e-10;

/// `min |E u - f|` over `u >= 0`, and the residual `E u - f`; Lawson and Hanson, "Solving least squares problems", 1974,
/// algorithm 23.10. `None` if it does not end, which rounding can bring about.
fn nonnegative(e: &DMatrix<f64>, f: &DVector<f64>) -> Option<(DVector<f64>, DVector<f64>)> {
    let count = e.ncols();
    let mut u = DVector::zeros(count);
    let mut passive: Vec<usize> = Vec::new();
    let limit = OPTIMAL * e.norm().max(f64::MIN_POSITIVE) * f.norm();
    for _ in 0..10 * count.max(10) {
        let gradient = e.transpose() * (f - e * &u);
        let entering = (0..count)
            .filter(|j| !passive.contains(j))
            .max_by(|i, j| gradient[*i].total_cmp(&gradient[*j]))
            .filter(|j| gradient[*j] > limit);
        let Some(entering) = entering else {
            let residual = e * &u - f;
            return Some((u, residual));
        };
        passive.push(entering);
        loop {
            let columns = DMatrix::from_fn(e.nrows(), passive.len(), |i, k| e[(i, passive[k])]);
            let z = columns.svd(true, true).solve(f, 1e-14).ok()?;
            if z.iter().all(|v| *v > 0.0) {
                u.fill(0.0);
                passive.iter().zip(&z).for_each(|(j, v)| u[*j] = *v);
                break;
            }
            let ratio = |k: usize| u[passive[k]] / (u[passive[k]] - z[k]);
            let step = (0..passive.len()).filter(|k| z[*k] <= 0.0).map(ratio).fold(1.0, f64::min);
            let step = if step.is_finite() { step } else { 0.0 };
            for (k, j) in passive.iter().enumerate() {
                u[*j] += step * (z[k] - u[*j]);
            }
            let least = (0..passive.len())
                .filter(|k| z[*k] <= 0.0)
                .min_by(|a, b| u[passive[*a]].total_cmp(&u[passive[*b]]))?;
            u[passive[least]] = 0.0;
            passive.retain(|j| u[*j] > 0.0);
            if passive.is_empty() {
                u.fill(0.0);
                break;
            }
        }
    }
    None
}

/// The shortest `x` with `G x >= h`, and how many of the inequalities hold it; `None` if there is none (Lawson and Hanson,
/// algorithm 23.27).
pub(crate) fn least_distance(g: &DMatrix<f64>, h: &DVector<f64>) -> Option<(DVector<f64>, usize)> {
    let (rows, columns) = g.shape();
    // Inequalities of unit length, so that the test of optimality is even-handed.
    let lengths: Vec<f64> = (0..rows).map(|i| g.row(i).norm().max(f64::MIN_POSITIVE)).collect();
    let scale = (0..rows).map(|i| (h[i] / lengths[i]).abs()).fold(0.0, f64::max);
    if scale == 0.0 {
        return Some((DVector::zeros(columns), 0));
    }
    let e = DMatrix::from_fn(columns + 1, rows, |i, j| {
        if i < columns { g[(j, i)] / lengths[j] } else { h[j] / lengths[j] / scale }
    });
    let mut f = DVector::zeros(columns + 1);
    f[columns] = 1.0;
    let (u, residual) = nonnegative(&e, &f)?;
    if residual.norm() <= 1e-9 {
        return None;
    }
    let last = residual[columns];
    let x = DVector::from_fn(columns, |i, _| -residual[i] / last * scale);
    x.iter().all(|v| v.is_finite()).then(|| (x, u.iter().filter(|v| **v > 0.0).count()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::Source;

    #[test]
    fn the_shortest_point_satisfies_the_conditions_of_kuhn_and_tucker() {
        let mut s = Source::new(5);
        for _ in 0..200 {
            let (rows, columns) = (3 + s.below(12), 2 + s.below(6));
            let g = DMatrix::from_fn(rows, columns, |_, _| s.normal());
            let inside = DVector::from_fn(columns, |_, _| s.normal());
            let h = &g * &inside - DVector::from_fn(rows, |_, _| s.unit());
            let (x, _) = least_distance(&g, &h).unwrap();
            let slack = &g * &x - &h;
            assert!(slack.min() > -1e-9, "{}", slack.min());
            // x is a combination, with weights of at least zero, of the rows that are tight: its distance from their
            // cone vanishes.
            let tight: Vec<usize> = (0..rows).filter(|i| slack[*i] < 1e-8).collect();
            if tight.is_empty() {
                assert!(x.norm() < 1e-9);
                continue;
            }
            let cone = DMatrix::from_fn(columns, tight.len(), |i, k| g[(tight[k], i)]);
            let (_, residual) = nonnegative(&cone, &x).unwrap();
            assert!(residual.norm() < 1e-8, "{}", residual.norm());
        }
    }

    #[test]
    fn contradictory_inequalities_have_no_point() {
        let g = DMatrix::from_row_slice(2, 1, &[1.0, -1.0]);
        assert!(least_distance(&g, &DVector::from_column_slice(&[1.0, 1.0])).is_none());
        assert!(least_distance(&g, &DVector::from_column_slice(&[1.0, -2.0])).is_some());
    }
}
