//! Friction of pushes over their slip: a weighted line, and how well its ends are known.

use super::modes::{Common, Odds, REFERENCE, WEIGHT, Window};
use std::collections::BTreeMap;

/// Windows' worth of sliding, each of the weight that counts, from which on a push counts as sliding.
const SLIDES: f64 = 0.5;
/// Slip beyond which a window surely slips: in its deviations, and in speeds of the finger, as paths are off by some of that.
const SLIPS: f64 = 2.0;
const LEAST_SLIP: f64 = 0.15;
/// Deviation of what friction may gain by a slip as fast as the finger, before anything is seen.
const SLOPE: f64 = 0.1;
/// Degrees of freedom of the distribution of friction among pushes.
pub(super) const STUDENT: f64 = 4.0;

/// What a push says of friction.
#[derive(Clone, Copy, Default)]
pub(super) struct Sliding {
    /// Windows' worth of sliding to the left and to the right.
    pub(super) counts: [f64; 2],
    /// Mean ratio, by its size.
    pub(super) mean: f64,
    /// Mean slip, in speeds of the finger.
    pub(super) slip: f64,
}

impl Sliding {
    /// By the windows that surely slip: contacts that stick next to the cone would pull friction towards their ratio.
    pub(super) fn of(windows: &[Window], odds: &[Odds], common: &Common) -> Self {
        let mut counts = [0.0; 2];
        let (mut ratio, mut slip) = (0.0, 0.0);
        let surely = |w: &Window| w.slip.abs() > (SLIPS * common.slip).max(LEAST_SLIP);
        for (window, [_, left, right]) in windows.iter().zip(odds).filter(|(w, _)| surely(w)) {
            counts = [counts[0] + WEIGHT * left, counts[1] + WEIGHT * right];
            ratio += WEIGHT * window.ratio * (left - right);
            slip += WEIGHT * window.slip * (left - right);
        }
        let all = (counts[0] + counts[1]).max(f64::MIN_POSITIVE);
        Self { counts, mean: ratio / all, slip: (slip / all).max(0.0) }
    }

    pub(super) fn count(&self) -> f64 {
        self.counts[0] + self.counts[1]
    }

    pub(super) fn slides(&self) -> bool {
        self.count() > SLIDES
    }

    /// What its mean ratio exceeds that of all at its slip by.
    pub(super) fn beyond(&self, common: &Common) -> f64 {
        self.mean - common.at(self.slip)
    }

    /// Variance of its mean about the friction of all.
    pub(super) fn variance(&self, common: &Common) -> f64 {
        common.of_push.powi(2) + common.ratio.powi(2) / self.count()
    }

    /// By how much friction of the push exceeds that of all, by its own sliding; and the variance that is left.
    pub(super) fn own(&self, common: &Common) -> (f64, f64) {
        let (prior, said) = (common.of_push.powi(-2), self.count() * common.ratio.powi(-2));
        if said == 0.0 {
            return (0.0, 1.0 / prior);
        }
        (self.beyond(common) * said / (prior + said), 1.0 / (prior + said))
    }
}

/// The weighted line of friction over slip, whose slope has a prior about none.
pub(super) struct Line {
    weights: Vec<f64>,
    /// Sums of weights times powers of the slip beyond the reference; the prior in the last one.
    pub(super) sums: [f64; 3],
}

impl Line {
    /// Weights by variance, less for outliers.
    pub(super) fn new(sliding: &[Sliding], common: &Common) -> Self {
        let one = |s: &Sliding| {
            if !s.slides() {
                return 0.0;
            }
            let variance = s.variance(common);
            (STUDENT + 1.0) / (STUDENT + s.beyond(common).powi(2) / variance) / variance
        };
        let weights: Vec<f64> = sliding.iter().map(one).collect();
        let sum = |k| sliding.iter().zip(&weights).map(|(s, w)| w * (s.slip - REFERENCE).powi(k)).sum();
        let [zeroth, first, second]: [f64; 3] = [0, 1, 2].map(sum);
        Self { weights, sums: [zeroth, first, second + SLOPE.powi(-2)] }
    }

    fn determinant(&self) -> f64 {
        self.sums[0] * self.sums[2] - self.sums[1].powi(2)
    }

    /// Shares of a push in the friction at the reference and in the slope.
    fn share(&self, slip: f64, weight: f64) -> [f64; 2] {
        if self.sums[0] <= 0.0 {
            return [0.0; 2];
        }
        let (x, [zeroth, first, second]) = (slip - REFERENCE, self.sums);
        [second - first * x, zeroth * x - first].map(|part| weight * part / self.determinant())
    }

    /// Friction at the reference, and its slope.
    pub(super) fn fitted(&self, sliding: &[Sliding]) -> [f64; 2] {
        let parts =
            sliding.iter().zip(&self.weights).map(|(s, w)| self.share(s.slip, *w).map(|part| part * s.mean));
        parts.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d])
    }

    /// Variances of both, by what the pushes scatter about the line: each by itself, or those of one place and side together, whichever is
    /// more (White 1980; Liang and Zeger 1986).
    pub(super) fn covariance(&self, sliding: &[Sliding], common: &Common, places: &[usize]) -> [f64; 2] {
        let mut by_place: BTreeMap<(usize, bool), [f64; 2]> = BTreeMap::new();
        let (mut alone, mut count) = ([0.0; 2], 0.0);
        for ((s, w), place) in sliding.iter().zip(&self.weights).zip(places).filter(|((_, w), _)| **w > 0.0) {
            let off = s.beyond(common);
            let parts = self.share(s.slip, *w).map(|part| part * off);
            let sum = by_place.entry((*place, s.counts[0] > s.counts[1])).or_default();
            for i in 0..2 {
                alone[i] += parts[i] * parts[i];
                sum[i] += parts[i];
            }
            count += 1.0;
        }
        // What the prior adds if it is off by its deviation.
        let prior = [self.sums[1], self.sums[0]].map(|sum| (sum / (self.determinant() * SLOPE)).powi(2));
        let groups = by_place.len() as f64;
        let wider = |count: f64| count / (count - 2.0).max(1.0);
        [0, 1].map(|i| {
            let together: f64 = by_place.values().map(|sum| sum[i] * sum[i]).sum();
            (alone[i] * wider(count)).max(together * wider(groups)) + prior[i]
        })
    }

    /// Share of each push in the friction at the reference, times 1 where it slides to the left, -1 to the right.
    pub(super) fn shares(&self, sliding: &[Sliding]) -> Vec<f64> {
        let side = |s: &Sliding| (s.counts[0] - s.counts[1]) / s.count().max(f64::MIN_POSITIVE);
        sliding.iter().zip(&self.weights).map(|(s, w)| self.share(s.slip, *w)[0] * side(s)).collect()
    }
}
