//! Neighbouring samples of a record taken together, as far as that loses nothing.
//!
//! Each sample has a contact whose noise is a noise of its condition, and a node whose motion the noise of a force moves. Where
//! both are of one size a node follows its own contact, and least squares over so many nodes find the body wrong by several of their
//! deviations. A contact averaged over a window leaves the condition in the window's middle as it is, with less noise.

use super::both::of_some;
use super::impulses::kink;
use super::noise::{ContactNoiseLevel, WrenchNoise};
use super::problem::Units;
use super::record::{Contact, Interval, Record, Wrench};
use glam::DVec3;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// Longest window over the natural time, if contacts may begin to slide or stick within it: motions bend then, and it is not known when.
const KINKED: f64 = 0.1;

/// How much shorter the next window is that is tried, and how many are.
const SHORTER: f64 = 0.7;
const TRIED: usize = 6;

/// Deviations of a normal variable that it is beyond once in a thousand.
const UNLIKELY: f64 = 3.1;

/// Deviations of a window's squares beyond which its contacts bend.
const BENT: f64 = 5.0;

/// Samples for each that is kept, from which on thinning is worth it.
const THINNED: usize = 3;

/// Samples that a parabola is laid through at least.
const FEWEST: usize = 5;

/// Longest window to average contacts over, s: none where their noise is not what limits a condition.
///
/// In natural units what a parabola leaves out of a smooth motion grows with the fourth power of the window: it is to be below the noise
/// of a contact, by the size of the body and by the contacts themselves.
pub(super) fn longest(record: &Record, noise: &ContactNoiseLevel, units: &Units) -> f64 {
    let Units { length, speed, .. } = *units;
    let natural = length / speed;
    if !noise.limits(units) {
        return 0.0;
    }
    let smooth = (noise.contact / length).sqrt().sqrt();
    if !record.frictionless() {
        return natural * KINKED.min(smooth);
    }
    let shorter = |longest: &f64| Some(longest * SHORTER);
    let lengths = std::iter::successors(Some(natural * smooth), shorter).take(TRIED);
    lengths.clone().find(|&longest| !bent(record, longest, noise.contact)).or(lengths.last()).unwrap_or(0.0)
}

/// Whether contacts depart from the parabolas through windows by more than noise does, at odds of a thousand to one.
fn bent(record: &Record, longest: f64, deviation: f64) -> bool {
    let left = |window: &Window| {
        let all = 0..record.contacts[window.middle()].len();
        all.filter_map(|i| window.left(record, i)).fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1))
    };
    let left = of_some(record.times.len(), &alike(record, longest), |some| some.iter().map(left).collect());
    let (squares, freedoms) = left.iter().fold((0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1));
    // Each sample is around three windows.
    squares > deviation * deviation * (freedoms + UNLIKELY * (6.0 * freedoms).sqrt())
}

/// A window of samples in the middle one of which there is to be a node, and the samples around it with the same contacts in
/// the same modes.
#[derive(Clone)]
pub(super) struct Window {
    pub(super) own: Range<usize>,
    pub(super) around: Range<usize>,
}

impl Window {
    pub(super) fn middle(&self) -> usize {
        usize::midpoint(self.own.start, self.own.end - 1)
    }

    /// What contact `i` leaves of the parabola through the samples around, m^2, and of how many freedoms. None with too few of them.
    fn left(&self, record: &Record, i: usize) -> Option<(f64, f64)> {
        let middle = self.middle();
        let parabola = Parabola::new(self, &record.times, |k| record.contacts[k][i].c)?;
        let left = |k: usize| {
            let after = record.times[k] - record.times[middle];
            (record.contacts[k][i].c - parabola.at(after)).length_squared()
        };
        let axes = record.contacts[middle][i].freedoms() as f64;
        Some((self.around.clone().map(left).sum(), axes * (self.around.len() as f64 - 3.0)))
    }

    /// One of each sample where a contact departs from its parabola by more than noise does, at odds of some thousands to one: where the curvature of an
    /// outline rises within few samples no parabola follows it, though most others are followed.
    fn apart(self, record: &Record) -> Vec<Self> {
        let variance = record.deviation * record.deviation;
        let bends = |(squares, freedoms): (f64, f64)| {
            squares > variance * (freedoms + BENT * (2.0 * freedoms).sqrt())
        };
        let all = 0..record.contacts[self.middle()].len();
        if all.filter_map(|i| self.left(record, i)).any(bends) {
            self.own.map(|k| Self { own: k..k + 1, around: k..k + 1 }).collect()
        } else {
            vec![self]
        }
    }

    /// Samples whose contacts are averaged: where there are too few around for a parabola, the middle one stands for all.
    fn averaged(&self) -> usize {
        if self.around.len() < FEWEST { 1 } else { self.own.len() }
    }
}

/// Windows of an odd number of samples.
pub(super) fn windows(record: &Record, longest: f64) -> Vec<Window> {
    let apart = |some: &[Window]| some.iter().cloned().flat_map(|window| window.apart(record)).collect();
    of_some(record.times.len(), &alike(record, longest), apart)
}

/// The same of samples that touch alike, however contacts bend.
fn alike(record: &Record, longest: f64) -> Vec<Window> {
    let count = record.times.len();
    let touched = |k: usize| record.contacts[k].iter().map(|contact| (contact.palm, contact.mode));
    let same = |a: usize, b: usize| touched(a).eq(touched(b));
    let mut all = Vec::new();
    let alone = |k: usize| k == 0 || k == count - 1 || record.beside_blow(k);
    // Where the curvature of an outline jumps a contact changes its speed, and no parabola follows it.
    let kinked = |k: usize| {
        let of = |palm: usize| {
            let at = |k: usize| record.contacts.get(k)?.iter().find(|contact| contact.palm == palm);
            kink(|back| at((k + 2).checked_sub(back)?), record.deviation).is_some()
        };
        record.contacts[k].iter().any(|contact| contact.planar && of(contact.palm))
    };
    let mut run = 0..0;
    let mut from = 0;
    while from < count {
        if from == run.end {
            // Nodes are at the first sample and the last, so that all lie between two, and on both sides of a blow.
            let goes_on = |&k: &usize| !alone(from) && !alone(k) && same(from, k) && !kinked(k);
            let more = (from + 1..count).take_while(goes_on).count();
            run = from..from + 1 + more;
        }
        let fits = |end: &usize| record.times[*end] - record.times[from] < longest;
        let own = from..from + 1 + (from + 1..run.end).take_while(fits).count() / 2 * 2;
        from = own.end;
        let around = own.start.saturating_sub(own.len()).max(run.start)..(own.end + own.len()).min(run.end);
        // Where nothing is touched there is nothing to average, and the motion follows from that at its first sample: a step over the last force and all
        // of a flight would have that force wane all along.
        let flies = |k: usize| record.contacts[k].is_empty();
        if !flies(own.start) || alone(own.start) || !flies(own.start - 1) {
            all.push(Window { own, around });
        }
    }
    all
}

/// The parabola through the samples around a window, in time after its middle over `scale`. None with too few of them.
struct Parabola {
    scale: f64,
    coefficients: Matrix3<f64>,
}

impl Parabola {
    fn new(window: &Window, times: &[f64], value: impl Fn(usize) -> DVec3) -> Option<Self> {
        let row = Self::row(window, times)?;
        let (mut normal, mut right) = (Matrix3::zeros(), Matrix3::zeros());
        for k in window.around.clone() {
            normal.ger(1.0, &row(k), &row(k), 1.0);
            right.ger(1.0, &row(k), &Vector3::from(value(k)), 1.0);
        }
        Some(Self { scale: Self::scale(window, times), coefficients: normal.cholesky()?.solve(&right) })
    }

    fn scale(window: &Window, times: &[f64]) -> f64 {
        times[window.around.end - 1] - times[window.around.start]
    }

    /// What the coefficients count by at each sample. None with too few of them.
    fn row(window: &Window, times: &[f64]) -> Option<impl Fn(usize) -> Vector3<f64>> {
        let (scale, middle) = (Self::scale(window, times), times[window.middle()]);
        (window.averaged() > 1).then_some(move |k: usize| {
            let s = (times[k] - middle) / scale;
            Vector3::new(1.0, s, s * s)
        })
    }

    /// Its value at a time after the middle.
    fn at(&self, after: f64) -> DVec3 {
        let s = after / self.scale;
        let value = self.coefficients.transpose() * Vector3::new(1.0, s, s * s);
        DVec3::new(value[0], value[1], value[2])
    }
}

/// Samples, and their weights in the value at the middle of a window: the mean over the window, less what slope and bend of the parabola through
/// the samples around add to it. With too few of these the middle one stands for all.
pub(super) fn weights(window: &Window, times: &[f64]) -> (Range<usize>, Vec<f64>) {
    let one = || {
        let row = Parabola::row(window, times)?;
        let normal: Matrix3<f64> = window.around.clone().map(|k| row(k) * row(k).transpose()).sum();
        let count = window.own.len() as f64;
        let mean: Vector3<f64> = window.own.clone().map(|k| row(k) / count).sum();
        let bend = normal.cholesky()?.solve(&Vector3::new(0.0, mean[1], mean[2]));
        let share = |k: usize| if window.own.contains(&k) { count.recip() } else { 0.0 };
        Some(window.around.clone().map(|k| share(k) - bend.dot(&row(k))).collect())
    };
    let middle = window.middle();
    one().map_or((middle..middle + 1, vec![1.0]), |weights| (window.around.clone(), weights))
}

impl Record {
    /// One sample a window of at most `longest`, s, at its middle.
    pub(super) fn averaged(&self, longest: f64) -> Self {
        self.averaged_over(&windows(self, longest))
    }

    /// The same of its `windows`.
    pub(super) fn averaged_over(&self, windows: &[Window]) -> Self {
        let middles: Vec<usize> = windows.iter().map(Window::middle).collect();
        let wrench = |window: &Window| {
            let sum = self.wrenches[window.own.clone()].iter().fold(Wrench::default(), |sum, w| sum + *w);
            sum * (1.0 / window.own.len() as f64)
        };
        let smoothed = |some: &[Window]| some.iter().map(|window| self.smoothed(window)).collect();
        let contacts = of_some(self.times.len(), windows, smoothed);
        let mut averaged = self.picked(&middles, contacts, windows.iter().map(wrench).collect());
        averaged.share_errors(self, windows);
        averaged
    }

    /// At some of its samples, with these contacts and wrenches there. What forces did in between is kept.
    fn picked(&self, picked: &[usize], contacts: Vec<Vec<Contact>>, wrenches: Vec<Wrench>) -> Self {
        let between: Vec<Range<usize>> = picked.windows(2).map(|k| k[0]..k[1]).collect();
        Self {
            times: picked.iter().map(|&k| self.times[k]).collect(),
            samples: picked.iter().map(|&k| self.samples[k]).collect(),
            origin: self.origin,
            contacts,
            wrenches,
            intervals: of_some(self.times.len(), &between, |some| {
                some.iter().map(|between| sum(&self.intervals[between.clone()])).collect()
            }),
            all_impulses: self.all_impulses,
            by_samples: self.by_samples,
            misread: Vec::new(),
            misread_forces: Vec::new(),
            across: self.across,
            deviation: self.deviation,
        }
    }

    /// Whether all palms that are touched are known to be without friction.
    pub(super) fn frictionless(&self) -> bool {
        self.contacts.iter().flatten().all(|contact| contact.frictionless)
    }

    /// Some neighbouring samples.
    pub(super) fn part(&self, samples: Range<usize>) -> Self {
        Self {
            times: self.times[samples.clone()].to_vec(),
            samples: self.samples[samples.clone()].to_vec(),
            origin: self.origin,
            contacts: self.contacts[samples.clone()].to_vec(),
            wrenches: self.wrenches[samples.clone()].to_vec(),
            intervals: self.intervals[samples.start..samples.end - 1].to_vec(),
            all_impulses: self.all_impulses,
            by_samples: self.by_samples,
            misread: Vec::new(),
            misread_forces: Vec::new(),
            across: self.across,
            deviation: self.deviation,
        }
    }

    /// Numbers of samples at least `apart` from each other, s, the first and the last among them, and those after blows.
    pub(super) fn spaced(&self, apart: f64) -> Vec<usize> {
        let times = &self.times;
        let last = times.len() - 1;
        let mut picked = vec![0];
        for k in 1..last {
            if self.intervals[k - 1].blow || times[k] - times[picked[picked.len() - 1]] >= apart {
                picked.push(k);
            }
        }
        picked.push(last);
        picked.dedup();
        picked
    }

    /// Without most of its samples, where there are many more than one in `apart`, s.
    pub(super) fn thinned(&self, apart: f64) -> Option<Self> {
        let picked = self.spaced(apart);
        (THINNED * picked.len() <= self.times.len()).then(|| {
            let contacts = picked.iter().map(|&k| self.contacts[k].clone()).collect();
            self.picked(&picked, contacts, picked.iter().map(|&k| self.wrenches[k]).collect())
        })
    }

    /// Contacts of the sample in the middle of a window.
    fn smoothed(&self, window: &Window) -> Vec<Contact> {
        let (around, weights) = weights(window, &self.times);
        let one = |(i, contact): (usize, &Contact)| {
            // What slope and bend add is noisy too, most where there are samples on one side alone.
            let share = |k: usize, weight: f64| weight / self.contacts[k][i].samples;
            let square: f64 =
                around.clone().zip(&weights).map(|(k, weight)| weight * share(k, *weight)).sum();
            let samples = square.recip();
            let all = || around.clone().map(|k| &self.contacts[k][i]).zip(&weights);
            let of = |of: fn(&Contact) -> DVec3| all().map(|(c, weight)| of(c) * *weight).sum::<DVec3>();
            let c = of(|c| c.c);
            // Of the sum of the errors under an impulse as much as the mean's own error tells.
            let impulse = |part: Range<usize>| {
                let inside = around.clone().zip(&weights).filter(|(k, _)| part.contains(k));
                let of =
                    |(k, weight): (usize, &f64)| self.contacts[k][i].J_after * (share(k, *weight) * samples);
                inside.map(of).sum::<DVec3>()
            };
            let middle = window.middle();
            Contact {
                c,
                n: of(|c| c.n).normalize_or(contact.n),
                u: contact.u + contact.W.cross(c - contact.c),
                f: of(|c| c.f),
                samples,
                J_before: impulse(window.own.start..middle),
                J_after: impulse(middle..window.own.end),
                ..*contact
            }
        };
        self.contacts[window.middle()].iter().enumerate().map(one).collect()
    }
}

/// Neighbouring intervals as one.
fn sum(intervals: &[Interval]) -> Interval {
    let (impulse, first, noise) = (Wrench::default(), DVec3::ZERO, WrenchNoise::default());
    let mut sum = Interval { h: 0.0, impulse, first, noise, blow: false, parts: 1 };
    for interval in intervals {
        sum.first += interval.first + interval.impulse.force * sum.h;
        sum.h += interval.h;
        sum.impulse = sum.impulse + interval.impulse;
        sum.noise += interval.noise;
        sum.blow |= interval.blow;
        sum.parts += interval.parts - 1;
    }
    sum
}
