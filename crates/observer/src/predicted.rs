//! Whether what moves is sampled densely enough: how well each sample of it is predicted by those around, at one spacing and at two.

/// Samples before and after one, in spacings, by which it is predicted, and their weights: exact for cubic polynomials.
const AROUND: [isize; 4] = [-3, -1, 1, 3];
const WEIGHTS: [f64; 4] = [-0.0625, 0.5625, 0.5625, -0.0625];
/// Spacings over which that is done.
const WIDTHS: [isize; 2] = [1, 2];
/// The farthest sample that is looked at, at twice the spacing and at once.
const REACH: usize = 6;
const NEAR: usize = 3;
/// Share by which spacings may differ for these weights.
const EVEN: f64 = 0.02;

/// How well.
#[derive(Clone, Copy)]
pub(crate) struct Predicted {
    /// What a sample is predicted wrongly by, root of the mean over all of the sum over its numbers.
    pub(crate) off: f64,
    /// Square of that over that of twice the spacing, at most 1: how the error falls with the fourth power of the spacing, squared.
    pub(crate) falls: f64,
    /// Mean time between samples, s.
    pub(crate) spacing: f64,
}

/// Of values at samples; none where nowhere thirteen in a row are as far apart as each other.
pub(crate) fn predicted<const N: usize>(
    times: &[f64],
    value: impl Fn(usize) -> [f64; N],
) -> Option<Predicted> {
    let (mut squares, mut count, mut time) = ([0.0; 2], 0.0, 0.0);
    for k in (REACH..times.len().saturating_sub(REACH)).filter(|&k| is_even(&times[k - REACH..=k + REACH])) {
        for (width, square) in WIDTHS.into_iter().zip(&mut squares) {
            *square += square_off(&value, k, width);
        }
        (count, time) = (count + 1.0, time + times[k] - times[k - 1]);
    }
    let [fine, coarse] = squares;
    let falls = if fine < coarse { fine / coarse } else { 1.0 };
    (count > 0.0).then(|| Predicted { off: (fine / count).sqrt(), falls, spacing: time / count })
}

/// Square of what sample `k` is predicted wrongly by from those around.
fn square_off<const N: usize>(value: &impl Fn(usize) -> [f64; N], k: usize, width: isize) -> f64 {
    let (own, mut off) = (value(k), [0.0; N]);
    for (around, weight) in AROUND.into_iter().zip(WEIGHTS) {
        let other = value(k.saturating_add_signed(around * width));
        off.iter_mut().zip(own).zip(other).for_each(|((off, own), other)| *off += weight * (other - own));
    }
    off.iter().map(|off| off * off).sum()
}

/// Samples that are predicted wrongly by more than `off`, with by how much: where what moves changes how it does.
pub(crate) fn kinks<const N: usize>(
    times: &[f64],
    value: impl Fn(usize) -> [f64; N],
    off: f64,
) -> Vec<(usize, f64)> {
    let even = |k: &usize| is_even(&times[k - NEAR..=k + NEAR]);
    let samples = (NEAR..times.len().saturating_sub(NEAR)).filter(even);
    let each = samples.map(|k| (k, square_off(&value, k, 1).sqrt()));
    each.filter(|(_, by)| *by > off).collect()
}

pub(crate) fn is_even(times: &[f64]) -> bool {
    let first = times[1] - times[0];
    times.windows(2).all(|pair| (pair[1] - pair[0] - first).abs() < EVEN * first)
}
