//! Sliding or sticking over time: a chain of three modes over short windows of a push, which looks at the ratio of friction to normal force
//! and at the slip.
//!
//! The classifier of `contact_modes` takes one coefficient of friction for all time. On real tables it differs from push to push by a
//! tenth, which would be told as sticking below it; here each push has its own, about a common mean.

use super::path::PathStep;
use crate::contact_modes::normal::{below, log_density};

/// Length of a window, s: a push of some seconds has dozens.
const WINDOW: f64 = 0.1;
/// Power of what a window says: friction wavers over some tenths of a second, so that neighbours tell the same.
pub(super) const WEIGHT: f64 = 0.25;
/// Probability that a mode lasts from one window to the next: 3 s in the mean.
const STAYS: f64 = 0.97;
/// Slip at which friction is told, in speeds of the finger: where it changes with slip, in the middle of what pushes do.
pub(super) const REFERENCE: f64 = 0.25;
/// Share of windows that no mode explains, and the width over which they are spread, in ratios and in speeds of the finger.
const STRAY: f64 = 1e-3;
const WIDTH: f64 = 4.0;
/// Largest slip, in speeds of the finger: an object that turns can add to it.
const FASTEST: f64 = 1.5;
/// Least coefficient of friction that is looked at.
const LEAST_FRICTION: f64 = 0.01;
/// Share of the median normal force below which a contact is not loaded yet.
const LOADED: f64 = 0.5;

/// A stretch of a push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Friction over normal force.
    pub(super) ratio: f64,
    /// Slip of the finger to the left, in speeds of the finger.
    pub(super) slip: f64,
    /// Steps of the path: the first, and the one after the last.
    pub(super) steps: [usize; 2],
}

/// What is common to all pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Common {
    /// Coefficient of friction at the reference slip.
    pub(super) friction: f64,
    /// What it gains with slip, a speed of the finger.
    pub(super) by_slip: f64,
    /// Its deviation from push to push.
    pub(super) of_push: f64,
    /// Deviation of a ratio about that of its push.
    pub(super) ratio: f64,
    /// Deviation of a slip, in speeds of the finger.
    pub(super) slip: f64,
}

impl Common {
    /// Friction at a slip in speeds of the finger.
    pub(super) fn at(&self, slip: f64) -> f64 {
        (self.friction + self.by_slip * (slip.min(FASTEST) - REFERENCE)).max(LEAST_FRICTION)
    }
}

/// Odds of a window: stick, left, right.
pub(super) type Odds = [f64; 3];

/// Cuts a path into windows; stretches at which the contact is not loaded are left out.
pub(super) fn windows(steps: &[PathStep], speed: f64) -> Vec<Window> {
    let median = super::touches::quantile(steps.iter().map(|s| s.normal_force).collect(), 0.5);
    let mut all = Vec::new();
    let mut from = 0;
    while from + 1 < steps.len() {
        let to = steps.partition_point(|s| s.t < steps[from].t + WINDOW).clamp(from + 1, steps.len() - 1);
        let part = &steps[from..to];
        let normal: f64 = part.iter().map(|s| s.normal_force).sum();
        let friction: f64 = part.iter().map(|s| s.normal_force * s.ratio).sum();
        let lasted = steps[to].t - steps[from].t;
        // Where the outline is wrong the median may be below zero: a force that does not press has no ratio.
        let loaded = LOADED * median.max(0.0);
        if part.iter().all(|s| s.normal_force > loaded) && lasted > 0.5 * WINDOW {
            all.push(Window {
                start: steps[from].t,
                end: steps[to].t,
                ratio: friction / normal,
                slip: (steps[to].slipped - steps[from].slipped) / (lasted * speed),
                steps: [from, to],
            });
        }
        from = to;
    }
    all
}

/// Logarithms of the densities of a window, by mode, where friction of the push exceeds that of all by `own`,
/// to a variance.
fn densities(window: &Window, (own, open): (f64, f64), common: &Common) -> [f64; 3] {
    let (ratio, slip) = (window.ratio, window.slip);
    let normal = |x: f64, deviation: f64| log_density(x, deviation * deviation).exp();
    let between = |x: f64, from: f64, to: f64, deviation: f64| {
        (below((x - from) / deviation) - below((x - to) / deviation)).max(0.0) / (to - from)
    };
    let [still, friction] = [0.0, slip.abs()].map(|slip| (own + common.at(slip)).max(LEAST_FRICTION));
    let slides = |side: f64| {
        normal(side * ratio - friction, common.ratio.hypot(open.sqrt()))
            * between(side * slip, 0.0, FASTEST, common.slip)
    };
    let sticks = between(ratio, -still, still, common.ratio) * normal(slip, common.slip);
    [sticks, slides(1.0), slides(-1.0)].map(|d| (d + STRAY / (WIDTH * WIDTH)).ln())
}

/// Odds of each window of a push, by what comes before and after it.
pub(super) fn smoothed(windows: &[Window], own: (f64, f64), common: &Common) -> Vec<Odds> {
    let said: Vec<[f64; 3]> =
        windows.iter().map(|w| densities(w, own, common).map(|d| (WEIGHT * d).exp())).collect();
    let step = |odds: Odds| {
        let sum: f64 = odds.iter().sum();
        odds.map(|p| STAYS * p + (1.0 - STAYS) * 0.5 * (sum - p))
    };
    let mut forward = Vec::with_capacity(said.len());
    let mut odds = [1.0 / 3.0; 3];
    for said in &said {
        odds = scaled([0, 1, 2].map(|i| odds[i] * said[i]));
        forward.push(odds);
        odds = step(odds);
    }
    let mut after = [1.0; 3];
    for (odds, said) in forward.iter_mut().zip(&said).rev() {
        let both = scaled([0, 1, 2].map(|i| odds[i] * after[i]));
        *odds = both;
        after = scaled(step([0, 1, 2].map(|i| after[i] * said[i])));
    }
    forward
}

fn scaled(odds: Odds) -> Odds {
    let sum: f64 = odds.iter().sum();
    if sum > 0.0 { odds.map(|p| p / sum) } else { [1.0 / 3.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMMON: Common = Common { friction: 0.5, by_slip: 0.0, of_push: 0.03, ratio: 0.03, slip: 0.05 };

    fn window(ratio: f64, slip: f64) -> Window {
        Window { start: 0.0, end: 0.1, ratio, slip, steps: [0, 1] }
    }

    /// Where the outline is wrong most of a push may pull, and some of it not touch at all: that has no ratio.
    #[test]
    fn what_does_not_press_is_in_no_window() {
        let step = |k: usize, normal_force: f64| PathStep {
            t: 0.01 * k as f64,
            pose: object_dynamics::pushing::PushPose::default(),
            point: glam::DVec2::ZERO,
            ratio: 0.0 / normal_force.max(0.0),
            normal_force,
            slipped: 0.0,
        };
        let all = |force: fn(usize) -> f64| (0..100).map(|k| step(k, force(k))).collect::<Vec<_>>();
        assert!(windows(&all(|k| if k < 40 { 0.0 } else { -1.0 }), 0.01).is_empty());
        assert!(!windows(&all(|_| 1.0), 0.01).is_empty());
    }

    #[test]
    fn densities_integrate_to_one_but_for_strays() {
        let step = 0.01;
        for mode in 0..3 {
            let mut sum = 0.0;
            for i in -200..200 {
                for j in -200..200 {
                    let w = window(f64::from(i) * step, f64::from(j) * step);
                    sum += densities(&w, (0.0, 0.0), &COMMON)[mode].exp() * step * step;
                }
            }
            assert!((sum - 1.0 - STRAY).abs() < 1e-3, "{mode}: {sum}");
        }
    }

    #[test]
    fn sliding_needs_the_cone_and_slip_to_the_same_side() {
        let told = |ratio: f64, slip: f64| {
            let odds = smoothed(&[window(ratio, slip); 30], (0.0, 0.0), &COMMON)[15];
            assert!((odds.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            odds
        };
        assert!(told(0.5, 0.4)[1] > 0.99);
        assert!(told(-0.5, -0.4)[2] > 0.99);
        assert!(told(0.1, 0.0)[0] > 0.99);
        // On the edge of the cone without slip both are about as likely, by their densities there: nobody can tell.
        let edge = told(0.5, 0.0);
        assert!(edge[0] > 0.2 && edge[1] > 0.2 && edge[2] < 1e-3, "{edge:?}");
    }
}
