//! Which coefficients of friction are followed one by one.
//!
//! A contact that sticks well within its cone does the same whatever that is: all frictions far above the ratio go with the largest one. One far below a
//! ratio is given up. So of a grid those near the ratio of the contact are followed, whatever the grid's size.

use super::bins::Bins;
use super::chain::Chain;
use super::contact::Contact;
use super::density::Ratio;
use super::friction::FrictionGrid;
use super::steps::Steps;
use std::ops::Range;

/// Logarithm of the odds against a friction at most: one that an outlier, or a model that was wrong for a while, speaks against comes back.
pub(super) const GIVEN_UP: f64 = 60.0;
/// Deviations of what is known of the ratio, and of a ratio that is read, from which on a friction is far from it: sliding at it has less than a
/// hundred-thousandth of what sticking has then, once in 500 ms as it begins and each sample's `exp(-9 / 2)`.
const FAR: f64 = 4.0;
const READ: f64 = 3.0;
/// Probability of sliding from which on a friction is followed wherever it is.
const SLIDES: f64 = 1e-4;
/// Probability of sticking below which the largest friction knows no ratio.
const STICKS: f64 = 1e-3;

/// How a friction is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Followed {
    /// By a chain of its own.
    Alone,
    /// As the largest friction.
    AsLargest,
    /// Not at all: the ratio is beyond it.
    GivenUp,
}

impl Contact {
    /// Has those frictions followed that the ratio came near to, once the time step was made and before the force counts.
    pub(super) fn rouse(&mut self, grid: &FrictionGrid, read: &Ratio) {
        self.noise = read.deviation;
        let Some((last, others)) = self.chains.split_last_mut() else { return };
        let largest = &grid.steps[others.len()];
        let walked = largest.walked(grid.times);
        let Some(near) = self.ratio.map(|ratio| near(ratio, walked, self.noise)) else { return };
        for (i, chain) in others.iter_mut().enumerate() {
            let (value, steps) = (grid.values[i], &grid.steps[i]);
            let modes = match self.followed[i] {
                Followed::AsLargest if value < near.end => None,
                Followed::GivenUp if near.contains(&value) => Some(&self.mean),
                Followed::GivenUp if value >= near.end => {
                    self.followed[i] = Followed::AsLargest;
                    continue;
                }
                _ => continue,
            };
            chain.take(last, [largest, steps], modes);
            self.followed[i] = Followed::Alone;
        }
    }

    /// Takes the largest of the evidence away from all, so that it stays small, and returns it; follows those frictions no more that the ratio is far from,
    /// before a step that may jump anywhere.
    pub(super) fn level(&mut self, grid: &[Steps]) -> f64 {
        let last = self.log_evidence.len() - 1;
        let moved = self.log_evidence[last] - self.largest_before;
        let all = self.log_evidence.iter_mut().zip(&self.followed);
        all.filter(|(_, of)| **of == Followed::AsLargest).for_each(|(log, _)| *log += moved);
        let known = self.log_evidence.iter().zip(&self.followed).filter(|(_, of)| **of != Followed::GivenUp);
        let largest = known.map(|(log, _)| *log).fold(f64::NEG_INFINITY, f64::max);
        for (log, of) in self.log_evidence.iter_mut().zip(&self.followed) {
            let own = if *of == Followed::GivenUp { f64::NEG_INFINITY } else { *log - largest };
            *log = own.max(-GIVEN_UP);
        }
        self.largest_before = self.log_evidence[last];
        self.ratio = self.chains[last].ratio(&grid[last]);
        if let Some(ratio) = self.ratio {
            self.rest(grid, &near(ratio, 0.0, self.noise));
        }
        largest
    }

    /// Those far from the ratio, where nothing hangs on them.
    fn rest(&mut self, grid: &[Steps], near: &Range<f64>) {
        let last = self.chains.len() - 1;
        for (i, steps) in grid.iter().enumerate().take(last) {
            let is_far = self.followed[i] == Followed::Alone && !near.contains(&steps.friction);
            let faint = self.log_evidence[i] <= -GIVEN_UP;
            if is_far && steps.friction >= near.end && (faint || self.chains[i].slides() < SLIDES) {
                self.followed[i] = Followed::AsLargest;
            } else if is_far && steps.friction < near.start && faint {
                self.followed[i] = Followed::GivenUp;
            }
        }
    }
}

/// What is near a ratio of this mean and deviation that walked for so far, where one is read with this noise.
fn near([ratio, deviation]: [f64; 2], walked: f64, noise: f64) -> Range<f64> {
    let far = FAR * deviation.hypot(walked);
    ratio - far..ratio + far + READ * noise
}

impl Chain {
    /// Mean and deviation of the ratio where it sticks; none where it hardly does.
    fn ratio(&self, steps: &Steps) -> Option<[f64; 2]> {
        let sticks: f64 = self.ratios.iter().sum();
        let known = sticks > STICKS;
        let mean = |of: &dyn Fn(usize) -> f64| {
            self.ratios.iter().enumerate().map(|(k, mass)| mass * of(k)).sum::<f64>() / sticks
        };
        let count = steps.ratios.count();
        let middle = mean(&|k| steps.ratios.middle(k % count));
        let variance =
            mean(&|k| (steps.ratios.middle(k % count) - middle).powi(2) + steps.ratios.variance(k % count));
        known.then(|| [middle, variance.sqrt()].map(|of| steps.friction * of))
    }

    /// Becomes what it would be of a friction that is followed as the largest one; the modes are those of `modes`, all of whose ratios are one cell, where
    /// there are any.
    fn take(&mut self, largest: &Self, [its, own]: [&Steps; 2], modes: Option<&Self>) {
        let like = modes.unwrap_or(largest);
        // That of `modes` is of before the time step, after which nothing is impossible.
        self.off = largest.off;
        self.speeds.clone_from(&like.speeds);
        let share =
            if modes.is_some() { like.sticks() / largest.sticks().max(f64::MIN_POSITIVE) } else { 1.0 };
        self.edge = share * largest.edge;
        self.ratios.fill(0.0);
        let scale = its.friction / own.friction;
        let [from, to] = [its, own].map(|steps| steps.ratios.count());
        for (from, to) in largest.ratios.chunks(from).zip(self.ratios.chunks_mut(to)) {
            let mut at = 0;
            for (k, mass) in from.iter().enumerate() {
                let [from, until] = [its.ratios.lower[k], its.ratios.upper[k]].map(|edge| edge * scale);
                at = spread(to, &own.ratios, at, [from, until], share * mass);
            }
        }
    }
}

/// Spreads a mass from an edge to another one over bins, of which those before `at` end before the first; what is beyond the last is put there. Returns the
/// bin in which the second edge is.
fn spread(masses: &mut [f64], bins: &Bins, mut at: usize, [from, to]: [f64; 2], mass: f64) -> usize {
    let last = masses.len() - 1;
    let mut start = from;
    while at < last && bins.upper[at] < to {
        masses[at] += mass * (bins.upper[at] - start).max(0.0) / (to - from);
        start = start.max(bins.upper[at]);
        at += 1;
    }
    masses[at] += mass * (to - start) / (to - from);
    at
}

#[cfg(test)]
mod tests {
    use super::super::density::Ratio;
    use super::*;

    /// What is known of the ratio is the same on the bins of another friction.
    #[test]
    fn a_friction_takes_over_what_the_largest_knows() {
        let [largest, own] = [1.2, 0.31].map(|friction| Steps::of_friction(1e-3, friction));
        let mut chain = Chain::new(&largest);
        let count = largest.ratios.count();
        for (k, mass) in chain.ratios.iter_mut().enumerate() {
            *mass = Ratio { size: 0.2, deviation: 0.02 }
                .log_at(1.2 * largest.ratios.middle(k % count), 0.0)
                .exp();
        }
        let mut taken = Chain::new(&own);
        taken.take(&chain, [&largest, &own], None);
        assert!((taken.sticks() - chain.sticks()).abs() < 1e-12 * chain.sticks());
        let [a, b] = [(&chain, &largest), (&taken, &own)].map(|(of, steps)| of.ratio(steps).unwrap());
        // Bins there are 0.0065 wide.
        assert!((a[0] - b[0]).abs() < 1e-3 && (a[1] - b[1]).abs() < 1e-3, "{a:?} {b:?}");
        let modes = Chain { off: 0.0, edge: 0.0, ratios: vec![0.25], speeds: vec![0.75 / 72.0; 72] };
        taken.take(&chain, [&largest, &own], Some(&modes));
        assert!((taken.sticks() - 0.25).abs() < 1e-12 && (taken.slides() - 0.75).abs() < 1e-12);
    }
}
