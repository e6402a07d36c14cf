//! How likely a sample is in every cell of a chain.
//!
//! Cells are weighed by factors, each beside the largest of its part. Most are the same at all frictions of a contact: bins of the ratio well within the cone, and what a slip
//! says of the speeds. Those are made once a sample, and what each friction makes is the bins next to its own cone.

use super::bins::Bins;
use super::contact::{Force, SlipRead};
use super::density::Ratio;
use super::foretold::Foretold;
use super::friction::Cell;
use super::steps::{SPEEDS, Steps};
use std::ops::Range;

/// Logarithm beside the largest below which a factor is nothing: the rest of what numbers hold is for probabilities.
const NOTHING: f64 = -600.0;
/// Beyond this many in logarithms two parts are not taken times each other but made anew.
const APART: f64 = 100.0;

/// Log-likelihoods of the cells of one kind.
#[derive(Debug)]
pub(super) struct Part {
    /// The largest.
    pub(super) top: f64,
    /// Beside it.
    pub(super) logs: Vec<f64>,
    /// What these are the logarithms of.
    pub(super) factors: Vec<f64>,
}

impl Clone for Part {
    fn clone(&self) -> Self {
        Self { top: self.top, logs: self.logs.clone(), factors: self.factors.clone() }
    }

    /// Into what is there: nothing is allocated.
    fn clone_from(&mut self, other: &Self) {
        self.top = other.top;
        self.logs.clone_from(&other.logs);
        self.factors.clone_from(&other.factors);
    }
}

impl Part {
    /// Of nothing that was read, in so many cells.
    pub(super) fn none(count: usize) -> Self {
        Self { top: 0.0, logs: vec![0.0; count], factors: vec![1.0; count] }
    }

    fn set(&mut self, log: f64) {
        self.top = log;
        self.logs.fill(0.0);
        self.factors.fill(1.0);
    }

    /// Takes the largest away from all, and makes their factors.
    fn close(&mut self) {
        self.top = largest(&self.logs);
        self.settle(0..self.logs.len());
    }

    /// The same of some of them, the largest being set.
    fn settle(&mut self, some: Range<usize>) {
        for (log, factor) in self.logs[some.clone()].iter_mut().zip(&mut self.factors[some]) {
            *log -= self.top;
            *factor = factor_of(*log);
        }
    }

    /// Of the size of a ratio, with these bins.
    pub(super) fn of_bins(&mut self, bins: &Bins, ratio: &Ratio, foretold: &Foretold) {
        for (k, log) in self.logs.iter_mut().enumerate() {
            *log = foretold.log_in(ratio, [bins.lower[k], bins.upper[k]], bins.variance(k));
        }
        self.close();
    }

    /// The same with the bins of one friction, of which the first are those of all; `of_all` has what these say, where it was made.
    fn of_friction(&mut self, steps: &Steps, ratio: &Ratio, foretold: &Foretold, of_all: Option<&Self>) {
        let (bins, friction) = (&steps.ratios, steps.friction);
        let common = of_all.map_or(0, |_| steps.common);
        for k in common..bins.count() {
            let edges = [bins.lower[k], bins.upper[k]].map(|edge| friction * edge);
            self.logs[k] = foretold.log_in(ratio, edges, friction.powi(2) * bins.variance(k));
        }
        let own = largest(&self.logs[common..bins.count()]);
        let shared = of_all.map_or(f64::NEG_INFINITY, |all| all.top + largest(&all.logs[..common]));
        self.top = own.max(shared);
        self.settle(common..bins.count());
        let Some(all) = of_all else { return };
        let beside = all.top - self.top;
        let times = beside.min(APART).exp();
        for k in 0..common {
            self.logs[k] = all.logs[k] + beside;
            self.factors[k] = if beside <= APART { times * all.factors[k] } else { factor_of(self.logs[k]) };
        }
    }
}

/// Log-likelihoods of a sample in every cell, which are the same at all paces.
#[derive(Clone, Debug)]
pub(super) struct Likelihood {
    pub(super) off: f64,
    pub(super) edge: f64,
    pub(super) speeds: Part,
    pub(super) ratios: Part,
}

impl Likelihood {
    /// Of nothing that was read, for so many bins of the ratio.
    pub(super) fn none(ratios: usize) -> Self {
        Self { off: 0.0, edge: 0.0, speeds: Part::none(SPEEDS), ratios: Part::none(ratios) }
    }

    /// The same wherever it touches.
    fn set(&mut self, off: f64, touches: f64) {
        (self.off, self.edge) = (off, touches);
        self.speeds.set(touches);
        self.ratios.set(touches);
    }

    /// Of a force, at the friction of this cell, without the factor that all modes that touch have in common; `of_all` is what bins of the ratio that all
    /// frictions have say of it, where that was made.
    pub(super) fn of_force(&mut self, steps: &Steps, force: &Force, cell: &Cell, of_all: Option<&Part>) {
        match force {
            Force::Silent => self.set(0.0, 0.0),
            Force::Off => self.set(0.0, f64::NEG_INFINITY),
            Force::Touches => self.set(f64::NEG_INFINITY, 0.0),
            Force::Presses { ratio, touching, off, foretold } => {
                self.off = off - touching;
                self.edge = ratio.log_at(cell.mean, cell.variance);
                self.speeds.set(self.edge);
                self.ratios.of_friction(steps, ratio, foretold, of_all);
                self.ratios.top += ratio.log_direction();
            }
        }
    }

    /// Of a slip.
    pub(super) fn of_slip(&mut self, read: &SlipRead, speeds: &Bins) {
        let SlipRead { slip, turn, weight } = read;
        self.off = weight * slip.log_off();
        self.edge = weight * slip.log_still();
        self.ratios.set(weight * slip.log_sticking());
        for (k, log) in self.speeds.logs.iter_mut().enumerate() {
            let (speed, spread) = (speeds.middle(k), speeds.variance(k));
            *log = weight * slip.log_sliding(speed, spread, *turn);
        }
        self.speeds.close();
    }

    /// With that of a slip beside it, of which speeds and ratios said nothing by themselves before.
    pub(super) fn add_slip(&mut self, by_slip: &Self) {
        self.off += by_slip.off;
        self.edge += by_slip.edge;
        let touches = self.speeds.top;
        self.speeds.clone_from(&by_slip.speeds);
        self.speeds.top += touches;
        self.ratios.top += by_slip.ratios.top;
    }

    pub(super) fn top(&self) -> f64 {
        self.off.max(self.edge).max(self.speeds.top).max(self.ratios.top)
    }
}

fn largest(logs: &[f64]) -> f64 {
    logs.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

fn factor_of(log: f64) -> f64 {
    if log < NOTHING { 0.0 } else { log.exp() }
}

#[cfg(test)]
mod tests {
    use super::super::steps::bins_of_all;
    use super::*;

    /// What the bins of all frictions say, made once, is what each friction makes by itself: of ratios below, at and far above its cone, known
    /// well or hardly.
    #[test]
    fn bins_of_all_frictions_say_the_same_at_each() {
        let bins = bins_of_all(1.2);
        let mut foretold = Foretold::default();
        for (size, deviation) in [(0.2, 0.05), (0.2, 2e-3), (0.21, 2e-3), (0.9, 1e-3), (0.0, 1e-3)] {
            let ratio = Ratio { size, deviation };
            let mut of_all = Part::none(bins.count());
            of_all.of_bins(&bins, &ratio, &foretold);
            for friction in [0.1, 0.21, 0.5, 1.2] {
                let steps = Steps::of_friction(1e-3, friction);
                assert!(steps.common > 0 && steps.common < steps.ratios.count());
                let force = Force::Presses { ratio, touching: 0.3, off: -2.0, foretold };
                let of = |of_all: Option<&Part>| {
                    let mut likelihood = Likelihood::none(steps.ratios.count());
                    likelihood.of_force(&steps, &force, &Cell::known(friction), of_all);
                    likelihood
                };
                let [alone, shared] = [of(None), of(Some(&of_all))];
                let scale = alone.ratios.top.abs().max(1.0);
                assert!((alone.ratios.top - shared.ratios.top).abs() < 1e-9 * scale, "{size} {friction}");
                let both = alone.ratios.logs.iter().zip(&shared.ratios.logs);
                assert!(both.clone().all(|(a, b)| (a - b).abs() < 1e-9 * a.abs().max(scale)));
                let both = alone.ratios.factors.iter().zip(&shared.ratios.factors);
                assert!(both.clone().all(|(a, b)| (a - b).abs() < 1e-9), "{size} {friction}");
                assert!(both.clone().any(|(a, _)| *a == 1.0));
            }
            let mut force = Force::Presses { ratio, touching: 0.0, off: 0.0, foretold };
            foretold.tell(1e-3, &mut force);
        }
    }
}
