//! Quantiles of normal noise, rounded to the safe side.

/// `z` such that a standard normal exceeds it with probability at most `alpha < 0.16`: where the tail's bound
/// `Q(z) < phi(z) / z` equals `alpha`, approached from above.
pub(super) fn normal(alpha: f64) -> f64 {
    let root = std::f64::consts::TAU.sqrt();
    let mut z = (-2.0 * alpha.ln()).sqrt();
    // A contraction for z above 1, where the tail is the bound's to better than a half.
    for _ in 0..60 {
        z = (-2.0 * (alpha * z.max(1.0) * root).ln()).max(1.0).sqrt();
    }
    z
}

/// Length that a vector of two independent standard normals exceeds with probability `alpha`: exact (Rayleigh).
pub(super) fn length(alpha: f64) -> f64 {
    (-2.0 * alpha.ln()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_just_above_those_of_the_tables() {
        for (alpha, table) in [(1e-2, 2.326_348), (1e-4, 3.719_016), (1e-6, 4.753_424)] {
            let excess = normal(alpha) - table;
            assert!((0.0..0.06).contains(&excess), "{alpha}: {excess}");
        }
        // Square root of the quantile of chi-square with two degrees of freedom.
        assert!((length(1e-2).powi(2) - 9.210_340_372).abs() < 1e-8);
    }
}
