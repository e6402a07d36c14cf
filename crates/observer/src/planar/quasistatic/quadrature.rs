//! Integrals along sampled paths.

/// Integral of `f dg` over each interval between samples: cubics through the four nearest samples, three-point Gauss rule.
pub(super) fn line_integral(f: &[f64], g: &[f64]) -> Vec<f64> {
    let gauss = 0.5 * 0.6_f64.sqrt();
    let rule = [(0.5 - gauss, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + gauss, 5.0 / 18.0)];
    (0..f.len() - 1)
        .map(|k| {
            let from = k.saturating_sub(1).min(f.len() - 4);
            let at = (k - from) as f64;
            let part = |(u, weight): (f64, f64)| {
                weight * cubic(&f[from..from + 4], at + u).0 * cubic(&g[from..from + 4], at + u).1
            };
            rule.into_iter().map(part).sum()
        })
        .collect()
}

/// Cubic through four values at 0, 1, 2, 3, and its slope, at `u`; Newton's forward differences.
fn cubic(v: &[f64], u: f64) -> (f64, f64) {
    let d1 = v[1] - v[0];
    let d2 = v[2] - 2.0 * v[1] + v[0];
    let d3 = v[3] - 3.0 * (v[2] - v[1]) - v[0];
    let value = v[0] + u * (d1 + (u - 1.0) / 2.0 * (d2 + (u - 2.0) / 3.0 * d3));
    let slope = d1 + (2.0 * u - 1.0) / 2.0 * d2 + (3.0 * u * u - 6.0 * u + 2.0) / 6.0 * d3;
    (value, slope)
}
