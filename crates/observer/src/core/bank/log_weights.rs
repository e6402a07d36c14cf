//! Sums of probabilities that are kept as logarithms.

/// Logarithm of the sum of exponentials, safe from under- and overflow; minus infinity of none.
pub(super) fn log_sum_exp(logs: impl Iterator<Item = f64> + Clone) -> f64 {
    let (largest, rest) = log_sum(logs);
    largest + rest
}

/// The same in two parts, the largest logarithm and what the others add to it. To divide by the sum, subtract one after the
/// other: beside a very large one the other would be lost.
pub(super) fn log_sum(logs: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let largest = logs.clone().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return (largest, 0.0);
    }
    (largest, logs.map(|l| (l - largest).exp()).sum::<f64>().ln())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_beyond_the_range_of_numbers() {
        let shifted = |by: f64| log_sum_exp([by + 2.0_f64.ln(), by + 3.0_f64.ln()].into_iter());
        assert!((shifted(0.0) - 5.0_f64.ln()).abs() < 1e-15);
        for by in [-58_000.0, 58_000.0] {
            assert!((shifted(by) - by - 5.0_f64.ln()).abs() < 1e-10, "{by}");
        }
        assert_eq!(log_sum_exp(std::iter::empty()), f64::NEG_INFINITY);
        assert_eq!(log_sum_exp([f64::NEG_INFINITY; 2].into_iter()), f64::NEG_INFINITY);
    }
}
