//! Neighbouring samples of a record taken together, as far as that loses nothing.
//!
//! Each sample has a contact whose noise is a noise of its condition, and a node whose motion the noise of a force moves. Where
//! both are of one size a node follows its own contact, and least squares over so many nodes find the body wrong by several of their
//! deviations. A contact averaged over a window leaves the condition in the window's middle as it is, with less noise.

use super::noise::{ContactNoiseLevel, WrenchNoise};
use super::problem::Units;
use super::record::{Contact, Interval, Record, Wrench};
use glam::DVec3;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// Longest window over the natural time: as long as a parabola is enough.
const LONGEST: f64 = 0.1;

/// Samples that a parabola is laid through at least.
const FEWEST: usize = 5;

/// Longest window to average contacts over, s: none where their noise is not what limits a condition.
pub(super) fn longest(noise: &ContactNoiseLevel, units: &Units) -> f64 {
    let rate = units.speed / units.length;
    if noise.contact * rate > noise.floor { LONGEST / rate } else { 0.0 }
}

/// A window of samples in the middle one of which there is to be a node, and the samples around it with the same contacts in
/// the same modes.
struct Window {
    own: Range<usize>,
    around: Range<usize>,
}

impl Window {
    fn middle(&self) -> usize {
        usize::midpoint(self.own.start, self.own.end - 1)
    }

    /// Samples whose contacts are averaged: where there are too few around for a parabola, the middle one stands for all.
    fn averaged(&self) -> usize {
        if self.around.len() < FEWEST { 1 } else { self.own.len() }
    }
}

/// Windows of an odd number of samples.
fn windows(record: &Record, longest: f64) -> Vec<Window> {
    let count = record.times.len();
    let touched = |k: usize| record.contacts[k].iter().map(|contact| (contact.palm, contact.mode));
    let same = |a: usize, b: usize| touched(a).eq(touched(b));
    let mut all = Vec::new();
    let alone = |k: usize| k == 0 || k == count - 1 || record.beside_blow(k);
    let mut run = 0..0;
    let mut from = 0;
    while from < count {
        if from == run.end {
            // Nodes are at the first sample and the last, so that all lie between two, and on both sides of a blow.
            let more = (from + 1..count).take_while(|&k| !alone(from) && !alone(k) && same(from, k)).count();
            run = from..from + 1 + more;
        }
        let fits = |end: &usize| record.times[*end] - record.times[from] < longest;
        let own = from..from + 1 + (from + 1..run.end).take_while(fits).count() / 2 * 2;
        from = own.end;
        let around = own.start.saturating_sub(own.len()).max(run.start)..(own.end + own.len()).min(run.end);
        // Where nothing is touched there is nothing to average, and the motion follows from that before.
        if !record.contacts[own.start].is_empty() || alone(own.start) {
            all.push(Window { own, around });
        }
    }
    all
}

/// Value at the middle of a window: the mean, less what slope and bend of a parabola through the samples around add to it.
fn at_middle(window: &Window, times: &[f64], value: impl Fn(usize) -> DVec3) -> DVec3 {
    if window.averaged() == 1 {
        return value(window.middle());
    }
    let own = &window.own;
    let share = 1.0 / own.len() as f64;
    let after = |k: usize| times[k] - times[window.middle()];
    let mean = own.clone().map(&value).sum::<DVec3>() * share;
    let scale = times[window.around.end - 1] - times[window.around.start];
    let (mut normal, mut right) = (Matrix3::zeros(), Matrix3::zeros());
    for k in window.around.clone() {
        let s = after(k) / scale;
        let row = Vector3::new(1.0, s, s * s);
        normal.ger(1.0, &row, &row, 1.0);
        right.ger(1.0, &row, &Vector3::from(value(k)), 1.0);
    }
    let Some(factor) = normal.cholesky() else { return mean };
    let parabola = factor.solve(&right);
    let moment = |power: i32| own.clone().map(|k| (after(k) / scale).powi(power)).sum::<f64>() * share;
    let bend = parabola.row(1) * moment(1) + parabola.row(2) * moment(2);
    mean - DVec3::new(bend[0], bend[1], bend[2])
}

impl Record {
    /// One sample a window, at its middle.
    pub(super) fn averaged(&self, longest: f64) -> Self {
        let windows = windows(self, longest);
        let middles: Vec<usize> = windows.iter().map(Window::middle).collect();
        let wrench = |window: &Window| {
            let sum = self.wrenches[window.own.clone()].iter().fold(Wrench::default(), |sum, w| sum + *w);
            sum * (1.0 / window.own.len() as f64)
        };
        Self {
            times: middles.iter().map(|&k| self.times[k]).collect(),
            samples: middles.iter().map(|&k| self.samples[k]).collect(),
            origin: self.origin,
            contacts: windows.iter().map(|window| self.smoothed(window)).collect(),
            wrenches: windows.iter().map(wrench).collect(),
            all_impulses: self.all_impulses,
            intervals: middles.windows(2).map(|k| sum(&self.intervals[k[0]..k[1]])).collect(),
        }
    }

    /// Contacts of the sample in the middle of a window.
    fn smoothed(&self, window: &Window) -> Vec<Contact> {
        let one = |(i, contact): (usize, &Contact)| {
            let of = |of: fn(&Contact) -> DVec3| at_middle(window, &self.times, |k| of(&self.contacts[k][i]));
            let c = of(|c| c.c);
            Contact {
                c,
                n: of(|c| c.n).normalize_or(contact.n),
                u: contact.u + contact.W.cross(c - contact.c),
                f: of(|c| c.f),
                samples: window.averaged(),
                ..*contact
            }
        };
        self.contacts[window.middle()].iter().enumerate().map(one).collect()
    }
}

/// Neighbouring intervals as one.
fn sum(intervals: &[Interval]) -> Interval {
    let none = Interval {
        h: 0.0,
        impulse: Wrench::default(),
        first: DVec3::ZERO,
        noise: WrenchNoise::default(),
        blow: false,
    };
    intervals.iter().fold(none, |sum, interval| Interval {
        h: sum.h + interval.h,
        impulse: sum.impulse + interval.impulse,
        first: sum.first + interval.first + interval.impulse.force * sum.h,
        noise: sum.noise + interval.noise,
        blow: sum.blow || interval.blow,
    })
}
