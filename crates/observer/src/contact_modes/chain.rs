//! One contact at one coefficient of friction: probabilities of off, of the speeds of sliding and of the ratios of sticking.

use super::density::Ratio;
use super::steps::{RATIOS, SPEEDS, Steps};

/// Probability below which a cell is left out when the largest likelihood is looked for; it may still win by [`Chain::in_logs`].
const FAINT: f64 = 1e-30;

/// Speed and ratio change slowly: they are what the modes remember. Were they drawn anew at each sample, the same evidence would
/// count again and again. Probabilities sum to one; what they are scaled by is kept as a logarithm by the caller.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) off: f64,
    pub(super) speeds: [f64; SPEEDS],
    pub(super) ratios: [f64; RATIOS],
}

/// Log-likelihoods of a sample in every cell.
#[derive(Clone, Debug)]
pub(super) struct Likelihood {
    pub(super) off: f64,
    pub(super) speeds: [f64; SPEEDS],
    pub(super) ratios: [f64; RATIOS],
}

impl Likelihood {
    pub(super) const NONE: Self = Self { off: 0.0, speeds: [0.0; SPEEDS], ratios: [0.0; RATIOS] };

    /// Of a ratio, at this friction; those of the speeds are all the same.
    pub(super) fn of_ratio(&mut self, steps: &Steps, ratio: &Ratio, friction: f64) {
        self.speeds = [ratio.log_at(friction, 0.0); SPEEDS];
        for (k, log) in self.ratios.iter_mut().enumerate() {
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
            speeds: steps.landing.map(|share| share / 3.0),
            ratios: steps.disc.map(|share| share / 3.0),
        }
    }

    pub(super) fn slides(&self) -> f64 {
        self.speeds.iter().sum()
    }

    pub(super) fn sticks(&self) -> f64 {
        self.ratios.iter().sum()
    }

    /// One time step on, before anything is read.
    pub(super) fn predict(&mut self, steps: &Steps) {
        let (slid, stuck, off) = (self.slides(), self.sticks(), self.off);
        let stays = 1.0 - steps.touch;
        let walks = stays * (1.0 - steps.breaks);
        let stops = stays * dot(&self.speeds, &steps.speed.under);
        let jumps = walks * steps.jump * stuck;
        let kept = walks * (1.0 - steps.jump);
        let starts = stays * steps.breaks * stuck + kept * dot(&self.ratios, &steps.ratio.over);
        let lands = 0.5 * steps.touch * off;
        let mut speeds: [f64; SPEEDS] =
            std::array::from_fn(|k| starts * steps.starts[k] + lands * steps.landing[k]);
        steps.speed.apply(&self.speeds, stays, &mut speeds);
        let mut ratios: [f64; RATIOS] =
            std::array::from_fn(|k| stops * steps.stops[k] + (jumps + lands) * steps.disc[k]);
        steps.ratio.apply(&self.ratios, kept, &mut ratios);
        *self = Self { off: stays * off + steps.touch * (slid + stuck), speeds, ratios };
    }

    /// Weighs every cell by its likelihood; returns the logarithm of the density of what was read.
    pub(super) fn weigh(&mut self, of: &Likelihood) -> f64 {
        let mut largest = f64::NEG_INFINITY;
        self.each(of, |mass, log| {
            if *mass > FAINT {
                largest = largest.max(log);
            }
        });
        let mut sum = 0.0;
        if largest > f64::NEG_INFINITY {
            self.each(of, |mass, log| sum += *mass * (log - largest).exp());
        }
        // A faint cell may be all that explains the sample.
        if !(1e-12..1e12).contains(&sum) {
            return self.in_logs(of);
        }
        self.each(of, |mass, log| *mass *= (log - largest).exp() / sum);
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

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
