//! Whether forces are later than slips: the evidence of a contact whose forces go with slips of some time before.
//!
//! After a contact has come to rest, what the ratio of late forces does is what it does while one slides ever more slowly: no residual tells it.
//! What tells it is that the same forces and slips are likelier with each other at another time.

use super::bins::Bins;
use super::chain::Chain;
use super::contact::{Force, SlipRead};
use super::friction::Cell;
use super::likelihood::Likelihood;
use super::reading::{ContactReading, ContactSlip, turned};
use super::steps::{Steps, speeds};
use std::collections::VecDeque;

/// By how much forces are held to be late, s. Less is not to be told from speeds and ratios that go smoother ways than walks do.
const LAGS: [f64; 2] = [0.024, 0.048];
/// Slips that wait for their forces at most: those of a longer time than this are none of this rate.
const WAITING: usize = 256;
/// Deviations of a ratio that the friction must be for its direction, and so the slip along it, to be known.
const CLEAR: f64 = 6.0;

/// Logarithm of the odds against forces that are not late from which on they are: those that are not get there once in a million.
const SURE: f64 = 13.8;

/// A slip that waits for its force.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    t: f64,
    slip: ContactSlip,
    weight: f64,
    /// Logarithm of its density with the force of its own sample, all before given; none where it does not count.
    at_once: Option<f64>,
}

/// Forces with slips of some time before.
#[derive(Clone, Debug)]
struct Lagged {
    chain: Chain,
    waiting: VecDeque<Waiting>,
    /// Logarithm of the odds of this lag against none, of what went by both.
    odds: f64,
}

/// Forces of one contact at once and late.
#[derive(Clone, Debug)]
pub(super) struct Late {
    cell: Cell,
    natural_speed: f64,
    speeds: Bins,
    at_once: Chain,
    lagged: [Lagged; LAGS.len()],
    spare: Chain,
    likelihood: Likelihood,
    /// Since the start, s.
    t: f64,
}

/// What a sample brings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Brought<'a> {
    pub(super) dt: f64,
    /// In so many steps.
    pub(super) times: usize,
    pub(super) force: &'a Force,
    pub(super) reading: Option<&'a ContactReading>,
    /// And the power of its density.
    pub(super) slip: Option<(ContactSlip, f64)>,
}

impl Lagged {
    /// The first slip that waits, where it is from this time or before.
    fn pop_due(&mut self, due: f64) -> Option<Waiting> {
        let is_due = self.waiting.front().is_some_and(|waiting| waiting.t <= due);
        if is_due { self.waiting.pop_front() } else { None }
    }
}

impl Late {
    /// Of a contact with this friction.
    pub(super) fn new(steps: &Steps, natural_speed: f64) -> Self {
        let chain = Chain::new(steps);
        let lagged = || Lagged { chain: chain.clone(), waiting: VecDeque::with_capacity(WAITING), odds: 0.0 };
        Self {
            cell: Cell::known(steps.friction),
            natural_speed,
            speeds: speeds(),
            lagged: std::array::from_fn(|_| lagged()),
            spare: chain.clone(),
            at_once: chain,
            likelihood: Likelihood::none(steps.ratios.count()),
            t: 0.0,
        }
    }

    pub(super) fn take(&mut self, steps: &Steps, brought: &Brought) {
        let Brought { dt, times, force, reading, slip } = *brought;
        self.t += dt;
        let counts = match force {
            Force::Presses { ratio, .. } => self.cell.mean > CLEAR * ratio.deviation,
            _ => false,
        };
        self.likelihood.of_force(steps, force, &self.cell, None);
        let Self { likelihood, spare, .. } = self;
        let mut step = |chain: &mut Chain| {
            (0..times).for_each(|_| chain.predict(steps, spare));
            chain.weigh(likelihood, spare)
        };
        let at_once = step(&mut self.at_once);
        for lagged in &mut self.lagged {
            let late = step(&mut lagged.chain);
            lagged.odds += if counts { late - at_once } else { 0.0 };
        }
        let Some(reading) = reading.filter(|_| !matches!(force, Force::Off)) else {
            // What has no force has no direction to slip against.
            self.lagged.iter_mut().for_each(|lagged| lagged.waiting.clear());
            return;
        };
        if let Some((slip, weight)) = slip {
            self.set(reading, &slip, weight);
            let at_once = self.at_once.weigh(&self.likelihood, &mut self.spare);
            let waiting = Waiting { t: self.t, slip, weight, at_once: counts.then_some(at_once) };
            for Lagged { waiting: all, .. } in &mut self.lagged {
                if all.len() == WAITING {
                    all.pop_front();
                }
                all.push_back(waiting);
            }
        }
        for (i, lag) in LAGS.into_iter().enumerate() {
            // A sum of steps is not exact.
            let due = self.t - lag * (1.0 - 1e-9);
            while let Some(waiting) = self.lagged[i].pop_due(due) {
                self.set(reading, &waiting.slip, waiting.weight);
                let lagged = &mut self.lagged[i];
                let late = lagged.chain.weigh(&self.likelihood, &mut self.spare);
                lagged.odds += waiting.at_once.filter(|_| counts).map_or(0.0, |at_once| late - at_once);
            }
        }
    }

    fn set(&mut self, reading: &ContactReading, slip: &ContactSlip, weight: f64) {
        let (u, turn) = reading.direction();
        let slip = turned(&slip.velocity, &slip.covariance, &u, self.natural_speed);
        self.likelihood.of_slip(&SlipRead { slip, turn, weight }, &self.speeds);
    }

    /// The likeliest of the lags and the logarithm of its odds against none, where forces are late for sure.
    pub(super) fn sure(&self) -> Option<[f64; 2]> {
        let all = LAGS.into_iter().zip(&self.lagged).map(|(lag, lagged)| [lag, lagged.odds]);
        all.max_by(|a, b| a[1].total_cmp(&b[1])).filter(|[_, odds]| *odds > SURE)
    }
}
