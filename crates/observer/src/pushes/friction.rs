//! The coefficient of friction from all pushes, and the modes that go with it: expectation and maximisation in turn.

use super::line::{Line, STUDENT, Sliding};
use super::modes::{Common, Odds, Window, smoothed};
use super::touches::quantile;

/// Slip that is surely one to begin with, in speeds of the finger.
const SLIPS: f64 = 0.2;
/// Windows of such slip from which friction is learned, and pushes that must slide in the end.
const FEWEST_WINDOWS: usize = 10;
const FEWEST_PUSHES: usize = 4;
/// Deviations at first.
const FIRST: f64 = 0.05;
/// Deviation of friction from push to push before any was seen, in shares of it, and the pushes that this counts as: from some fifteen that
/// slide their scatter alone is at times nothing, and then friction would be the same for all time (Chung et al. 2013).
const OF_PUSH: f64 = 0.06;
const SEEN: f64 = 4.0;
/// Least deviation of a slip, in speeds of the finger, and of a ratio: that of a face known to half a degree.
const LEAST: f64 = 0.01;
/// Largest deviation of a slip.
const MOST: f64 = 0.3;
/// Rounds, by which nothing moves any more in the fourth digit.
const ROUNDS: usize = 40;

/// Friction and modes of all pushes.
pub(super) struct Learned {
    pub(super) common: Common,
    /// Odds of each window of each push.
    pub(super) odds: Vec<Vec<Odds>>,
    /// Share that each push has in the friction, times 1 where it slides to the left, -1 to the right.
    pub(super) shares: Vec<f64>,
    /// Own coefficient of each push that slides.
    pub(super) own: Vec<Option<f64>>,
    /// Variance of the friction, without that of the outline; none where too little slides.
    pub(super) variance: Option<f64>,
    /// Variance of its change with slip.
    pub(super) slope_variance: f64,
}

/// Learns friction and modes. `places` tells where each push touches: pushes at one place share what is wrong with its direction.
pub(super) fn learn(pushes: &[Vec<Window>], places: &[usize]) -> Learned {
    let surely = |w: &&Window| w.slip.abs() > SLIPS && w.slip * w.ratio > 0.0;
    let ratios: Vec<f64> = pushes.iter().flatten().filter(surely).map(|w| w.ratio.abs()).collect();
    let learns = ratios.len() >= FEWEST_WINDOWS;
    // Where nothing slides, friction is no less than what is seen.
    let seen: Vec<f64> = pushes.iter().flatten().map(|w| w.ratio.abs()).collect();
    let friction = if learns { quantile(ratios, 0.5) } else { quantile(seen, 0.95).max(LEAST) };
    let common = Common { friction, by_slip: 0.0, of_push: FIRST, ratio: FIRST, slip: FIRST };
    let sliding = vec![Sliding::default(); pushes.len()];
    let odds = expect(pushes, &sliding, &common);
    let mut state = State { pushes, common, sliding, odds };
    if learns {
        state.go_on();
    }
    let State { common, sliding, odds, .. } = state;
    let line = Line::new(&sliding, &common);
    let enough = learns && sliding.iter().filter(|s| s.slides()).count() >= FEWEST_PUSHES;
    let covariance = line.covariance(&sliding, &common, places);
    Learned {
        shares: line.shares(&sliding),
        own: sliding.iter().map(|s| s.slides().then_some(s.mean)).collect(),
        variance: enough.then_some(covariance[0]),
        slope_variance: covariance[1],
        common,
        odds,
    }
}

/// What is believed so far.
struct State<'a> {
    pushes: &'a [Vec<Window>],
    common: Common,
    sliding: Vec<Sliding>,
    odds: Vec<Vec<Odds>>,
}

impl State<'_> {
    /// Modes and friction in turn.
    fn go_on(&mut self) {
        for _ in 0..ROUNDS {
            self.sliding =
                self.pushes.iter().zip(&self.odds).map(|(w, o)| Sliding::of(w, o, &self.common)).collect();
            self.common = maximise(self.pushes, &self.odds, &self.sliding, self.common);
            self.odds = expect(self.pushes, &self.sliding, &self.common);
        }
    }
}

fn expect(pushes: &[Vec<Window>], sliding: &[Sliding], common: &Common) -> Vec<Vec<Odds>> {
    let one = |(windows, s): (&Vec<Window>, &Sliding)| smoothed(windows, s.own(common), common);
    pushes.iter().zip(sliding).map(one).collect()
}

fn maximise(pushes: &[Vec<Window>], odds: &[Vec<Odds>], sliding: &[Sliding], common: Common) -> Common {
    let line = Line::new(sliding, &common);
    if line.sums[0] <= 0.0 {
        return common;
    }
    let [friction, by_slip] = line.fitted(sliding);
    let common = Common { friction: friction.max(LEAST), by_slip, ..common };
    let (mut of_push, mut slides) = (SEEN * (OF_PUSH * common.friction).powi(2), SEEN);
    for s in sliding.iter().filter(|s| s.slides()) {
        let (own, open) = s.own(&common);
        // Outliers count less here too.
        let far = s.beyond(&common).powi(2) / s.variance(&common);
        of_push += (STUDENT + 1.0) / (STUDENT + far) * own.powi(2) + open;
        slides += 1.0;
    }
    let (mut ratio, mut slid, mut slip, mut stuck) = (0.0, 0.0, 0.0, 0.0);
    for ((windows, odds), s) in pushes.iter().zip(odds).zip(sliding) {
        let own = s.own(&common).0;
        for (w, [stick, left, right]) in windows.iter().zip(odds) {
            let friction = own + common.at(w.slip.abs());
            ratio += left * (w.ratio - friction).powi(2) + right * (w.ratio + friction).powi(2);
            slid += left + right;
            slip += stick * w.slip.powi(2);
            stuck += stick;
        }
    }
    let root =
        |sum: f64, count: f64, otherwise: f64| if count > 1.0 { (sum / count).sqrt() } else { otherwise };
    Common {
        of_push: root(of_push, slides, common.of_push).max(LEAST),
        ratio: root(ratio, slid, common.ratio).max(LEAST),
        slip: root(slip, stuck, common.slip).clamp(LEAST, MOST),
        ..common
    }
}
