//! How much of the residuals is independent from sample to sample.

/// Von Neumann's ratio of residuals in time order: about 1 where they are independent, about 0 where they are smooth.
pub(super) fn whiteness(residuals: &[[f64; 3]]) -> f64 {
    let total: f64 = residuals.iter().flatten().map(|e| e * e).sum();
    let steps: f64 =
        residuals.windows(2).flat_map(|w| (0..3).map(move |i| (w[1][i] - w[0][i]).powi(2))).sum();
    if total > 0.0 { 0.5 * steps / total } else { 1.0 }
}

/// Integrated correlation time in samples: the variance of a mean of the residuals is this many times that of a mean
/// of independent ones. Twice the sum of the autocorrelation up to where it first turns negative; the lags grow in
/// proportion, so that the cost stays that of a few dozen sums.
pub(super) fn correlation_samples(residuals: &[[f64; 3]]) -> f64 {
    let total: f64 = residuals.iter().flatten().map(|e| e * e).sum();
    if total.is_nan() || total <= 0.0 {
        return 1.0;
    }
    let correlation = |lag: usize| {
        let pairs = residuals.iter().zip(&residuals[lag..]);
        pairs.flat_map(|(a, b)| (0..3).map(move |i| a[i] * b[i])).sum::<f64>() / total
    };
    let (mut sum, mut lag, mut before) = (1.0, 0, 1.0);
    loop {
        let width = (lag / 8).max(1);
        lag += width;
        if lag >= residuals.len() {
            break;
        }
        let here = correlation(lag);
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
        let white: Vec<[f64; 3]> = (0..20_000).map(|_| [random(), random(), random()]).collect();
        assert!((whiteness(&white) - 1.0).abs() < 0.05);
        assert!(correlation_samples(&white) < 1.3, "{}", correlation_samples(&white));
        // First-order autoregression with pole a: integrated time (1 + a) / (1 - a) = 39 at a = 0.95.
        let mut state = [0.0; 3];
        let lasting: Vec<[f64; 3]> = white
            .iter()
            .map(|w| {
                for i in 0..3 {
                    state[i] = 0.95 * state[i] + w[i];
                }
                state
            })
            .collect();
        let found = correlation_samples(&lasting);
        assert!((25.0..55.0).contains(&found), "{found}");
        assert!((whiteness(&lasting) - 0.05).abs() < 0.01);
        assert!((correlation_samples(&[[0.0; 3]; 10]) - 1.0).abs() < 1e-15);
    }
}
