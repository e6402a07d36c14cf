//! Whether measured impulses are those of the measured forces: another unit or sign is none that blows or noise make.

use super::palm::LoggedPalm;

/// Intervals with a contact at both ends from which on it is asked.
const FEWEST: usize = 8;
/// Cosine of the angle of impulse and force from which on they are along each other, in half of the intervals.
const ALONG: f64 = 0.9;
/// Factor between them that nothing but a unit makes, in half of the intervals.
const FACTOR: f64 = 2.0;

/// By what factor a palm's impulses are off the integrals of its forces, where they are; zero of impulses that stay zero.
///
/// Medians over the intervals, so that blows, which samples of the force miss, do not count. Noise that hides the direction hides the
/// factor too.
pub(super) fn factor(times: &[f64], palm: &LoggedPalm) -> Option<f64> {
    let pair = |k: usize| {
        palm.touch(k - 1).and(palm.touch(k))?;
        let impulse = palm.impulse(k)?.vector;
        let force = palm.force(k - 1)?.vector + palm.force(k)?.vector;
        let by_forces = force * (0.5 * (times[k] - times[k - 1]));
        (by_forces.length() > 0.0).then_some((impulse, by_forces))
    };
    let pairs: Vec<_> = (1..times.len()).filter_map(pair).collect();
    if pairs.len() < FEWEST {
        return None;
    }
    let ratio = median(pairs.iter().map(|(J, F)| J.length() / F.length()));
    if ratio == 0.0 {
        return Some(ratio);
    }
    let along = median(pairs.iter().map(|(J, F)| J.normalize_or_zero().dot(F.normalize_or_zero())));
    if along.abs() < ALONG {
        return None;
    }
    let factor = ratio * along.signum();
    (!(1.0 / FACTOR..=FACTOR).contains(&factor)).then_some(factor)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}
