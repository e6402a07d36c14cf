//! Quantiles of normal noise, rounded to the safe side.

/// `z` such that a standard normal exceeds it with probability at most `alpha < 0.16`.
///
/// From the tail bound `Q(z) < phi(z) / z`, which at the small probabilities used here is a few per cent above the tail
/// itself, that is a few thousandths of a standard deviation.
#[must_use]
pub fn normal(alpha: f64) -> f64 {
    solve(alpha, |z| (-z * z / 2.0).exp() / (z * TAU_ROOT))
}

/// `r` such that the length of a vector of three independent standard normals exceeds it with probability at most
/// `alpha`: `P = 2 Q(r) + sqrt(2 / pi) r exp(-r^2 / 2)`, with the same bound on `Q`.
#[must_use]
pub fn length3(alpha: f64) -> f64 {
    solve(alpha, |r| 2.0 * (-r * r / 2.0).exp() * (1.0 / r + r) / TAU_ROOT)
}

/// Length that a vector of six independent standard normals exceeds with probability `alpha`:
/// `P = exp(-q) (1 + q + q^2 / 2)` with `q = r^2 / 2`, exact.
#[must_use]
pub fn length6(alpha: f64) -> f64 {
    solve(alpha, |r| {
        let q = 0.5 * r * r;
        (-q).exp() * (1.0 + q + 0.5 * q * q)
    })
}

/// Length that a vector of two independent standard normals exceeds with probability `alpha`: exact (Rayleigh).
#[must_use]
pub fn length2(alpha: f64) -> f64 {
    (-2.0 * alpha.ln()).sqrt()
}

/// Square root of 2 pi.
const TAU_ROOT: f64 = 2.506_628_274_631_000_5;

/// Where the falling function `tail` reaches `alpha`, from above.
fn solve(alpha: f64, tail: impl Fn(f64) -> f64) -> f64 {
    // Beyond 39 the exponential underflows; below 1 the bounds are useless.
    let (mut low, mut high) = (1.0, 39.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if tail(middle) > alpha { low = middle } else { high = middle }
    }
    high
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
        // Square roots of the quantiles of chi-square with three degrees of freedom.
        for (alpha, table) in [(1e-2, 11.344_867_f64), (1e-4, 21.107_513), (1e-6, 30.664_850)] {
            let excess = length3(alpha) - table.sqrt();
            assert!((0.0..0.06).contains(&excess), "{alpha}: {excess}");
        }
        // Square roots of quantiles of chi-square with six and with two degrees of freedom.
        assert!((length6(1e-2).powi(2) - 16.811_893_83).abs() < 1e-7);
        assert!((length2(1e-2).powi(2) - 9.210_340_372).abs() < 1e-8);
    }
}
