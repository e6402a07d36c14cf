//! Errors of many runs against a bound.

use super::estimates::Estimated;

/// Independent numbers that those of one run are worth.
const WORTH: f64 = 3.0;

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
    pub(crate) fn new(runs: &[&Estimated], bound: &[f64], counted: &[usize]) -> Option<Self> {
        if runs.is_empty() || counted.is_empty() {
            return None;
        }
        let count = runs.len() as f64;
        let mean = |i: usize| runs.iter().map(|o| o.errors[i].powi(2)).sum::<f64>() / count;
        let logs: f64 = counted.iter().map(|&i| 0.5 * (mean(i) / bound[i].powi(2)).ln()).sum();
        let squares: f64 = counted
            .iter()
            .map(|&i| runs.iter().map(|o| (o.errors[i] / o.deviations[i]).powi(2)).sum::<f64>() / count)
            .sum();
        let d = counted.len() as f64;
        Some(Self {
            ratio: (logs / d).exp(),
            square: squares / d,
            half_band: 1.96 * (2.0 / (WORTH.min(d) * count)).sqrt(),
        })
    }
}
