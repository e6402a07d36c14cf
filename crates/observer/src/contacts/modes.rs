//! Contact modes from the ratio of friction to normal force.

use super::ranges::Ranges;
use super::record::{Contact, Record};
use object_dynamics::{ContactMode, MOST_PALMS};
use std::ops::Add;

/// Quantile of a palm's ratios that is taken for that of sliding.
const SLIDING: f64 = 0.9;
/// The same quantile of a normal variable: where all samples slide, noise alone raises it by so many deviations.
const BY_NOISE: f64 = 1.2816;
/// Standard deviations by which a ratio is below that of sliding where a contact is said to stick. One that slides and is said
/// to stick is an error of its slip; one that sticks and is said to slide loses two conditions.
const BELOW: f64 = 4.0;
/// Share of the ratio of sliding by which that of a sample alone must be below it, at most, to be told from it by that sample.
const CERTAIN: f64 = 0.1;
/// Least relative deviation of a ratio.
const LEAST: f64 = 0.01;

/// Ratio of friction to normal force at a sample, or a sum of such.
#[derive(Clone, Copy, Default)]
struct Ratio {
    value: f64,
    /// Square of the standard deviation of each axis of the force as a share of it, with what the normal is off by.
    share: f64,
}

/// Ratios averaged; how many samples they are the mean of.
#[derive(Clone, Copy)]
struct Mean {
    ratio: Ratio,
    samples: usize,
}

impl Mean {
    /// Its standard deviation where it is `ratio`.
    fn deviation(&self, ratio: f64) -> f64 {
        (1.0 + ratio * ratio) * (self.ratio.share / self.samples as f64).sqrt()
    }

    /// What noise raises a quantile by taken off, the more the less a force presses.
    fn less_noise(&self) -> f64 {
        self.ratio.value - BY_NOISE * self.deviation(self.ratio.value)
    }
}

/// Modes of all contacts at all samples, by ratios averaged over `time` on either side.
///
/// The ratio of a contact that slides is the coefficient of friction, and that of one that sticks is below it. A palm along which
/// the body never slides has a coefficient that is too small here: contacts near it lose conditions.
pub(super) fn by_ratio(record: &Record, time: f64) -> Vec<[ContactMode; MOST_PALMS]> {
    let times = &record.times;
    let mut modes = vec![[ContactMode::Off; MOST_PALMS]; times.len()];
    let mut rubs = [false; MOST_PALMS];
    for (modes, contacts) in modes.iter_mut().zip(&record.contacts) {
        for contact in contacts {
            // Whatever friction is read where there is none.
            if contact.frictionless {
                modes[contact.palm] = ContactMode::Slide;
            }
            rubs[contact.palm] |= !contact.frictionless;
        }
    }
    for i in (0..MOST_PALMS).filter(|i| rubs[*i]) {
        let own = ratios(record, i);
        let ratios = averaged(&own, times, time);
        let slides = sliding(&ratios, &own);
        // A mean may be below that of sliding by the samples beside it: nearer than `time` to one that is not it tells nothing.
        let before = nearest(&slides, times, (0..times.len()).collect());
        let after = nearest(&slides, times, (0..times.len()).rev().collect());
        for k in (0..times.len()).filter(|&k| ratios[k].is_some()) {
            // Where samples are farther apart than that, one alone below it is noise at times.
            let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
            let alone = beside.filter_map(|j| slides.get(j)).any(|slides| *slides);
            let doubtful = alone || before[k].min(after[k]) <= time;
            modes[k][i] = if doubtful { ContactMode::Slide } else { ContactMode::Stick };
        }
    }
    modes
}

/// Whether a contact is not clearly below the ratio of sliding, by the mean or, where noise leaves the ratio of a sample as good as certain, by that: a slip that
/// lasts for less than a mean is hidden in it.
fn sliding(means: &[Option<Mean>], own: &[Option<Ratio>]) -> Vec<bool> {
    // Of a mean over forces that do not press nothing is known.
    let mut sorted: Vec<f64> =
        means.iter().flatten().map(Mean::less_noise).filter(|ratio| ratio.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let quantile = sorted.get((SLIDING * sorted.len() as f64) as usize);
    let Some(&sliding) = quantile.filter(|sliding| **sliding > 0.0) else {
        // Nothing is clearly below what noise alone may be.
        return means.iter().map(Option::is_some).collect();
    };
    let below = |mean: &Mean| BELOW * LEAST.hypot(mean.deviation(sliding) / sliding);
    let slides = |mean: &Mean| mean.ratio.value >= sliding * (1.0 - below(mean));
    let alone = |ratio: Ratio| Some(Mean { ratio, samples: 1 }).filter(|one| below(one) < CERTAIN);
    let one = |(mean, own): (&Option<Mean>, &Option<Ratio>)| {
        mean.as_ref().is_some_and(slides) || own.and_then(alone).as_ref().is_some_and(slides)
    };
    means.iter().zip(own).map(one).collect()
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
        let turned = contact.turning(record.deviation);
        Ratio { value, share: contact.f_deviation.powi(2) / contact.f.length_squared() + turned * turned }
    };
    let at = |contacts: &Vec<Contact>| contacts.iter().find(|contact| contact.palm == palm).map(of);
    record.contacts.iter().map(at).collect()
}

/// Means over as many samples on either side as lie within `time` and touch without a break.
fn averaged(ratios: &[Option<Ratio>], times: &[f64], time: f64) -> Vec<Option<Mean>> {
    let sums = Ranges::new(&ratios.iter().map(|ratio| ratio.unwrap_or_default()).collect::<Vec<_>>());
    let mut all = Vec::with_capacity(ratios.len());
    let mut to = 0;
    for run in ratios.chunk_by(|a, b| a.is_some() == b.is_some()) {
        let (start, end) = (all.len(), all.len() + run.len());
        for k in start..end {
            // Of the last sample within `time`.
            while to < times.len() && times[to] - times[k] <= time {
                to += 1;
            }
            let beside = (k - start).min(end - 1 - k).min(to.saturating_sub(k + 1));
            let samples = 2 * beside + 1;
            let mean = || {
                let Ratio { value, share } = sums.sum(k - beside..k + beside + 1);
                Mean {
                    ratio: Ratio { value: value / samples as f64, share: share / samples as f64 },
                    samples,
                }
            };
            all.push(ratios[k].map(|_| mean()));
        }
    }
    all
}

impl Add for Ratio {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, share: self.share + other.share }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;

    /// As it is defined, sample by sample.
    fn mean(ratios: &[Option<Ratio>], times: &[f64], time: f64, k: usize) -> Option<Mean> {
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
    }

    /// Where a palm presses little, noise raises the quantile of its ratios: contacts that slide and press more are no less so for that.
    #[test]
    fn what_slides_everywhere_is_not_said_to_stick_since_some_of_it_presses_little() {
        let mut random = Normal::seeded(7);
        let (friction, noise) = (0.3, 0.02);
        let mut mean = |normal: f64| {
            let [n, f] = [normal + noise * random.draw(), friction * normal + noise * random.draw()];
            let ratio = if n > 0.0 { f.abs() / n } else { f64::INFINITY };
            Some(Mean { ratio: Ratio { value: ratio, share: noise * noise / (n * n + f * f) }, samples: 1 })
        };
        let means: Vec<_> = (0..900).map(|k| mean(if k % 3 == 0 { 1.0 } else { 0.05 })).collect();
        let sticks = sliding(&means, &[None; 900]).into_iter().filter(|slides| !slides).count();
        assert!(sticks <= 1, "{sticks} of {}", means.len());
        // One that is held at half of its cone is told, of those that press.
        let held = |k: usize| k.is_multiple_of(9);
        let half: Vec<_> = (0..900)
            .map(|k| {
                means[k]
                    .map(|m| if held(k) { Mean { ratio: Ratio { value: 0.15, ..m.ratio }, ..m } } else { m })
            })
            .collect();
        let slides = sliding(&half, &[None; 900]);
        assert!((0..900).filter(|&k| held(k)).all(|k| !slides[k]));
        // Of what does not press at all nothing is known.
        let none = Mean { ratio: Ratio { value: f64::INFINITY, share: 0.0 }, samples: 1 };
        assert!(sliding(&[Some(none); 5], &[None; 5]).into_iter().all(|slides| slides));
        assert!(sliding(&[None; 5], &[None; 5]).into_iter().all(|slides| !slides));
    }

    /// Three samples of a slip amid sticking, which a mean over nine hides: told where noise lets them be, and by no sample where it does not.
    #[test]
    fn a_slip_that_is_shorter_than_a_mean_is_told() {
        let mut random = Normal::seeded(5);
        let times: Vec<f64> = (0..400).map(f64::from).collect();
        let mut slides = |noise: f64| {
            let ratio = |k: usize| match k {
                0..200 | 298..=300 => 0.3,
                _ => 0.15 * (0.1 * k as f64).sin().abs(),
            };
            let mut one = |k: usize| Ratio { value: ratio(k) + noise * random.draw(), share: noise * noise };
            let own: Vec<Option<Ratio>> = (0..400).map(|k| Some(one(k))).collect();
            sliding(&averaged(&own, &times, 4.0), &own)
        };
        let short = 298..301;
        let fine = slides(1e-3);
        assert!(short.clone().all(|k| fine[k]));
        let beside = |k: &usize| (210..290).contains(k) || (310..400).contains(k);
        assert!((0..400).filter(beside).all(|k| !fine[k]));
        let coarse = slides(2e-2);
        assert!((0..400).filter(beside).filter(|k| coarse[*k]).count() < 5, "one sample tells nothing there");
    }

    #[test]
    fn means_are_those_of_the_samples_as_they_are_defined() {
        let mut random = Normal::seeded(3);
        let mut t = 0.0;
        let times: Vec<f64> = (0..600)
            .map(|_| {
                t += 1e-3 * (0.2 + random.draw().abs());
                t
            })
            .collect();
        // Gaps, and forces that do not press.
        let ratios: Vec<Option<Ratio>> = (0..600)
            .map(|k| {
                let value = if k % 151 == 70 { f64::INFINITY } else { random.draw().abs() };
                (k % 89 > 2).then_some(Ratio { value, share: 1e-4 * random.draw().abs() })
            })
            .collect();
        for time in [0.0, 0.004, 0.03, 10.0] {
            for (k, fast) in averaged(&ratios, &times, time).into_iter().enumerate() {
                let simple = mean(&ratios, &times, time, k);
                assert_eq!(fast.map(|mean| mean.samples), simple.map(|mean| mean.samples), "{time} {k}");
                let (Some(Mean { ratio: a, .. }), Some(Mean { ratio: b, .. })) = (fast, simple) else {
                    continue;
                };
                // Sums of positive numbers: the rounding of at most so many steps.
                let alike = |a: f64, b: f64| a == b || (a - b).abs() <= 600.0 * f64::EPSILON * b;
                assert!(alike(a.value, b.value) && alike(a.share, b.share), "{time} {k}");
            }
        }
    }
}
