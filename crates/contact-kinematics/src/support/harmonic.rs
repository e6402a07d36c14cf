//! Real spherical harmonics as polynomials in the components of the unit normal: no poles.

use super::polynomial::Monomial;

/// Appends the terms of `coefficient Y_lm`, `m = index - l`.
///
/// `Y_lm = N_lm P_lm(z) Re (x + i y)^m` (imaginary part for `m < 0`), with
/// `P_lm(z) = sum_k (-1)^k 2^-l C(l, k) C(2l - 2k, l) (l - 2k)! / (l - 2k - m)! z^(l - 2k - m)` on the unit sphere.
pub(super) fn push_harmonic(terms: &mut Vec<Monomial>, l: usize, index: usize, coefficient: f64) {
    let m = index.abs_diff(l);
    let sine = index < l;
    let twice = if m > 0 { 2.0 } else { 1.0 };
    let falling: f64 = ((l - m + 1)..=(l + m)).map(|v| v as f64).product();
    let norm = (twice * (2.0 * l as f64 + 1.0) / (4.0 * std::f64::consts::PI) / falling).sqrt();
    for k in 0..=((l - m) / 2) {
        let power_z = l - 2 * k - m;
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        let ratio: f64 = ((power_z + 1)..=(l - 2 * k)).map(|v| v as f64).product();
        let axial = sign * 0.5f64.powi(l as i32) * binomial(l, k) * binomial(2 * l - 2 * k, l) * ratio;
        // (x + i y)^m: terms C(m, j) x^(m-j) (i y)^j, real for even j, imaginary for odd j.
        for j in (usize::from(sine)..=m).step_by(2) {
            let phase = if (j / 2) % 2 == 0 { 1.0 } else { -1.0 };
            terms.push(Monomial {
                powers: [(m - j) as u32, j as u32, power_z as u32],
                coefficient: coefficient * norm * axial * phase * binomial(m, j),
            });
        }
    }
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n - i) as f64 / (i + 1) as f64).product()
}
