//! Palm angles of a log with their rates and accelerations, at the samples and in the middle between them.

use super::shape_model::PalmInstant;
use object_dynamics::planar::PlanarSample;

/// Samples that a polynomial is laid through.
const NODES: usize = 6;

/// Palms at sample `k` (index `2 k`) and in the middle of the interval after it (index `2 k + 1`).
pub(super) fn palm_series(samples: &[PlanarSample]) -> Vec<PalmInstant> {
    let mut series = Vec::with_capacity(2 * samples.len());
    for k in 0..samples.len() {
        series.push(instant(samples, k, samples[k].t));
        if let Some(next) = samples.get(k + 1) {
            series.push(instant(samples, k, 0.5 * (samples[k].t + next.t)));
        }
    }
    series
}

/// Polynomial through the six samples nearest to interval `k`, differentiated twice.
fn instant(samples: &[PlanarSample], k: usize, t: f64) -> PalmInstant {
    let count = NODES.min(samples.len());
    let from = (k + 1).saturating_sub(count / 2).min(samples.len() - count);
    let nodes = &samples[from..from + count];
    let times: [f64; NODES] = std::array::from_fn(|i| nodes[i.min(count - 1)].t);
    let weights = derivative_weights(&times[..count], t);
    let base = nodes[0].angles;
    let mut sums = [[0.0; 3]; 2];
    for (node, weight) in nodes.iter().zip(&weights) {
        // Relative to the first node: the weights of the derivatives add up to zero, and large angles would cancel.
        let first = node.angles[0] - base[0];
        let second = first + node.angles[1] - base[1];
        for (sum, angle) in sums.iter_mut().zip([first, second]) {
            for (s, w) in sum.iter_mut().zip(weight) {
                *s += w * angle;
            }
        }
    }
    PalmInstant {
        angles: [base[0] + sums[0][0], base[0] + base[1] + sums[1][0]],
        rates: [sums[0][1], sums[1][1]],
        accelerations: [sums[0][2], sums[1][2]],
    }
}

/// Weights of value, first and second derivative at `t` for arbitrary nodes. B. Fornberg, Generation of finite difference
/// formulas on arbitrarily spaced grids, Math. Comp. 51 (1988) 699-706.
fn derivative_weights(nodes: &[f64], t: f64) -> [[f64; 3]; NODES] {
    let mut c = [[0.0; 3]; NODES];
    c[0][0] = 1.0;
    let (mut c1, mut c4) = (1.0, nodes[0] - t);
    for i in 1..nodes.len() {
        let (mut c2, c5) = (1.0, c4);
        c4 = nodes[i] - t;
        for j in 0..i {
            // Times of a log increase strictly.
            let c3 = nodes[i] - nodes[j];
            c2 *= c3;
            if j == i - 1 {
                for m in (0..3).rev() {
                    let lower = if m > 0 { m as f64 * c[i - 1][m - 1] } else { 0.0 };
                    c[i][m] = c1 * (lower - c5 * c[i - 1][m]) / c2;
                }
            }
            for m in (0..3).rev() {
                let lower = if m > 0 { m as f64 * c[j][m - 1] } else { 0.0 };
                c[j][m] = (c4 * c[j][m] - lower) / c3;
            }
        }
        c1 = c2;
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_five_are_exact() {
        let nodes = [0.0, 0.1, 0.25, 0.3, 0.5, 0.55];
        let weights = derivative_weights(&nodes, 0.27);
        for degree in 0..6 {
            let value = |t: f64| t.powi(degree);
            let n = f64::from(degree);
            let expected = [
                value(0.27),
                if degree > 0 { n * 0.27_f64.powi(degree - 1) } else { 0.0 },
                if degree > 1 { n * (n - 1.0) * 0.27_f64.powi(degree - 2) } else { 0.0 },
            ];
            for m in 0..3 {
                let sum: f64 = nodes.iter().zip(&weights).map(|(&t, w)| w[m] * value(t)).sum();
                assert!((sum - expected[m]).abs() < 1e-11, "degree {degree} derivative {m}");
            }
        }
    }
}
