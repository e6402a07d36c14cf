//! Palm angles of a log with their rates and accelerations, at the samples and in the middle between them.

use super::model::PalmInstant;
use object_dynamics::planar::{PlanarSample, lagrange};

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
    let base = nodes[0].angles;
    let mut sums = [[0.0; 3]; 2];
    for node in nodes {
        let weight = lagrange(nodes.iter().map(|n| n.t), node.t, t);
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
