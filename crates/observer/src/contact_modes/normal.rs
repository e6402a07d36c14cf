//! The normal distribution: density, distribution and its integral.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

/// From here on the logarithm of the tail is that of its continued fraction.
const TAIL: f64 = 3.0;
/// Terms of the continued fraction: at `TAIL` the rest is below 1e-16.
const TERMS: u32 = 80;

/// Logarithm of the normal density with this variance, at `x` from the mean.
pub(crate) fn log_density(x: f64, variance: f64) -> f64 {
    -0.5 * ((TAU * variance).ln() + x * x / variance)
}

/// `exp(x^2) erfc(x)` for `x >= TAIL`: the continued fraction of Laplace.
fn scaled_tail(x: f64) -> f64 {
    let fraction = (1..=TERMS).rev().fold(0.0, |rest, k| 0.5 * f64::from(k) / (x + rest));
    1.0 / (PI.sqrt() * (x + fraction))
}

/// Probability that a standard normal number is below `x`.
pub(crate) fn below(x: f64) -> f64 {
    0.5 * libm::erfc(-x * FRAC_1_SQRT_2)
}

/// Logarithm of [`below`], which does not underflow.
pub(crate) fn log_below(x: f64) -> f64 {
    let z = x * FRAC_1_SQRT_2;
    if z <= -TAIL { (0.5 * scaled_tail(-z)).ln() - z * z } else { below(x).ln() }
}

/// Integral of [`below`] from minus infinity: `x below(x) + density(x)`.
pub(crate) fn integral_below(x: f64) -> f64 {
    // The two terms cancel in the lower tail, where nothing is left to speak of.
    (x * below(x) + log_density(x, 1.0).exp()).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_and_one_curve() {
        // Abramowitz and Stegun, table 26.1, and its tail by the asymptotic series.
        for (x, expected) in [(0.0, 0.5), (1.0, 0.841_344_746_068_542_9), (-2.0, 0.022_750_131_948_179_2)] {
            assert!((below(x) - expected).abs() < 1e-15, "{x}");
        }
        assert!((log_below(-30.0) + 454.321_243_956_343_4).abs() < 1e-9, "{}", log_below(-30.0));
        // The two forms of the logarithm meet.
        let seam = TAIL / FRAC_1_SQRT_2;
        assert!((log_below(-seam - 1e-13) - log_below(-seam + 1e-13)).abs() < 3e-11);
        for k in -60..=60 {
            let x = f64::from(k) / 10.0;
            assert!((below(x) + below(-x) - 1.0).abs() < 1e-15, "{x}");
            assert!((log_below(x) - below(x).ln()).abs() < 1e-12, "{x}");
            let slope = (integral_below(x + 1e-4) - integral_below(x - 1e-4)) / 2e-4;
            assert!((slope - below(x)).abs() < 1e-8, "{x}");
        }
    }
}
