//! One contact at one coefficient of friction: probabilities of off, of the speeds of sliding and of the ratios of sticking.

use super::bins::Bins;
use super::contact::{Force, SlipRead};
use super::density::Ratio;
use super::friction::Cell;
use super::steps::Steps;

/// Probability below which a cell is left out when the largest likelihood is looked for; it may still win by [`Chain::in_logs`].
const FAINT: f64 = 1e-30;

/// Speed and ratio change slowly: they are what the modes remember. Were they drawn anew at each sample, the same evidence would
/// count again and again. Probabilities sum to one; what they are scaled by is kept as a logarithm by the caller.
#[derive(Debug)]
pub(super) struct Chain {
    pub(super) off: f64,
    pub(super) speeds: Vec<f64>,
    pub(super) ratios: Vec<f64>,
}

impl Clone for Chain {
    fn clone(&self) -> Self {
        Self { off: self.off, speeds: self.speeds.clone(), ratios: self.ratios.clone() }
    }

    /// Into what is there: nothing is allocated.
    fn clone_from(&mut self, other: &Self) {
        self.off = other.off;
        self.speeds.clone_from(&other.speeds);
        self.ratios.clone_from(&other.ratios);
    }
}

/// Log-likelihoods of a sample in every cell.
#[derive(Clone, Debug)]
pub(super) struct Likelihood {
    pub(super) off: f64,
    pub(super) speeds: Vec<f64>,
    pub(super) ratios: Vec<f64>,
}

impl Likelihood {
    /// Of nothing that was read.
    pub(super) fn none(steps: &Steps) -> Self {
        Self::same(steps, 0.0, 0.0)
    }

    /// The same wherever it touches.
    pub(super) fn same(steps: &Steps, off: f64, touches: f64) -> Self {
        Self { off, speeds: vec![touches; steps.speeds.count()], ratios: vec![touches; steps.ratios.count()] }
    }

    /// The same, in place.
    fn set(&mut self, off: f64, touches: f64) {
        self.off = off;
        self.speeds.fill(touches);
        self.ratios.fill(touches);
    }

    /// Of a force, at the friction of this cell, without the factor that all modes that touch have in common.
    pub(super) fn of_force(&mut self, steps: &Steps, force: &Force, cell: &Cell) {
        match force {
            Force::Silent => self.set(0.0, 0.0),
            Force::Off => self.set(0.0, f64::NEG_INFINITY),
            Force::Touches => self.set(f64::NEG_INFINITY, 0.0),
            Force::Presses { ratio, touching, off } => {
                self.of_ratio(steps, ratio, cell);
                self.off = off - touching;
            }
        }
    }

    /// Of a slip.
    pub(super) fn of_slip(&mut self, read: &SlipRead, speeds: &Bins) {
        let SlipRead { slip, turn, weight } = read;
        self.off = weight * slip.log_off();
        self.ratios.fill(weight * slip.log_sticking());
        for (k, log) in self.speeds.iter_mut().enumerate() {
            let (speed, spread) = (speeds.middle(k), speeds.variance(k));
            *log = weight * slip.log_sliding(speed, spread, *turn);
        }
    }

    /// With that of a slip beside it, of which all ratios are one cell.
    pub(super) fn add_slip(&mut self, by_slip: &Self) {
        self.off += by_slip.off;
        self.speeds.iter_mut().zip(&by_slip.speeds).for_each(|(log, slip)| *log += slip);
        let sticks = by_slip.ratios.first().copied().unwrap_or_default();
        self.ratios.iter_mut().for_each(|log| *log += sticks);
    }

    /// Of a ratio, at the friction of this cell; those of the speeds are all the same.
    fn of_ratio(&mut self, steps: &Steps, ratio: &Ratio, cell: &Cell) {
        self.speeds.fill(ratio.log_at(cell.mean, cell.variance));
        let friction = steps.friction;
        for (k, log) in self.ratios.iter_mut().enumerate().take(steps.ratios.count()) {
            let spread = friction.powi(2) * steps.ratios.variance(k);
            *log = ratio.log_at(friction * steps.ratios.middle(k), spread);
        }
    }
}

impl Chain {
    /// Nothing is known: each mode alike.
    pub(super) fn new(steps: &Steps) -> Self {
        Self {
            off: 1.0 / 3.0,
            speeds: steps.landing.iter().map(|share| share / 3.0).collect(),
            ratios: steps.disc.iter().map(|share| share / 3.0).collect(),
        }
    }

    pub(super) fn slides(&self) -> f64 {
        self.speeds.iter().sum()
    }

    pub(super) fn sticks(&self) -> f64 {
        self.ratios.iter().sum()
    }

    /// With this in every cell.
    pub(super) fn even(steps: &Steps, each: f64) -> Self {
        Self { off: each, speeds: vec![each; steps.speeds.count()], ratios: vec![each; steps.ratios.count()] }
    }

    /// One time step on, before anything is read. `spare` is any chain of these bins, to work in.
    pub(super) fn predict(&mut self, steps: &Steps, spare: &mut Self) {
        let (slid, stuck, off) = (self.slides(), self.sticks(), self.off);
        let stays = 1.0 - steps.touch;
        let walks = stays * (1.0 - steps.breaks);
        let stops = stays * dot(&self.speeds, &steps.speed.under);
        let jumps = walks * steps.jump * stuck;
        let kept = walks * (1.0 - steps.jump);
        let starts = stays * steps.breaks * stuck + kept * dot(&self.ratios, &steps.ratio.over);
        let lands = 0.5 * steps.touch * off;
        for ((next, start), landing) in spare.speeds.iter_mut().zip(&steps.starts).zip(&steps.landing) {
            *next = starts * start + lands * landing;
        }
        steps.speed.apply(&self.speeds, stays, &mut spare.speeds);
        for ((next, stop), disc) in spare.ratios.iter_mut().zip(&steps.stops).zip(&steps.disc) {
            *next = stops * stop + (jumps + lands) * disc;
        }
        steps.ratio.apply(&self.ratios, kept, &mut spare.ratios);
        spare.off = stays * off + steps.touch * (slid + stuck);
        std::mem::swap(self, spare);
    }

    /// From what each cell is worth after a time step to what it is worth before: the transpose of [`Self::predict`].
    pub(super) fn before(&mut self, steps: &Steps, spare: &mut Self) {
        let stays = 1.0 - steps.touch;
        let walks = stays * (1.0 - steps.breaks);
        let kept = walks * (1.0 - steps.jump);
        let [starts, landing] = [&steps.starts, &steps.landing].map(|shares| dot(&self.speeds, shares));
        let [stops, disc] = [&steps.stops, &steps.disc].map(|shares| dot(&self.ratios, shares));
        let lost = steps.touch * self.off;
        steps.speed.worth(&self.speeds, stays, &mut spare.speeds);
        for (worth, under) in spare.speeds.iter_mut().zip(&steps.speed.under) {
            *worth += stays * under * stops + lost;
        }
        steps.ratio.worth(&self.ratios, kept, &mut spare.ratios);
        for (worth, over) in spare.ratios.iter_mut().zip(&steps.ratio.over) {
            *worth += (stays * steps.breaks + kept * over) * starts + walks * steps.jump * disc + lost;
        }
        spare.off = stays * self.off + 0.5 * steps.touch * (landing + disc);
        std::mem::swap(self, spare);
    }

    /// What each cell is worth before a sample is read, if it is worth what it holds here after that, up to a common factor.
    pub(super) fn unread(&mut self, of: &Likelihood) {
        let mut largest = f64::NEG_INFINITY;
        self.each(of, |worth, log| largest = largest.max(worth.ln() + log));
        self.each(of, |worth, log| *worth = (worth.ln() + log - largest).exp());
    }

    /// Sums over off, speeds and ratios of the products with what the cells are worth.
    pub(super) fn times(&self, worth: &Self) -> [f64; 3] {
        [self.off * worth.off, dot(&self.speeds, &worth.speeds), dot(&self.ratios, &worth.ratios)]
    }

    /// Weighs every cell by its likelihood; returns the logarithm of the density of what was read. `spare` is any chain of these bins.
    pub(super) fn weigh(&mut self, of: &Likelihood, spare: &mut Self) -> f64 {
        let mut largest = f64::NEG_INFINITY;
        self.each(of, |mass, log| {
            if *mass > FAINT {
                largest = largest.max(log);
            }
        });
        spare.clone_from(self);
        let mut sum = 0.0;
        if largest > f64::NEG_INFINITY {
            spare.each(of, |mass, log| {
                *mass *= (log - largest).exp();
                sum += *mass;
            });
        }
        // A faint cell may be all that explains the sample.
        if !(1e-12..1e12).contains(&sum) {
            return self.in_logs(of);
        }
        spare.each(of, |mass, _| *mass /= sum);
        std::mem::swap(self, spare);
        largest + sum.ln()
    }

    /// The same with the probabilities as logarithms too, so that nothing under- or overflows.
    fn in_logs(&mut self, of: &Likelihood) -> f64 {
        let mut largest = f64::NEG_INFINITY;
        self.each(of, |mass, log| largest = largest.max(mass.ln() + log));
        let mut sum = 0.0;
        self.each(of, |mass, log| sum += (mass.ln() + log - largest).exp());
        self.each(of, |mass, log| *mass = (mass.ln() + log - largest).exp() / sum);
        largest + sum.ln()
    }

    fn each(&mut self, of: &Likelihood, mut visit: impl FnMut(&mut f64, f64)) {
        visit(&mut self.off, of.off);
        self.speeds.iter_mut().zip(&of.speeds).for_each(|(mass, log)| visit(mass, *log));
        self.ratios.iter_mut().zip(&of.ratios).for_each(|(mass, log)| visit(mass, *log));
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some(steps: &Steps, seed: f64) -> Chain {
        let mut chain = Chain::even(steps, 1.0);
        let mut k = 0.0;
        let cells = chain.speeds.iter_mut().chain(&mut chain.ratios).chain([&mut chain.off]);
        cells.for_each(|cell| {
            k += 1.0;
            *cell = (0.5_f64 + 0.5 * (seed * k).sin()).powi(3);
        });
        chain
    }

    /// `worth . predicted = worth before . now`, for any of both.
    #[test]
    fn a_step_back_is_the_transpose_of_a_step() {
        let all = [1e-4, 1e-3, 0.02].map(|dt| [Steps::of_friction(dt, 0.05), Steps::of_friction(dt, 0.37)]);
        for steps in all.iter().flatten() {
            let (now, mut worth) = (some(steps, 1.7), some(steps, 0.9));
            let (mut next, mut spare) = (now.clone(), now.clone());
            next.predict(steps, &mut spare);
            let after: f64 = next.times(&worth).iter().sum();
            worth.before(steps, &mut spare);
            let before: f64 = now.times(&worth).iter().sum();
            assert!((after - before).abs() < 1e-12 * after, "{after} {before}");
        }
    }
}
