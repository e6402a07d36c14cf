//! Contacts that stand out of their own curve.

use super::model::NoisyContact;
use super::quantile;
use crate::median::median;
use glam::DVec3;

/// Median length of a vector of three standard normals.
const MEDIAN_LENGTH: f64 = 1.538_172_25;

/// Contacts on either side that tell how much the curve bends.
const REACH: usize = 10;

/// Contacts of `curve` whose point or normal departs from the line between its neighbours by more than noise does, with
/// the number of standard deviations, where noise fails to explain as much with probability `alpha` for the whole curve.
///
/// How much the curve itself bends is taken from the median over neighbours and over the whole: contacts that are not in
/// any order stand out nowhere.
pub(super) fn standing_out(curve: &[NoisyContact], alpha: f64) -> Vec<(usize, f64)> {
    let limit = quantile::length3(alpha / (2 * curve.len().max(1)) as f64);
    // Where the noise of points has two directions, as on a surface, half of the trace is the variance of each.
    let of_point = |c: &NoisyContact| {
        let m = c.noise.point;
        (c.contact.point, 0.5 * (m.x_axis.x + m.y_axis.y + m.z_axis.z))
    };
    let of_normal = |c: &NoisyContact| (c.contact.normal.get(), c.noise.normal.powi(2));
    let series = [
        Series::new(curve.iter().map(of_point).collect()),
        Series::new(curve.iter().map(of_normal).collect()),
    ];
    let mut left: Vec<usize> = (0..curve.len()).collect();
    let mut found = Vec::new();
    // First what no pair of neighbours predicts, so that the neighbours of a large outlier are not blamed for it; then
    // what departs from the line between its neighbours, which is the sharper test.
    for predictions in [&PAIRS[..], &PAIRS[..1]] {
        drop_worst(&mut left, &mut found, limit, |left, k| {
            let of_pair = |[a, b]: &[isize; 2]| {
                let neighbour = |offset: isize| left.get(k.checked_add_signed(offset)?).copied();
                let (a, b) = (neighbour(*a)?, neighbour(*b)?);
                Some(series.iter().map(|s| s.score(left[k], a, b)).fold(0.0, f64::max))
            };
            predictions.iter().filter_map(of_pair).reduce(f64::min).unwrap_or(0.0)
        });
    }
    found
}

/// Neighbours from which a contact is predicted by a straight line: on both sides, then two on one side.
const PAIRS: [[isize; 2]; 3] = [[-1, 1], [1, 2], [-1, -2]];

/// Takes out the contact of highest score until none is above the limit.
fn drop_worst(
    left: &mut Vec<usize>,
    found: &mut Vec<(usize, f64)>,
    limit: f64,
    score: impl Fn(&[usize], usize) -> f64,
) {
    let mut scores: Vec<f64> = (0..left.len()).map(|k| score(left, k)).collect();
    while let Some((k, worst)) = scores.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) {
        if worst <= limit {
            break;
        }
        found.push((left.remove(k), worst));
        scores.remove(k);
        // What stood beside it is judged anew.
        for near in k.saturating_sub(2)..(k + 2).min(left.len()) {
            scores[near] = score(left, near);
        }
    }
}

/// Values along a curve, their variances per axis, and how much they bend from one to the next, noise included.
struct Series {
    values: Vec<(DVec3, f64)>,
    typical: Vec<f64>,
}

impl Series {
    fn new(values: Vec<(DVec3, f64)>) -> Self {
        let bends: Vec<f64> =
            values.windows(3).map(|w| (0.5 * (w[0].0 + w[2].0) - w[1].0).length()).collect();
        let whole = median(&mut bends.clone());
        let typical = (0..values.len())
            .map(|k| {
                let near = k.saturating_sub(REACH + 1)..(k + REACH).min(bends.len());
                whole.max(median(&mut bends.get(near).unwrap_or_default().to_vec())) / MEDIAN_LENGTH
            })
            .collect();
        Self { values, typical }
    }

    /// Departure of `k` from the line through `a` and `b`, in standard deviations.
    fn score(&self, k: usize, a: usize, b: usize) -> f64 {
        let (to_a, to_b) = (a as f64 - k as f64, b as f64 - k as f64);
        let (first, last) = (to_b / (to_b - to_a), -to_a / (to_b - to_a));
        let (x, y, z) = (self.values[a], self.values[k], self.values[b]);
        let departure = (first * x.0 + last * z.0 - y.0).length();
        let noise = (first * first * x.1 + y.1 + last * last * z.1).sqrt();
        // The departure of a curve is its bend times both distances.
        let deviation = noise.max(self.typical[k] * (to_a * to_b).abs());
        if deviation > 0.0 { departure / deviation } else { 0.0 }
    }
}
