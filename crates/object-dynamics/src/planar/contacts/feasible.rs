//! Forces within cones where they are not unique: least distance programming.
//!
//! C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23: algorithms NNLS (23.10) and LDP
//! (23.27).

use super::respond::STEPS;
use nalgebra::{DMatrix, DVector};

/// Forces this many times the least ones are not looked for: a squeeze that large is no answer of a rigid body.
const LARGEST_SQUEEZE: f64 = 1e6;

/// Of the forces `least + null z` those nearest to `least` with `cones (least + null z) >= 0`; none where there are
/// none.
pub(super) fn within_cones(
    least: &DVector<f64>,
    null: &DMatrix<f64>,
    cones: &DMatrix<f64>,
) -> Option<DVector<f64>> {
    let slack = cones * least;
    if slack.iter().all(|&s| s >= 0.0) {
        return Some(least.clone());
    }
    let size = least.norm();
    let (free, count) = (null.ncols(), cones.nrows());
    // z of least size with G z >= h, in units of the least forces: the residual of a least-squares problem over u >=
    // 0.
    let g = cones * null;
    let e = DMatrix::from_fn(free + 1, count, |i, j| if i < free { g[(j, i)] } else { -slack[j] / size });
    let f = DVector::from_fn(free + 1, |i, _| f64::from(i == free));
    let residual = &e * non_negative(&e, &f)? - f;
    let last = -residual[free];
    // last = 1 / (1 + |z|^2).
    if last.is_nan() || last * (1.0 + LARGEST_SQUEEZE * LARGEST_SQUEEZE) < 1.0 {
        return None;
    }
    let z = DVector::from_fn(free, |i, _| residual[i] * size / last);
    Some(least + null * z)
}

/// `u >= 0` with the least `|a u - b|`.
fn non_negative(a: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    let count = a.ncols();
    let mut u = DVector::zeros(count);
    let mut passive = vec![false; count];
    let rounding = 16.0 * f64::EPSILON * a.norm() * b.norm();
    for _ in 0..4 * count {
        let gradient = a.transpose() * (b - a * &u);
        let best = (0..count)
            .filter(|&j| !passive[j] && gradient[j] > rounding)
            .max_by(|&i, &j| gradient[i].total_cmp(&gradient[j]));
        let Some(best) = best else { return Some(u) };
        passive[best] = true;
        loop {
            let trial = least_squares(a, b, &passive)?;
            let blocked = (0..count).filter(|&j| passive[j] && trial[j] <= 0.0);
            let shares = blocked.map(|j| (u[j] / (u[j] - trial[j]), j)).filter(|(share, _)| !share.is_nan());
            let Some((share, nearest)) = shares.min_by(|a, b| a.0.total_cmp(&b.0)) else {
                u = trial;
                break;
            };
            u += (&trial - &u) * share;
            // Whatever rounding leaves of it: one less each time, so that this ends.
            (passive[nearest], u[nearest]) = (false, 0.0);
            for j in 0..count {
                if passive[j] && u[j] <= f64::EPSILON * trial.amax() {
                    (passive[j], u[j]) = (false, 0.0);
                }
            }
            if !passive.contains(&true) {
                break;
            }
        }
    }
    Some(u)
}

/// Least-squares solution with all but the `passive` unknowns zero.
fn least_squares(a: &DMatrix<f64>, b: &DVector<f64>, passive: &[bool]) -> Option<DVector<f64>> {
    let chosen: Vec<usize> = (0..a.ncols()).filter(|&j| passive[j]).collect();
    let part = a.select_columns(&chosen);
    let limit = f64::EPSILON * part.norm();
    let solved = part.try_svd(true, true, f64::EPSILON, STEPS)?.solve(b, limit).ok()?;
    let mut full = DVector::zeros(a.ncols());
    for (k, &j) in chosen.iter().enumerate() {
        full[j] = solved[k];
    }
    Some(full)
}
