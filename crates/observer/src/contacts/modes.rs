//! Contact modes from the ratio of friction to normal force.

use super::record::{Contact, Record};
use object_dynamics::{ContactMode, MOST_PALMS};

/// Quantile of a palm's ratios that is taken for that of sliding.
const SLIDING: f64 = 0.9;
/// Standard deviations by which a ratio is below that of sliding where a contact is said to stick. One that slides and is said
/// to stick is an error of its slip; one that sticks and is said to slide loses two conditions.
const BELOW: f64 = 4.0;
/// Least relative deviation of a ratio.
const LEAST: f64 = 0.01;

/// Ratio of friction to normal force at a sample.
#[derive(Clone, Copy)]
struct Ratio {
    value: f64,
    /// Square of the standard deviation of each axis of the force as a share of it.
    share: f64,
}

/// Ratios averaged; how many samples they are the mean of.
#[derive(Clone, Copy)]
struct Mean {
    ratio: Ratio,
    samples: usize,
}

/// Modes of all contacts at all samples, by ratios averaged over `time` on either side.
///
/// The ratio of a contact that slides is the coefficient of friction, and that of one that sticks is below it. A palm along which
/// the body never slides has a coefficient that is too small here: contacts near it lose conditions.
pub(super) fn by_ratio(record: &Record, time: f64) -> Vec<[ContactMode; MOST_PALMS]> {
    let times = &record.times;
    let mut modes = vec![[ContactMode::Off; MOST_PALMS]; times.len()];
    for i in 0..MOST_PALMS {
        let ratios = averaged(&ratios(record, i), times, time);
        let slides = sliding(&ratios);
        // A mean may be below that of sliding by the samples beside it: nearer than `time` to one that is not it tells nothing.
        let before = nearest(&slides, times, (0..times.len()).collect());
        let after = nearest(&slides, times, (0..times.len()).rev().collect());
        for k in (0..times.len()).filter(|&k| ratios[k].is_some()) {
            let doubtful = before[k].min(after[k]) <= time;
            let frictionless = record.contacts[k].iter().any(|c| c.palm == i && c.frictionless);
            modes[k][i] = if doubtful || frictionless { ContactMode::Slide } else { ContactMode::Stick };
        }
    }
    modes
}

/// Whether a contact is not clearly below the ratio of sliding.
fn sliding(means: &[Option<Mean>]) -> Vec<bool> {
    let mut sorted: Vec<f64> = means.iter().flatten().map(|mean| mean.ratio.value).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(&sliding) = sorted.get((SLIDING * sorted.len() as f64) as usize) else {
        return vec![false; means.len()];
    };
    let grows = (1.0 + sliding * sliding) / sliding.max(f64::MIN_POSITIVE);
    let slides = |mean: &Mean| {
        let deviation = LEAST.hypot(grows * (mean.ratio.share / mean.samples as f64).sqrt());
        mean.ratio.value >= sliding * (1.0 - BELOW * deviation)
    };
    means.iter().map(|mean| mean.as_ref().is_some_and(slides)).collect()
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

/// Of one palm. A force that does not press tells nothing: its contact slides.
fn ratios(record: &Record, palm: usize) -> Vec<Option<Ratio>> {
    let of = |contact: &Contact| {
        let normal = contact.f.dot(contact.n);
        if normal <= 0.0 {
            return Ratio { value: f64::INFINITY, share: 0.0 };
        }
        let value = contact.f.reject_from_normalized(contact.n).length() / normal;
        Ratio { value, share: contact.f_deviation.powi(2) / contact.f.length_squared() }
    };
    let at = |contacts: &Vec<Contact>| contacts.iter().find(|contact| contact.palm == palm).map(of);
    record.contacts.iter().map(at).collect()
}

/// Means over as many samples on either side as lie within `time` and touch without a break.
fn averaged(ratios: &[Option<Ratio>], times: &[f64], time: f64) -> Vec<Option<Mean>> {
    let one = |k: usize| {
        let Ratio { mut value, mut share } = ratios[k]?;
        let mut samples = 1;
        for i in 1..=k.min(ratios.len() - 1 - k) {
            let (Some(before), Some(after)) = (ratios[k - i], ratios[k + i]) else { break };
            if times[k + i] - times[k] > time {
                break;
            }
            value += before.value + after.value;
            share += before.share + after.share;
            samples += 2;
        }
        let count = samples as f64;
        Some(Mean { ratio: Ratio { value: value / count, share: share / count }, samples })
    };
    (0..ratios.len()).map(one).collect()
}
