//! Coefficients of friction: one that is known, or a grid of what it may be.

use super::bins::Bins;
use super::contact::Contact;
use super::density::Ratio;
use super::steps::{Steps, bins_of_all};

/// The grid of an unknown friction: this many values, alike in ratio, from lowest to highest.
const VALUES: u32 = 160;
const LOWEST: f64 = 0.1;
const HIGHEST: f64 = 1.2;
/// The grid over a whole log, of steps of the same ratio: frictions that contradict it cost nothing for long there.
const WHOLE: (f64, f64) = (0.02, 2.0);
/// Prior probability that contacts that may have one friction have one.
pub(super) const ALIKE: f64 = 0.5;
/// Time that something must have slid before its friction is told, s, and how probable sliding must be for its time to count.
const SLID: f64 = 0.01;
pub(super) const SURE: f64 = 0.99;
/// Least deviation of a friction as a share of it.
const KNOWN: f64 = 3e-3;

/// What is known of the friction of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactFriction {
    /// Its coefficient, from 1e-3 to 10. One that is too high is the bad side: sticking is then told where contacts slide, with
    /// confidence.
    Known(f64),
    /// A coefficient from 0.1 to 1.2, the same for all contacts that give this number. What one of them tells by sliding helps
    /// the others; a contact that never slides alone cannot know.
    Unknown {
        /// Any number that names the pair of materials.
        material: usize,
    },
    /// The same, but whether contacts that give this number have one coefficient or each its own is not known either: beforehand one is as likely as
    /// the other.
    Alike {
        /// Any number that names what may be one pair of materials.
        material: usize,
    },
}

/// A coefficient of friction that was learned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LearnedFriction {
    /// Its mean.
    pub coefficient: f64,
    /// Its standard deviation, not below 0.3 % of the coefficient: what is told to slide and does not is beyond noise.
    pub deviation: f64,
}

/// What the contacts of one material may have, and how likely that is.
#[derive(Clone, Debug)]
pub(super) struct FrictionGrid {
    /// As it was stated.
    pub(super) of: ContactFriction,
    pub(super) values: Vec<f64>,
    /// What happens at each in a time step.
    pub(super) steps: Vec<Steps>,
    /// Bins of the ratio that all of them have.
    pub(super) of_all: Bins,
    /// Of these the latest time step was so many.
    pub(super) times: usize,
    /// Given all samples of the material, were it one friction; sum to one.
    shared: Vec<f64>,
    /// Probability that it is one.
    one: f64,
    /// Logarithm of what the evidence summed to after the last sample, beside what was taken away.
    last: f64,
    /// What its contacts say together.
    pub(super) together: Guess,
}

/// What is known of a friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guess {
    /// Time for which something slid, s.
    slid: f64,
    /// Mean and variance.
    pub(super) moments: [f64; 2],
}

impl Guess {
    pub(super) const NONE: Self = Self { slid: 0.0, moments: [1.0, 1.0] };

    /// Counts the time in which a contact slid.
    pub(super) fn count(&mut self, slides: f64, dt: f64) {
        if slides >= SURE {
            self.slid += dt;
        }
    }

    fn learned(self) -> Option<LearnedFriction> {
        learned(self.moments, self.slid)
    }
}

impl FrictionGrid {
    /// For time steps of `dt`, s, at first.
    pub(super) fn new(of: ContactFriction, dt: f64) -> Self {
        let values: Vec<f64> = match of {
            ContactFriction::Known(friction) => vec![friction],
            _ => (0..VALUES).map(|k| LOWEST * (f64::from(k) * log_step()).exp()).collect(),
        };
        Self {
            of,
            steps: values.iter().map(|friction| Steps::that_follow(dt, *friction)).collect(),
            of_all: bins_of_all(values.iter().copied().fold(0.0, f64::max)),
            times: 0,
            shared: vec![0.0; values.len()],
            values,
            one: 1.0,
            last: 0.0,
            together: Guess::NONE,
        }
    }

    /// A time step, s.
    pub(super) fn follow(&mut self, dt: f64) {
        // To make the walks of all frictions anew takes milliseconds: a sample that is missing is none.
        let twice = !matches!(self.of, ContactFriction::Known(_));
        for steps in &mut self.steps {
            self.times = steps.follow(dt, twice);
        }
    }

    /// Takes the evidence of its contacts, which stays small by that, and sets the weights of their frictions. Returns
    /// the logarithm of the density of what was new in it.
    ///
    /// Given one friction the contacts are independent: the product of their densities is exact. With one for each they are so anyway, and each has a prior
    /// of its own: a mean over the grid is the evidence of a hypothesis with a prior that is even over it.
    pub(super) fn gather(&mut self, contacts: &mut [Contact], is_own: impl Fn(usize) -> bool) -> f64 {
        let even = (self.values.len() as f64).ln();
        self.shared.fill(-even);
        let (mut taken, mut apart) = (0.0, 0.0);
        let own = |(i, _): &(usize, &mut Contact)| is_own(*i);
        for (_, contact) in contacts.iter_mut().enumerate().filter(own) {
            taken += contact.level(&self.steps);
            let logs = &contact.log_evidence;
            self.shared.iter_mut().zip(logs).for_each(|(sum, log)| *sum += log);
            contact.weights.copy_from_slice(logs);
            apart += soften(&mut contact.weights) - even;
        }
        let together = soften(&mut self.shared);
        let mut sum = together;
        if let ContactFriction::Alike { .. } = self.of {
            let odds = ALIKE / (1.0 - ALIKE) * (together - apart).exp();
            self.one = if odds.is_finite() { odds / (1.0 + odds) } else { 1.0 };
            let both = [ALIKE.ln() + together, (1.0 - ALIKE).ln() + apart];
            sum = both[0].max(both[1]) + (-(both[0] - both[1]).abs()).exp().ln_1p();
        }
        for (_, contact) in contacts.iter_mut().enumerate().filter(own) {
            let all = contact.weights.iter_mut().zip(&self.shared);
            all.for_each(|(weight, shared)| *weight = self.one * shared + (1.0 - self.one) * *weight);
        }
        let new = taken + (sum - self.last);
        self.last = sum;
        new
    }

    /// What is known of each value before anything was read.
    pub(super) fn cells(&self) -> Vec<Cell> {
        let of = if let ContactFriction::Known(_) = self.of { Cell::known } else { Cell::new };
        self.values.iter().map(|value| of(*value)).collect()
    }

    /// The friction of a contact, where it is known or learned.
    pub(super) fn told(&self, contact: &Contact) -> Option<f64> {
        match self.of {
            ContactFriction::Known(friction) => Some(friction),
            _ => self.learned(contact).map(|learned| learned.coefficient),
        }
    }

    /// Of a contact: none where it was known from the start, and while nothing slid for long enough: what sticks has only a lower bound.
    pub(super) fn learned(&self, contact: &Contact) -> Option<LearnedFriction> {
        match self.of {
            ContactFriction::Known(_) => None,
            _ if self.one > 0.5 => self.together.learned(),
            _ => contact.guess.learned(),
        }
    }
}

/// Makes shares of logarithms, in place; returns the logarithm of the sum of what they are of.
pub(super) fn soften(logs: &mut [f64]) -> f64 {
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    logs.iter_mut().for_each(|log| *log = (*log - largest).exp());
    let sum: f64 = logs.iter().sum();
    logs.iter_mut().for_each(|share| *share /= sum);
    largest + sum.ln()
}

/// Logarithm of the ratio of one value of a grid to the one before.
fn log_step() -> f64 {
    (HIGHEST / LOWEST).ln() / f64::from(VALUES - 1)
}

/// Where in its cell of the grid a friction is, of one contact: what it was while that slid.
///
/// A cell is wider than what good forces tell: were its width an error of each sample by itself, sliding at one ratio would be no more likely
/// than sticking at one that walks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) mean: f64,
    pub(super) variance: f64,
    ends: [f64; 2],
}

impl Cell {
    /// Anywhere in the cell about this value.
    pub(super) fn new(value: f64) -> Self {
        let half = (0.5 * log_step()).exp();
        Self {
            mean: value,
            variance: (value * log_step()).powi(2) / 12.0,
            ends: [value / half, value * half],
        }
    }

    /// This value and no other.
    pub(super) fn known(value: f64) -> Self {
        Self { mean: value, variance: 0.0, ends: [value; 2] }
    }

    /// Takes a ratio, which is the friction's with the probability `slides`.
    pub(super) fn learn(&mut self, ratio: &Ratio, slides: f64) {
        let gain = slides * self.variance / (slides * self.variance + ratio.deviation.powi(2));
        self.mean = (self.mean + gain * (ratio.size - self.mean)).clamp(self.ends[0], self.ends[1]);
        self.variance *= 1.0 - gain;
    }
}

/// Bins of the ratio that all frictions of a whole log have.
pub(super) fn whole_bins() -> Bins {
    bins_of_all(WHOLE.1)
}

/// The frictions that are looked at over a whole log.
pub(super) fn values() -> Vec<f64> {
    let count = ((WHOLE.1 / WHOLE.0).ln() / log_step()).ceil() as u32;
    (0..=count).map(|k| WHOLE.0 * (f64::from(k) * log_step()).exp()).collect()
}

/// Mean and variance of a friction from cells and their weights, which sum to one.
pub(super) fn guessed<'a>(cells: impl Iterator<Item = (f64, &'a Cell)> + Clone) -> [f64; 2] {
    let mean: f64 = cells.clone().map(|(weight, cell)| weight * cell.mean).sum();
    let variance = cells.map(|(weight, cell)| weight * (cell.variance + (cell.mean - mean).powi(2))).sum();
    [mean, variance]
}

/// Of one friction that several contacts tell. What all had beforehand, a cell of the grid, is of no account beside that.
pub(super) fn together(all: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let [by, information] = all.fold([0.0, 0.0], |[by, information], [mean, variance]| {
        let own = variance.max(f64::MIN_POSITIVE).recip();
        [by + own * mean, information + own]
    });
    [by / information, information.recip()]
}

/// Of a mean and a variance; none where nothing slid for long enough, `slid` being the time that something did, s.
pub(super) fn learned([mean, variance]: [f64; 2], slid: f64) -> Option<LearnedFriction> {
    // A sum of steps is not exact.
    let known = slid >= SLID * (1.0 - 1e-9);
    known.then(|| LearnedFriction { coefficient: mean, deviation: variance.sqrt().max(KNOWN * mean) })
}
