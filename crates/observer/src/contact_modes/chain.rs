//! One contact at one coefficient of friction: probabilities of off, of the speeds of sliding and of the ratios of sticking.

use super::likelihood::Likelihood;
use super::steps::{EDGE, PACES, SPEEDS, Steps};

/// Sum of what is left of all cells below which factors have lost what counts, and logarithms are taken.
const FAINT: f64 = 1e-200;

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
        let top = of.top();
        spare.off = self.off * (of.off - top).exp();
        spare.edge = self.edge * (of.edge - top).exp();
        let mut sum = spare.off + spare.edge;
        let parts =
            [(&self.speeds, &mut spare.speeds, &of.speeds), (&self.ratios, &mut spare.ratios, &of.ratios)];
        for (before, after, part) in parts {
            let beside = (part.top - top).exp();
            let cells = cells(before);
            for (before, after) in before.chunks(cells).zip(after.chunks_mut(cells)) {
                for ((before, after), factor) in before.iter().zip(after).zip(&part.factors) {
                    *after = before * (beside * factor);
                    sum += *after;
                }
            }
        }
        // A faint cell may be all that explains the sample.
        if !(FAINT..=f64::MAX).contains(&sum) {
            return self.in_logs(of);
        }
        let share = 1.0 / sum;
        spare.off *= share;
        spare.edge *= share;
        spare.speeds.iter_mut().chain(&mut spare.ratios).for_each(|mass| *mass *= share);
        std::mem::swap(self, spare);
        top + sum.ln()
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
        for (masses, part) in [(&mut self.speeds, &of.speeds), (&mut self.ratios, &of.ratios)] {
            let cells = cells(masses);
            for masses in masses.chunks_mut(cells) {
                masses.iter_mut().zip(&part.logs).for_each(|(mass, log)| visit(mass, part.top + log));
            }
        }
    }
}

/// Cells of one pace; where all ratios are one cell, all paces are.
fn cells(masses: &[f64]) -> usize {
    masses.len().div_ceil(PACES)
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
