//! Errors of many runs against a bound.

use super::estimates::{Estimated, Other};

/// Errors of some runs, of the numbers that are counted.
pub(crate) struct Statistics {
    /// Root mean square error over the bound, geometric mean over the numbers.
    pub(crate) ratio: f64,
    /// Mean square of errors over deviations.
    pub(crate) square: f64,
    /// Half of the band about 1 in which that lies with 95 %.
    pub(crate) half_band: f64,
}

impl Statistics {
    /// None without runs or numbers.
    pub(crate) fn new(runs: &[&Estimated], bound: &Estimated, counted: &[usize]) -> Option<Self> {
        if runs.is_empty() || counted.is_empty() {
            return None;
        }
        let count = runs.len() as f64;
        let mean = |i: usize| runs.iter().map(|o| o.errors[i].powi(2)).sum::<f64>() / count;
        let logs: f64 = counted.iter().map(|&i| 0.5 * (mean(i) / bound.deviations[i].powi(2)).ln()).sum();
        let squares: f64 = counted
            .iter()
            .map(|&i| runs.iter().map(|o| (o.errors[i] / o.deviations[i]).powi(2)).sum::<f64>() / count)
            .sum();
        // The sum of squares of numbers with correlations C has the variance 2 |C|^2.
        let d = counted.len() as f64;
        let correlation: f64 = counted
            .iter()
            .flat_map(|&i| counted.iter().map(move |&j| (i, j)))
            .map(|(i, j)| (bound.covariance[i][j] / (bound.deviations[i] * bound.deviations[j])).powi(2))
            .sum();
        Some(Self {
            ratio: (logs / d).exp(),
            square: squares / d,
            half_band: 1.96 * (2.0 * correlation / count).sqrt() / d,
        })
    }
}

/// By how much the best estimator of a log that is of the true motion or of another one, as likely either, is beyond the bound:
/// geometric mean over the numbers, for the other motion that does most.
///
/// The motions are `d` deviations of the data apart. With each linear about itself, the mean squared error of the best
/// estimator is `bound^2 + D^2 E[p (1 - p)]`: `D` the distance of a number, `p` the probability that the data give to the one.
pub(crate) fn doubt(others: &[Other], bound: &Estimated, counted: &[usize]) -> Option<f64> {
    let of = |other: &Other| {
        let open = left_open(other.corrections);
        let log = |&i: &usize| 0.5 * (1.0 + open * (other.errors[i] / bound.deviations[i]).powi(2)).ln();
        (counted.iter().map(log).sum::<f64>() / counted.len() as f64).exp()
    };
    others.iter().map(of).reduce(f64::max).filter(|doubt| doubt.is_finite())
}

/// `E[p (1 - p)]` of two hypotheses that are equally likely and whose data are Gaussian, the root of `square` deviations apart.
fn left_open(square: f64) -> f64 {
    const REACH: f64 = 8.0;
    const STEPS: usize = 800;
    let step = 2.0 * REACH / STEPS as f64;
    let (square, d) = (square.max(0.0), square.max(0.0).sqrt());
    (0..STEPS)
        .map(|k| {
            let z = -REACH + (k as f64 + 0.5) * step;
            let p = 1.0 / (1.0 + (-(0.5 * square + d * z)).exp());
            p * (1.0 - p) * (-0.5 * z * z).exp() * step / std::f64::consts::TAU.sqrt()
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One motion is no doubt; the same one twice is half of each; motions far apart are told apart.
    #[test]
    fn doubt_is_what_the_data_leave() {
        assert!((left_open(0.0) - 0.25).abs() < 1e-12);
        assert!(left_open(100.0) < 1e-5);
        // The mean is the same under either: against that over both.
        let (d, step) = (1.5_f64, 1e-3);
        let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        let both: f64 = (-9000..11_000)
            .map(|k| {
                let x = f64::from(k) * step;
                let (a, b) = (density(x), density(x - d));
                0.5 * (a + b) * (a / (a + b)) * (b / (a + b)) * step
            })
            .sum();
        assert!((left_open(d * d) - both).abs() < 1e-6, "{} {both}", left_open(d * d));
    }
}
