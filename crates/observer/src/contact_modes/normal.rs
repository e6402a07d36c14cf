//! The normal distribution: density, distribution and its integral.

use std::f64::consts::{PI, SQRT_2, TAU};

/// From here on the continued fraction of the tail is used.
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

/// `erf` for `|x| < TAIL`: every term of `2 / sqrt(pi) exp(-x^2) sum 2^n x^(2n+1) / (2n+1)!!` has one sign, so no digit cancels.
fn erf(x: f64) -> f64 {
    let (mut term, mut sum, mut odd) = (x, x, 1.0);
    while term.abs() > 1e-17 * sum.abs() {
        odd += 2.0;
        term *= 2.0 * x * x / odd;
        sum += term;
    }
    2.0 / PI.sqrt() * (-x * x).exp() * sum
}

/// Probability that a standard normal number is below `x`.
pub(crate) fn below(x: f64) -> f64 {
    let z = x / SQRT_2;
    if z <= -TAIL {
        0.5 * (-z * z).exp() * scaled_tail(-z)
    } else if z >= TAIL {
        1.0 - 0.5 * (-z * z).exp() * scaled_tail(z)
    } else {
        0.5 * (1.0 + erf(z))
    }
}

/// Logarithm of [`below`], which does not underflow.
pub(crate) fn log_below(x: f64) -> f64 {
    let z = x / SQRT_2;
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
        // The two expansions meet, and mirror each other.
        let seam = TAIL * SQRT_2;
        assert!((below(-seam - 1e-13) / below(-seam + 1e-13) - 1.0).abs() < 3e-11);
        for k in -60..=60 {
            let x = f64::from(k) / 10.0;
            assert!((below(x) + below(-x) - 1.0).abs() < 1e-15, "{x}");
            assert!((log_below(x) - below(x).ln()).abs() < 1e-12, "{x}");
            let slope = (integral_below(x + 1e-4) - integral_below(x - 1e-4)) / 2e-4;
            assert!((slope - below(x)).abs() < 1e-8, "{x}");
        }
    }
}
