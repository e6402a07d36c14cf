//! Contact modes from the ratio of friction to normal force.

use super::noise::ContactNoiseLevel;
use super::options::ContactOptions;
use object_dynamics::{ContactLog, ContactMode, LoggedPalm, MOST_PALMS};

/// Quantile of a palm's ratios that is taken for that of sliding.
const SLIDING: f64 = 0.9;
/// Standard deviations by which a ratio is below that of sliding where a contact is said to stick. One that slides and is said
/// to stick is an error of its slip; one that sticks and is said to slide loses two conditions.
const BELOW: f64 = 4.0;
/// Least relative deviation of a ratio.
const LEAST: f64 = 0.01;

/// Ratio of friction to normal force at a sample, averaged; how many samples it is the mean of.
#[derive(Clone, Copy)]
struct Ratio {
    mean: f64,
    samples: usize,
}

/// Modes of all contacts at all samples, by ratios averaged over `time` on either side.
///
/// The ratio of a contact that slides is the coefficient of friction, and that of one that sticks is below it. A palm along which
/// the body never slides has a coefficient that is too small here: contacts near it lose conditions.
pub(super) fn by_ratio(
    log: &ContactLog,
    options: &ContactOptions,
    time: f64,
) -> Vec<[ContactMode; MOST_PALMS]> {
    let times = log.times();
    let mut modes = vec![[ContactMode::Off; MOST_PALMS]; times.len()];
    for (i, palm) in log.palms().iter().enumerate() {
        if options.frictionless(palm) {
            for k in (0..times.len()).filter(|&k| palm.touch(k).is_some()) {
                modes[k][i] = ContactMode::Slide;
            }
            continue;
        }
        let ratios = averaged(&ratios(palm, times.len()), times, time);
        let slides = sliding(&ratios, &options.noise);
        // A mean may be below that of sliding by the samples beside it: nearer than `time` to one that is not it tells nothing.
        let before = nearest(&slides, times, (0..times.len()).collect());
        let after = nearest(&slides, times, (0..times.len()).rev().collect());
        for k in (0..times.len()).filter(|&k| ratios[k].is_some()) {
            let doubtful = before[k].min(after[k]) <= time;
            modes[k][i] = if doubtful { ContactMode::Slide } else { ContactMode::Stick };
        }
    }
    modes
}

/// Whether a contact is not clearly below the ratio of sliding.
fn sliding(ratios: &[Option<Ratio>], noise: &ContactNoiseLevel) -> Vec<bool> {
    let mut sorted: Vec<f64> = ratios.iter().flatten().map(|ratio| ratio.mean).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(&sliding) = sorted.get((SLIDING * sorted.len() as f64) as usize) else {
        return vec![false; ratios.len()];
    };
    let share = noise.force_share * (1.0 + sliding * sliding) / sliding.max(f64::MIN_POSITIVE);
    let slides = |ratio: &Ratio| {
        let deviation = LEAST.hypot(share / (ratio.samples as f64).sqrt());
        ratio.mean >= sliding * (1.0 - BELOW * deviation)
    };
    ratios.iter().map(|ratio| ratio.as_ref().is_some_and(slides)).collect()
}

/// Time between each sample and the last one before it, in some order, that slides.
fn nearest(slides: &[bool], times: &[f64], order: Vec<usize>) -> Vec<f64> {
    let mut away = vec![f64::INFINITY; times.len()];
    let mut last = f64::INFINITY;
    for k in order {
        if slides[k] {
            last = times[k];
        }
        away[k] = (times[k] - last).abs();
    }
    away
}

fn ratios(palm: &LoggedPalm, count: usize) -> Vec<Option<f64>> {
    let one = |k: usize| {
        let n = palm.touch(k)?.n.get();
        let f = palm.force(k)?.vector;
        let normal = f.dot(n);
        Some(if normal > 0.0 { f.reject_from_normalized(n).length() / normal } else { f64::INFINITY })
    };
    (0..count).map(one).collect()
}

/// Means over as many samples on either side as lie within `time` and touch without a break.
fn averaged(ratios: &[Option<f64>], times: &[f64], time: f64) -> Vec<Option<Ratio>> {
    let one = |k: usize| {
        let mut sum = ratios[k]?;
        let mut samples = 1;
        for i in 1..=k.min(ratios.len() - 1 - k) {
            let (Some(before), Some(after)) = (ratios[k - i], ratios[k + i]) else { break };
            if times[k + i] - times[k] > time {
                break;
            }
            sum += before + after;
            samples += 2;
        }
        Some(Ratio { mean: sum / samples as f64, samples })
    };
    (0..ratios.len()).map(one).collect()
}
