//! Which values of a reading of a palm leave its way.

use super::{AMONG, BESIDE, Told, Way};
use glam::DVec3;

/// Deviations from which on a value is off: of what the motion itself leaves of a cubic at most samples, and of what noise does.
pub(in crate::contacts) const OFF: f64 = 8.0;
const NOISE: f64 = 4.5;
/// Deviations of noise from which on one is off that the cubic alone tells of: noise of two axes leaves one of 65 million.
const ALONE: f64 = 6.0;
/// Times what the cubic leaves of those around, too.
const STANDS_OUT: f64 = 2.0;
/// Share of the spread of all values of a palm that one is off by at least: at 3e-4 two of 24 logs as good as exact had right contacts put elsewhere, where an
/// object turns within a sample or two.
const NOTABLE: f64 = 3e-3;
/// Neighbours that may be off together: more are a motion that turns sharply.
pub(in crate::contacts) const TOGETHER: usize = 2;
/// Share of a palm's values beyond which they are not outliers but what the sensor is like.
pub(in crate::contacts) const MOST: f64 = 0.05;
/// Root of one and the squared weights of a cubic through two values on either side, evenly spaced: noise of what a value is off it by over that of one.
const OF_CUBIC: f64 = 1.394;
/// Fewest values of a palm whose scatter can be told.
pub(in crate::contacts) const FEWEST: usize = 20;
/// Values of a palm that tell the scatter of all of them, at most.
const TELL: usize = 5000;
/// Median of the length of a vector of two standard normal numbers.
pub(in crate::contacts) const MEDIAN_LENGTH: f64 = 1.177_410_022_515_474_7;

/// A value that is off.
#[derive(Clone, Copy, Debug)]
pub(in crate::contacts) struct Off {
    pub(in crate::contacts) sample: usize,
    /// What others say that it is.
    pub(in crate::contacts) told: Told,
    /// How far the same puts values around it from what they are, at most.
    pub(in crate::contacts) around: f64,
}

impl Way {
    /// Whether each value is the one before once more, while those before and after it change: none is where many are.
    fn stale(&self) -> Vec<bool> {
        let count = self.points.len();
        let changes = |j: usize| j + 1 < count && self.points[j] != self.points[j + 1];
        let one = |j: usize| self.repeated[j] && self.steady[j] && j > 1 && changes(j) && changes(j - 2);
        let all: Vec<bool> = (0..count).map(one).collect();
        let many = all.iter().filter(|stale| **stale).count() as f64 > MOST * count as f64;
        if many { vec![false; count] } else { all }
    }

    /// The values that are off; `deviation` is that of one. Where the way is `smooth` one alone is told by that, however fast the others run.
    pub(in crate::contacts) fn off(&self, deviation: f64, smooth: bool) -> Vec<Off> {
        let count = self.points.len();
        if count < FEWEST {
            return Vec::new();
        }
        // Medians are not misled by a few that are off, but by the bend of the way; cubics the other way round.
        let left = |j: usize| self.points[j].distance(self.usual(j));
        let most = self.limit(deviation, left);
        let stale = self.stale();
        let mut suspected: Vec<bool> =
            (0..count).map(|j| stale[j] || self.steady[j] && left(j) > most).collect();
        if smooth && deviation > 0.0 {
            self.suspect_alone(deviation, &mut suspected);
        }
        let left = |j: usize| self.left_at(j, &suspected).unwrap_or(0.0);
        let most = self.limit(deviation, left);
        let is_off = |&j: &usize| stale[j] || suspected[j] && self.leaves(j, left(j), most, &suspected);
        let off: Vec<usize> = (0..count).filter(is_off).collect();
        let together = off.chunk_by(|a, b| *b == a + 1).filter(|run| run.len() <= TOGETHER);
        let one = |&j: &usize| {
            let told = self.told(j, &suspected)?;
            Some(Off { sample: self.samples[j], told, around: self.around(j, &suspected) })
        };
        let off: Vec<_> = together.flatten().filter_map(one).collect();
        if off.len() as f64 > MOST * count as f64 { Vec::new() } else { off }
    }

    /// Suspects those, too, that are further off the cubic through those beside them than all around are: medians of a way that runs fast elsewhere
    /// do not tell of them. At most so many as may be outliers.
    fn suspect_alone(&self, deviation: f64, suspected: &mut [bool]) {
        let count = suspected.len();
        for _ in 0..(MOST * count as f64) as usize {
            let left: Vec<f64> = (0..count).map(|j| self.left_at(j, suspected).unwrap_or(0.0)).collect();
            let most = self.limit(deviation, |j| left[j]).max(ALONE * deviation);
            let is_largest = |j: usize| {
                let mut near = j.saturating_sub(AMONG)..(j + AMONG + 1).min(count);
                near.all(|i| suspected[i] || left[i] <= left[j])
            };
            let is_alone = |&j: &usize| {
                !suspected[j] && self.steady[j] && self.leaves(j, left[j], most, suspected) && is_largest(j)
            };
            // All around are off as much where the way itself turns within few samples.
            let stands_out = |&j: &usize| {
                let mut others = suspected.to_vec();
                others[j] = true;
                left[j] > STANDS_OUT * self.around(j, &others)
            };
            let more: Vec<usize> = (0..count).filter(is_alone).filter(stands_out).collect();
            if more.is_empty() {
                return;
            }
            more.iter().for_each(|&j| suspected[j] = true);
        }
    }

    /// By how much values are off at least, of which most are `left` so far from what others say.
    fn limit(&self, deviation: f64, left: impl Fn(usize) -> f64) -> f64 {
        let count = self.points.len();
        let mean = self.points.iter().sum::<DVec3>() / count as f64;
        let square = self.points.iter().map(|point| point.distance_squared(mean)).sum::<f64>();
        let spread = (square / count as f64).sqrt();
        // Of long logs some tell the scatter as well as all do.
        let every = count.div_ceil(TELL).max(1);
        let mut scatter: Vec<f64> = (0..count).step_by(every).map(left).filter(|left| *left > 0.0).collect();
        let middle = scatter.len() / 2;
        let usual = if scatter.is_empty() {
            f64::INFINITY
        } else {
            *scatter.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN_LENGTH
        };
        // Noise makes no tails; a motion that bends does.
        let bent = (usual * usual - deviation * deviation).max(0.0).sqrt();
        (NOISE * deviation).max(OFF * bent).max(NOTABLE * spread)
    }

    /// Whether a value that is `left` so far from what others say that are not `out` leaves its way, which it does from `most` on.
    fn leaves(&self, j: usize, left: f64, most: f64, out: &[bool]) -> bool {
        let limit = most + self.bends[j];
        left > limit
            && !(self.changes_speed(j, OF_CUBIC * left, out) && self.goes_on(j, OF_CUBIC * limit, out))
    }

    /// Whether the way may change its speed next to a value so much that the cubic through those beside it is so far off it: which
    /// takes three times that in a step, of which noise and what the way bends besides may hide some. Where there are too few to tell of it, it may.
    fn changes_speed(&self, j: usize, off: f64, out: &[bool]) -> bool {
        let beside = self.beside(j, out);
        let [a, b, c, d] = beside.of;
        if beside.count < 2 * BESIDE || b > j || c < j {
            return true;
        }
        // The nearer ones come first on either side.
        let speed = |i: usize, k: usize| (self.points[k] - self.points[i]) / (self.times[k] - self.times[i]);
        let step = 0.5 * (self.times[c] - self.times[a]);
        (speed(c, d) - speed(b, a)).length() * step > off
    }

    /// Whether a contact is where the way from one side leads, to within so many metres, by the line through two contacts there or the parabola through three;
    /// where there is a fourth, by that with it in place of the third as well: a third that is off by as much as this one leads to it.
    ///
    /// Where the curvature of the object jumps, its contact changes its speed from one sample to the next: nothing that is smooth over both sides leads there.
    fn goes_on(&self, j: usize, within: f64, out: &[bool]) -> bool {
        let near = |other: &usize| self.samples[*other].abs_diff(self.samples[j]) <= AMONG;
        let before: Vec<usize> = (0..j).rev().take(AMONG).filter(near).collect();
        let after: Vec<usize> = (j + 1..self.points.len()).take(AMONG).filter(near).collect();
        let leads = |few: &[usize]| self.through(few, j).value.distance(self.points[j]) <= within;
        let side_leads = |side: &[usize]| match *side {
            [a, b, c, d, ..] => leads(&[a, b]) || (leads(&[a, b, c]) && leads(&[a, b, d])),
            [a, b, c] => leads(&[a, b]) || leads(&[a, b, c]),
            [a, b] => leads(&[a, b]),
            _ => false,
        };
        // Those that may be off themselves as well, and without them: so few in a row lead to no other one.
        [before, after].iter().any(|side| {
            let others: Vec<usize> = side.iter().copied().filter(|other| !out[*other]).collect();
            side_leads(side) || others.len() < side.len() && side_leads(&others)
        })
    }
}
