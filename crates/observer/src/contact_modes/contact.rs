//! One contact at every coefficient of friction that it may have.

use super::asleep::Followed;
use super::bins::Bins;
use super::chain::Chain;
use super::density::{Ratio, Slip};
use super::foretold::Foretold;
use super::friction::{Cell, FrictionGrid, Guess, guessed};
use super::likelihood::{Likelihood, Part};

/// Probabilities of one contact's modes, in the order off, slide, stick.
pub(super) type Modes = [f64; 3];

/// A chain for each friction, and how likely all was that this contact read, for each friction.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    pub(super) chains: Vec<Chain>,
    /// How each friction is.
    pub(super) followed: Vec<Followed>,
    cells: Vec<Cell>,
    pub(super) log_evidence: Vec<f64>,
    /// Of the largest friction after the sample before.
    pub(super) largest_before: f64,
    /// Mean and deviation of the ratio by the largest friction, after the sample before, where it sticks.
    pub(super) ratio: Option<[f64; 2]>,
    /// Deviation of the latest ratio that was read.
    pub(super) noise: f64,
    /// How likely each friction is; they sum to one.
    pub(super) weights: Vec<f64>,
    /// What it says of its friction.
    pub(super) guess: Guess,
    /// To work in.
    spares: Vec<Chain>,
    /// As long as the longest chain needs.
    likelihood: Likelihood,
    /// Of the bins of the ratio that all frictions have.
    of_all: Part,
    /// Of a slip alone, which says the same of all ratios: they are one cell.
    by_slip: Likelihood,
    /// Sum over the frictions, by their weights: what the slip is weighed against. All ratios are one cell: the slip tells none from another.
    pub(super) mean: Chain,
    spare: Chain,
    tried: Chain,
}

/// A slip that was read.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlipRead {
    pub(super) slip: Slip,
    /// Deviation of the direction of friction, rad.
    pub(super) turn: f64,
    /// Power of its density.
    pub(super) weight: f64,
}

/// What a contact's forces tell.
#[derive(Clone, Copy, Debug)]
pub(super) enum Force {
    /// Nothing.
    Silent,
    /// It does not touch, for sure.
    Off,
    /// It touches, but its force tells nothing.
    Touches,
    /// It presses.
    Presses {
        ratio: Ratio,
        /// Log-densities of the normal force where it touches and where it does not; the latter is minus infinity where it
        /// is known to touch.
        touching: f64,
        off: f64,
        /// What the ratios before say of this one.
        foretold: Foretold,
    },
}

impl Contact {
    pub(super) fn new(grid: &FrictionGrid) -> Self {
        let chains: Vec<Chain> = grid.steps.iter().map(Chain::new).collect();
        let longest = grid.steps.iter().map(|steps| steps.ratios.count()).max().unwrap_or(0);
        let mean = Chain { ratios: vec![0.0], ..chains[0].clone() };
        let log_evidence = vec![0.0; chains.len()];
        let (spare, tried) = (mean.clone(), mean.clone());
        Self {
            spares: chains.clone(),
            followed: vec![Followed::Alone; chains.len()],
            chains,
            cells: grid.cells(),
            weights: vec![1.0 / log_evidence.len() as f64; log_evidence.len()],
            log_evidence,
            largest_before: 0.0,
            ratio: None,
            noise: 0.0,
            guess: Guess::NONE,
            likelihood: Likelihood::none(longest),
            of_all: Part::none(grid.of_all.count()),
            by_slip: Likelihood::none(1),
            mean,
            spare,
            tried,
        }
    }

    /// A time step on.
    pub(super) fn predict(&mut self, grid: &FrictionGrid) {
        for (i, steps) in grid.steps.iter().enumerate().filter(|(i, _)| self.followed[*i] == Followed::Alone)
        {
            (0..grid.times).for_each(|_| self.chains[i].predict(steps, &mut self.spares[i]));
        }
    }

    /// Weighs all by what a force and a slip say at once: where there is none, by the other alone.
    pub(super) fn weigh(
        &mut self,
        force: &Force,
        slip: Option<&SlipRead>,
        grid: &FrictionGrid,
        speeds: &Bins,
    ) {
        let shift = match force {
            Force::Silent if slip.is_none() => return,
            Force::Presses { touching, .. } => *touching,
            Force::Silent | Force::Off | Force::Touches => 0.0,
        };
        if let Force::Presses { ratio, foretold, .. } = force {
            self.rouse(grid, ratio);
            self.of_all.of_bins(&grid.of_all, ratio, foretold);
        }
        slip.iter().for_each(|slip| self.by_slip.of_slip(slip, speeds));
        for (i, cell) in self.cells.iter().enumerate().filter(|(i, _)| self.followed[*i] == Followed::Alone) {
            self.likelihood.of_force(&grid.steps[i], force, cell, Some(&self.of_all));
            if slip.is_some() {
                self.likelihood.add_slip(&self.by_slip);
            }
            self.log_evidence[i] += self.chains[i].weigh(&self.likelihood, &mut self.spares[i]) + shift;
        }
    }

    /// What the ratio says of where in their cells the frictions are, after all of a sample was weighed.
    pub(super) fn learn(&mut self, ratio: &Ratio) {
        let all = self.cells.iter_mut().zip(&self.chains).zip(&self.followed);
        let alone = all.filter(|(_, of)| **of == Followed::Alone);
        alone.for_each(|((cell, chain), _)| cell.learn(ratio, chain.at_friction()));
    }

    /// Mean and variance of the friction.
    pub(super) fn friction(&self) -> [f64; 2] {
        guessed(self.weights.iter().copied().zip(&self.cells))
    }

    /// What the modes would be with this slip, without taking it; needs [`Self::average`] before.
    pub(super) fn try_slip(&mut self, slip: &SlipRead, speeds: &Bins) -> Modes {
        self.by_slip.of_slip(slip, speeds);
        self.tried.clone_from(&self.mean);
        self.tried.weigh(&self.by_slip, &mut self.spare);
        of(&self.tried)
    }

    /// The mean of all chains by the weights of the frictions.
    pub(super) fn average(&mut self) -> Modes {
        let mean = &mut self.mean;
        (mean.off, mean.edge) = (0.0, 0.0);
        mean.speeds.fill(0.0);
        mean.ratios[0] = 0.0;
        let last = self.chains.len() - 1;
        let is_alone = |i: &usize| self.followed[*i] == Followed::Alone;
        let others: f64 = (0..last).filter(|i| !is_alone(i)).map(|i| self.weights[i]).sum();
        for i in (0..=last).filter(is_alone) {
            // All others are as the largest, or of no account.
            let weight = self.weights[i] + if i == last { others } else { 0.0 };
            let chain = &self.chains[i];
            mean.off += weight * chain.off;
            mean.edge += weight * chain.edge;
            mean.speeds.iter_mut().zip(&chain.speeds).for_each(|(sum, mass)| *sum += weight * mass);
            mean.ratios[0] += weight * (chain.sticks() - chain.edge).max(0.0);
        }
        of(mean)
    }
}

fn of(chain: &Chain) -> Modes {
    let modes = [chain.off, chain.slides(), chain.sticks()];
    let all: f64 = modes.iter().sum();
    modes.map(|mass| mass / all)
}
