//! The coefficient of friction from all pushes, and the modes that go with it: expectation and maximisation in turn.

use super::modes::{Common, Odds, WEIGHT, Window, smoothed};
use super::touches::quantile;

/// Slip that is surely one to begin with, in speeds of the finger.
const SLIPS: f64 = 0.2;
/// Windows of such slip from which friction is learned, and pushes that must slide in the end.
const FEWEST_WINDOWS: usize = 10;
const FEWEST_PUSHES: usize = 3;
/// Deviations at first.
const FIRST: f64 = 0.05;
/// Least deviation of a slip, in speeds of the finger, and of a ratio: that of a face known to half a degree.
const LEAST: f64 = 0.01;
/// Largest deviation of a slip.
const MOST: f64 = 0.3;
/// Rounds, by which nothing moves any more in the fourth digit.
const ROUNDS: usize = 30;
/// Windows' worth of sliding, each of the weight that counts, from which on a push counts as sliding.
const SLIDES: f64 = 0.5;
/// Degrees of freedom of the distribution of friction among pushes.
const STUDENT: f64 = 4.0;

/// Friction and modes of all pushes.
pub(super) struct Learned {
    pub(super) common: Common,
    /// Odds of each window of each push.
    pub(super) odds: Vec<Vec<Odds>>,
    /// Share that each push has in the friction, and its side: `weight * (left - right)`. Weights sum to one.
    pub(super) shares: Vec<[f64; 2]>,
    /// Own coefficient of each push that slides.
    pub(super) own: Vec<Option<f64>>,
    /// Variance of the friction, without that of the outline; none where too little slides.
    pub(super) variance: Option<f64>,
}

/// What a push says of friction.
#[derive(Clone, Copy, Default)]
struct Sliding {
    /// Windows' worth of sliding to the left and to the right.
    counts: [f64; 2],
    /// Mean ratio, by its size.
    mean: f64,
}

impl Sliding {
    fn of(windows: &[Window], odds: &[Odds]) -> Self {
        let mut counts = [0.0; 2];
        let mut sum = 0.0;
        for (window, [_, left, right]) in windows.iter().zip(odds) {
            counts = [counts[0] + WEIGHT * left, counts[1] + WEIGHT * right];
            sum += WEIGHT * window.ratio * (left - right);
        }
        let all = counts[0] + counts[1];
        Self { counts, mean: if all > 0.0 { sum / all } else { 0.0 } }
    }

    fn count(&self) -> f64 {
        self.counts[0] + self.counts[1]
    }

    /// Variance of its mean about the friction of all.
    fn variance(&self, common: &Common) -> f64 {
        common.of_push.powi(2) + common.ratio.powi(2) / self.count()
    }

    /// Friction of the push, by its own sliding and by that of all.
    fn friction(&self, common: &Common) -> (f64, f64) {
        let (prior, said) = (common.of_push.powi(-2), self.count() * common.ratio.powi(-2));
        ((common.friction * prior + self.mean * said) / (prior + said), 1.0 / (prior + said))
    }
}

/// Learns friction and modes.
pub(super) fn learn(pushes: &[Vec<Window>]) -> Learned {
    let surely = |w: &&Window| w.slip.abs() > SLIPS && w.slip * w.ratio > 0.0;
    let ratios: Vec<f64> = pushes.iter().flatten().filter(surely).map(|w| w.ratio.abs()).collect();
    let learns = ratios.len() >= FEWEST_WINDOWS;
    // Where nothing slides, friction is no less than what is seen.
    let seen: Vec<f64> = pushes.iter().flatten().map(|w| w.ratio.abs()).collect();
    let friction = if learns { quantile(ratios, 0.5) } else { quantile(seen, 0.95).max(LEAST) };
    let mut common = Common { friction, of_push: FIRST, ratio: FIRST, slip: FIRST };
    let mut sliding = vec![Sliding::default(); pushes.len()];
    let mut odds = expect(pushes, &sliding, &common);
    if learns {
        for _ in 0..ROUNDS {
            sliding = pushes.iter().zip(&odds).map(|(w, o)| Sliding::of(w, o)).collect();
            common = maximise(pushes, &odds, &sliding, common);
            odds = expect(pushes, &sliding, &common);
        }
    }
    let weights = weights(&sliding, &common);
    let sum: f64 = weights.iter().sum();
    let enough = learns && sliding.iter().filter(|s| s.count() > SLIDES).count() >= FEWEST_PUSHES;
    let share = |(w, s): (&f64, &Sliding)| {
        let part = if sum > 0.0 { w / sum } else { 0.0 };
        [part, part * (s.counts[0] - s.counts[1]) / s.count().max(f64::MIN_POSITIVE)]
    };
    Learned {
        shares: weights.iter().zip(&sliding).map(share).collect(),
        own: sliding.iter().map(|s| (s.count() > SLIDES).then_some(s.mean)).collect(),
        variance: enough.then(|| variance(&sliding, &weights, &common)),
        common,
        odds,
    }
}

fn expect(pushes: &[Vec<Window>], sliding: &[Sliding], common: &Common) -> Vec<Vec<Odds>> {
    let one = |(windows, sliding): (&Vec<Window>, &Sliding)| {
        smoothed(windows, sliding.friction(common).0.max(LEAST), common)
    };
    pushes.iter().zip(sliding).map(one).collect()
}

/// Weights of the pushes in the mean: by their variance, less for outliers.
fn weights(sliding: &[Sliding], common: &Common) -> Vec<f64> {
    let one = |s: &Sliding| {
        if s.count() <= SLIDES {
            return 0.0;
        }
        let variance = s.variance(common);
        let far = (s.mean - common.friction).powi(2) / variance;
        (STUDENT + 1.0) / (STUDENT + far) / variance
    };
    sliding.iter().map(one).collect()
}

/// Of the weighted mean, by what the pushes scatter about it: this holds whatever makes them scatter.
fn variance(sliding: &[Sliding], weights: &[f64], common: &Common) -> f64 {
    let sum: f64 = weights.iter().sum();
    let count = weights.iter().filter(|w| **w > 0.0).count() as f64;
    let scatter: f64 =
        sliding.iter().zip(weights).map(|(s, w)| (w * (s.mean - common.friction)).powi(2)).sum();
    scatter / sum.powi(2) * count / (count - 1.0).max(1.0)
}

fn maximise(pushes: &[Vec<Window>], odds: &[Vec<Odds>], sliding: &[Sliding], common: Common) -> Common {
    let weights = weights(sliding, &common);
    let sum: f64 = weights.iter().sum();
    if sum <= 0.0 {
        return common;
    }
    let friction = sliding.iter().zip(&weights).map(|(s, w)| w * s.mean).sum::<f64>() / sum;
    let (mut of_push, mut slides) = (0.0, 0.0);
    for s in sliding.iter().filter(|s| s.count() > SLIDES) {
        let (own, open) = s.friction(&common);
        // Outliers count less here too.
        let far = (s.mean - friction).powi(2) / s.variance(&common);
        of_push += (STUDENT + 1.0) / (STUDENT + far) * (own - friction).powi(2) + open;
        slides += 1.0;
    }
    let (mut ratio, mut slid, mut slip, mut stuck) = (0.0, 0.0, 0.0, 0.0);
    for ((windows, odds), s) in pushes.iter().zip(odds).zip(sliding) {
        let own = s.friction(&common).0;
        for (w, [stick, left, right]) in windows.iter().zip(odds) {
            ratio += left * (w.ratio - own).powi(2) + right * (w.ratio + own).powi(2);
            slid += left + right;
            slip += stick * w.slip.powi(2);
            stuck += stick;
        }
    }
    let root =
        |sum: f64, count: f64, otherwise: f64| if count > 1.0 { (sum / count).sqrt() } else { otherwise };
    Common {
        friction: friction.max(LEAST),
        of_push: root(of_push, slides, common.of_push).max(LEAST),
        ratio: root(ratio, slid, common.ratio).max(LEAST),
        slip: root(slip, stuck, common.slip).clamp(LEAST, MOST),
    }
}
