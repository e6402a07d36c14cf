//! How much of a misfit chance alone makes, and how much of it lasts.

/// Chi-squared of so many degrees of freedom as a normal variable: the cube root's approximation (Wilson and Hilferty 1931).
pub(crate) fn excess(chi_squared: f64, degrees: f64) -> f64 {
    let variance = 2.0 / (9.0 * degrees.max(1.0));
    ((chi_squared / degrees.max(1.0)).cbrt() - (1.0 - variance)) / variance.sqrt()
}

/// Integrated correlation time of residuals in samples: the variance of a mean of them is this many times that of a mean of independent
/// ones. Each series is in the order of time; zeros stand where nothing is left.
///
/// Twice the sum of the autocorrelation up to where it first turns negative, less what `chance` makes
/// of it; the lags grow in proportion, so that the cost stays that of a few dozen sums.
pub(crate) fn lasting(series: &[Vec<f64>], chance: f64) -> f64 {
    let total: f64 = series.iter().flatten().map(|e| e * e).sum();
    if total.is_nan() || total <= 0.0 {
        return 1.0;
    }
    let longest = series.iter().map(Vec::len).max().unwrap_or_default();
    let correlation = |lag: usize| {
        let pairs = series.iter().flat_map(|of| of.iter().zip(of.get(lag..).unwrap_or_default()));
        pairs.map(|(a, b)| a * b).sum::<f64>() / total
    };
    let (mut sum, mut lag, mut before) = (1.0, 0, 1.0);
    loop {
        let width = (lag / 8).max(1);
        lag += width;
        if lag >= longest {
            break;
        }
        let here = correlation(lag) - chance;
        if here <= 0.0 {
            break;
        }
        // Sum over the lags passed, two-sided; those that were skipped by the trapezoidal rule.
        let skipped = (width - 1) as f64 * 0.5 * (before + here);
        sum += 2.0 * (skipped + here);
        before = here;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn independent_and_lasting_residuals_are_told_apart() {
        let mut seed = 7u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            2.0 * ((seed >> 11) as f64 / (1u64 << 53) as f64) - 1.0
        };
        let white: [Vec<f64>; 3] = std::array::from_fn(|_| (0..20_000).map(|_| random()).collect());
        assert!(lasting(&white, 0.0) < 1.3, "{}", lasting(&white, 0.0));
        // First-order autoregression with pole a: integrated time (1 + a) / (1 - a) = 39 at a = 0.95.
        let follow = |state: &mut f64, w: &f64| {
            *state = 0.95 * *state + w;
            Some(*state)
        };
        let slow = white.map(|of| of.iter().scan(0.0, follow).collect::<Vec<_>>());
        let found = lasting(&slow, 0.0);
        assert!((25.0..55.0).contains(&found), "{found}");
        assert!((lasting(&[vec![0.0; 10]], 0.0) - 1.0).abs() < 1e-15);
    }
}
