//! Medians with stalls, ratios with intervals.

use exploration::Source;

/// The smallest of `values` that a `share` of them does not exceed; one that was not reached counts as infinite.
#[must_use]
pub fn quantile(values: &[Option<f64>], share: f64) -> f64 {
    let mut all: Vec<f64> = values.iter().map(|v| v.unwrap_or(f64::INFINITY)).collect();
    all.sort_by(f64::total_cmp);
    let at = (share * all.len() as f64).ceil() as usize;
    all.get(at.max(1) - 1).copied().unwrap_or(f64::NAN)
}

/// Median and 90 %, as tables show them; a dash for what was not reached.
#[must_use]
pub fn median_and_tail(values: &[Option<f64>], digits: usize) -> String {
    let one = |share: f64| match quantile(values, share) {
        v if v.is_finite() => format!("{v:.digits$}"),
        _ => "-".to_owned(),
    };
    format!("{} / {}", one(0.5), one(0.9))
}

/// Mean of `values`, with `cap` for those that were not reached.
#[must_use]
pub fn mean(values: &[Option<f64>], cap: f64) -> f64 {
    values.iter().map(|v| v.unwrap_or(cap)).sum::<f64>() / values.len() as f64
}

/// Resamples of a bootstrap.
const RESAMPLES: usize = 4000;

/// Ratio of the medians of `over` and `under`, with a 95 % interval: bodies drawn again, the same for both.
#[must_use]
pub fn ratio_of_medians(over: &[Option<f64>], under: &[Option<f64>]) -> (f64, [f64; 2]) {
    let ratio = |a: &[Option<f64>], b: &[Option<f64>]| quantile(a, 0.5) / quantile(b, 0.5);
    let mut source = Source::new(1);
    let mut ratios: Vec<Option<f64>> = Vec::with_capacity(RESAMPLES);
    for _ in 0..RESAMPLES {
        let drawn: Vec<usize> = over.iter().map(|_| (source.unit() * over.len() as f64) as usize).collect();
        let of = |values: &[Option<f64>]| drawn.iter().map(|k| values[*k]).collect::<Vec<_>>();
        ratios.push(Some(ratio(&of(over), &of(under))));
    }
    (ratio(over, under), [quantile(&ratios, 0.025), quantile(&ratios, 0.975)])
}

/// The exact 95 % interval of a probability of which `hits` of `runs` were seen (Clopper and Pearson, 1934).
#[must_use]
pub fn interval(hits: usize, runs: usize) -> [f64; 2] {
    // Probability of at most `k` hits at `p`, summed from logarithms.
    let at_most = |k: usize, p: f64| -> f64 {
        let (mut log, mut sum) = (runs as f64 * (1.0 - p).ln(), 0.0);
        for i in 0..=k {
            sum += log.exp();
            log += ((runs - i) as f64 / (i + 1) as f64).ln() + (p / (1.0 - p)).ln();
        }
        sum
    };
    let solve = |above: &dyn Fn(f64) -> bool| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if above(middle) { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    };
    let low = if hits == 0 { 0.0 } else { solve(&|p| 1.0 - at_most(hits - 1, p) > 0.025) };
    let high = if hits == runs { 1.0 } else { solve(&|p| at_most(hits, p) < 0.025) };
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_tables() {
        // Rule of three, and a case from tables: 5 of 50.
        assert!((interval(0, 1000)[1] - 0.003_682).abs() < 1e-5);
        let [low, high] = interval(5, 50);
        assert!((low - 0.033_3).abs() < 2e-4 && (high - 0.218_1).abs() < 2e-4, "{low} {high}");
    }

    #[test]
    fn what_was_not_reached_is_the_worst() {
        let values = [Some(3.0), None, Some(1.0), Some(2.0)];
        assert_eq!([quantile(&values, 0.5), quantile(&values, 0.75)], [2.0, 3.0]);
        assert_eq!(quantile(&values, 0.9), f64::INFINITY);
    }
}
