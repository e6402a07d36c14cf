//! One contact at one coefficient of friction: probabilities of off, of the speeds of sliding and of the ratios of sticking.

use super::bins::Bins;
use super::contact::{Force, SlipRead};
use super::density::Ratio;
use super::foretold::Foretold;
use super::friction::Cell;
use super::steps::{EDGE, PACES, SPEEDS, Steps};

/// Probability below which a cell is left out when the largest likelihood is looked for; it may still win by [`Chain::in_logs`].
const FAINT: f64 = 1e-30;

/// Speed and ratio change slowly: they are what the modes remember. Were they drawn anew at each sample, the same evidence would
/// count again and again. Probabilities sum to one; what they are scaled by is kept as a logarithm by the caller.
#[derive(Debug)]
pub(super) struct Chain {
    pub(super) off: f64,
    /// It sticks with its force at the edge of the cone, and does not move at all.
    pub(super) edge: f64,
    /// Of each pace, one after the other.
    pub(super) speeds: Vec<f64>,
    pub(super) ratios: Vec<f64>,
}

impl Clone for Chain {
    fn clone(&self) -> Self {
        Self { off: self.off, edge: self.edge, speeds: self.speeds.clone(), ratios: self.ratios.clone() }
    }

    /// Into what is there: nothing is allocated.
    fn clone_from(&mut self, other: &Self) {
        (self.off, self.edge) = (other.off, other.edge);
        self.speeds.clone_from(&other.speeds);
        self.ratios.clone_from(&other.ratios);
    }
}

/// Log-likelihoods of a sample in every cell, which are the same at all paces.
#[derive(Clone, Debug)]
pub(super) struct Likelihood {
    pub(super) off: f64,
    pub(super) edge: f64,
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
        Self {
            off,
            edge: touches,
            speeds: vec![touches; SPEEDS],
            ratios: vec![touches; steps.ratios.count()],
        }
    }

    /// The same, in place.
    fn set(&mut self, off: f64, touches: f64) {
        (self.off, self.edge) = (off, touches);
        self.speeds.fill(touches);
        self.ratios.fill(touches);
    }

    /// Of a force, at the friction of this cell, without the factor that all modes that touch have in common.
    pub(super) fn of_force(&mut self, steps: &Steps, force: &Force, cell: &Cell) {
        match force {
            Force::Silent => self.set(0.0, 0.0),
            Force::Off => self.set(0.0, f64::NEG_INFINITY),
            Force::Touches => self.set(f64::NEG_INFINITY, 0.0),
            Force::Presses { ratio, touching, off, foretold } => {
                self.of_ratio(steps, ratio, cell, foretold);
                self.off = off - touching;
            }
        }
    }

    /// Of a slip.
    pub(super) fn of_slip(&mut self, read: &SlipRead, speeds: &Bins) {
        let SlipRead { slip, turn, weight } = read;
        self.off = weight * slip.log_off();
        self.edge = weight * slip.log_still();
        self.ratios.fill(weight * slip.log_sticking());
        for (k, log) in self.speeds.iter_mut().enumerate() {
            let (speed, spread) = (speeds.middle(k), speeds.variance(k));
            *log = weight * slip.log_sliding(speed, spread, *turn);
        }
    }

    /// With that of a slip beside it, of which all ratios are one cell.
    pub(super) fn add_slip(&mut self, by_slip: &Self) {
        self.off += by_slip.off;
        self.edge += by_slip.edge;
        self.speeds.iter_mut().zip(&by_slip.speeds).for_each(|(log, slip)| *log += slip);
        let sticks = by_slip.ratios.first().copied().unwrap_or_default();
        self.ratios.iter_mut().for_each(|log| *log += sticks);
    }

    /// Of a ratio, at the friction of this cell; those of the speeds and of the edge are all the same.
    fn of_ratio(&mut self, steps: &Steps, ratio: &Ratio, cell: &Cell, foretold: &Foretold) {
        self.edge = ratio.log_at(cell.mean, cell.variance);
        self.speeds.fill(self.edge);
        let friction = steps.friction;
        for (k, log) in self.ratios.iter_mut().enumerate().take(steps.ratios.count()) {
            let spread = friction.powi(2) * steps.ratios.variance(k);
            let edges = [steps.ratios.lower[k], steps.ratios.upper[k]].map(|edge| friction * edge);
            *log = foretold.log_in(ratio, edges, spread) + ratio.log_direction();
        }
    }
}

impl Chain {
    /// Nothing is known: each mode alike.
    pub(super) fn new(steps: &Steps) -> Self {
        Self {
            off: 1.0 / 3.0,
            edge: EDGE / 3.0,
            speeds: steps.landing.iter().map(|share| share / 3.0).collect(),
            ratios: steps.disc.iter().map(|share| (1.0 - EDGE) * share / 3.0).collect(),
        }
    }

    pub(super) fn slides(&self) -> f64 {
        self.speeds.iter().sum()
    }

    pub(super) fn sticks(&self) -> f64 {
        self.edge + self.ratios.iter().sum::<f64>()
    }

    /// Probability that the ratio is that of the friction.
    pub(super) fn at_friction(&self) -> f64 {
        self.edge + self.slides()
    }

    /// With this in every cell.
    pub(super) fn even(steps: &Steps, each: f64) -> Self {
        Self {
            off: each,
            edge: each,
            speeds: vec![each; PACES * SPEEDS],
            ratios: vec![each; PACES * steps.ratios.count()],
        }
    }

    /// Speeds and ratios change at the other pace now and then, as likely one way as the other: what that does is its own transpose.
    fn change_pace(&mut self, steps: &Steps) {
        for all in [&mut self.speeds, &mut self.ratios] {
            let cells = all.len() / PACES;
            let (fast, slow) = all.split_at_mut(cells);
            for (fast, slow) in fast.iter_mut().zip(slow) {
                let over = steps.paced * (*fast - *slow);
                *fast -= over;
                *slow += over;
            }
        }
    }

    /// One time step on, before anything is read. `spare` is any chain of these bins, to work in.
    pub(super) fn predict(&mut self, steps: &Steps, spare: &mut Self) {
        self.change_pace(steps);
        let (slid, off, edge) = (self.slides(), self.off, self.edge);
        let within: f64 = self.ratios.iter().sum();
        let stays = 1.0 - steps.touch;
        let walks = stays * (1.0 - steps.breaks);
        let under = self.speeds.chunks(SPEEDS).zip(&steps.speed).map(|(own, walk)| dot(own, &walk.under));
        let (stops, leaves) = (stays * under.sum::<f64>(), stays * steps.leaves * edge);
        let jumps = walks * steps.jump * within;
        let kept = walks * (1.0 - steps.jump);
        let count = steps.ratios.count();
        let over: f64 =
            self.ratios.chunks(count).zip(&steps.ratio).map(|(own, walk)| dot(own, &walk.over)).sum();
        let over = kept * over;
        let starts = stays * steps.breaks * within + (1.0 - EDGE) * over + 0.5 * leaves;
        spare.edge = stays * edge - leaves + EDGE * (over + stops);
        let stops = (1.0 - EDGE) * stops + 0.5 * leaves;
        let lands = 0.5 * steps.touch * off;
        for ((next, start), landing) in spare.speeds.iter_mut().zip(&steps.starts).zip(&steps.landing) {
            *next = starts * start + lands * landing;
        }
        let paces = self.speeds.chunks(SPEEDS).zip(spare.speeds.chunks_mut(SPEEDS));
        paces.zip(&steps.speed).for_each(|((own, next), walk)| walk.apply(own, stays, next));
        for ((next, stop), disc) in spare.ratios.iter_mut().zip(&steps.stops).zip(&steps.disc) {
            *next = stops * stop + (jumps + lands) * disc;
        }
        let paces = self.ratios.chunks(count).zip(spare.ratios.chunks_mut(count));
        paces.zip(&steps.ratio).for_each(|((own, next), walk)| walk.apply(own, kept, next));
        spare.off = stays * off + steps.touch * (slid + within + edge);
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
        let [over_worth, under_worth] = [starts, stops].map(|worth| worth + EDGE * (self.edge - worth));
        let paces = self.speeds.chunks(SPEEDS).zip(spare.speeds.chunks_mut(SPEEDS));
        for ((own, before), walk) in paces.zip(&steps.speed) {
            walk.worth(own, stays, before);
            for (worth, under) in before.iter_mut().zip(&walk.under) {
                *worth += stays * under * under_worth + lost;
            }
        }
        let count = steps.ratios.count();
        let paces = self.ratios.chunks(count).zip(spare.ratios.chunks_mut(count));
        for ((own, before), walk) in paces.zip(&steps.ratio) {
            walk.worth(own, kept, before);
            for (worth, over) in before.iter_mut().zip(&walk.over) {
                let leaves = stays * steps.breaks * starts + kept * over * over_worth;
                *worth += leaves + walks * steps.jump * disc + lost;
            }
        }
        spare.change_pace(steps);
        let left = 0.5 * (starts + stops);
        spare.edge = stays * (self.edge + steps.leaves * (left - self.edge)) + lost;
        spare.off = stays * self.off + 0.5 * steps.touch * (landing + disc);
        std::mem::swap(self, spare);
    }

    /// What each cell is worth before a sample is read, if it is worth what it holds here after that, up to a common factor.
    pub(super) fn unread(&mut self, of: &Likelihood) {
        let mut largest = f64::NEG_INFINITY;
        self.each(of, |worth, log| largest = largest.max(worth.ln() + log));
        self.each(of, |worth, log| *worth = (worth.ln() + log - largest).exp());
    }

    /// Sums over what is off, slides and sticks of the products with what the cells are worth.
    pub(super) fn times(&self, worth: &Self) -> [f64; 3] {
        let sticks = self.edge * worth.edge + dot(&self.ratios, &worth.ratios);
        [self.off * worth.off, dot(&self.speeds, &worth.speeds), sticks]
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
            sum = spare.scale(of, |log| (log - largest).exp());
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
        visit(&mut self.edge, of.edge);
        for (masses, logs) in [(&mut self.speeds, &of.speeds), (&mut self.ratios, &of.ratios)] {
            // Where all ratios are one cell, all paces are.
            let cells = masses.len().div_ceil(PACES);
            for masses in masses.chunks_mut(cells) {
                masses.iter_mut().zip(logs).for_each(|(mass, log)| visit(mass, *log));
            }
        }
    }

    /// Takes every cell times what its logarithm comes to, which is the same at all paces; returns the sum.
    fn scale(&mut self, of: &Likelihood, factor: impl Fn(f64) -> f64) -> f64 {
        self.off *= factor(of.off);
        self.edge *= factor(of.edge);
        let mut sum = self.off + self.edge;
        for (masses, logs) in [(&mut self.speeds, &of.speeds), (&mut self.ratios, &of.ratios)] {
            let cells = masses.len().div_ceil(PACES);
            for (k, log) in logs.iter().enumerate().take(cells) {
                let factor = factor(*log);
                for mass in masses.iter_mut().skip(k).step_by(cells) {
                    *mass *= factor;
                    sum += *mass;
                }
            }
        }
        sum
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
        let cells = chain.speeds.iter_mut().chain(&mut chain.ratios).chain([&mut chain.off, &mut chain.edge]);
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
