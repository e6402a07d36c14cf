//! One contact at every coefficient of friction that it may have.

use super::bins::Bins;
use super::chain::{Chain, Likelihood};
use super::density::{Ratio, Slip};
use super::friction::{Cell, FrictionGrid, Guess, guessed};

/// Probabilities of one contact's modes, in the order off, slide, stick.
pub(super) type Modes = [f64; 3];

/// A chain for each friction, and how likely all was that this contact read, for each friction.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    chains: Vec<Chain>,
    cells: Vec<Cell>,
    pub(super) log_evidence: Vec<f64>,
    /// How likely each friction is; they sum to one.
    pub(super) weights: Vec<f64>,
    /// What it says of its friction.
    pub(super) guess: Guess,
    /// To work in.
    spares: Vec<Chain>,
    /// As long as the longest chain needs.
    likelihood: Likelihood,
    /// Sum over the frictions, by their weights: what the slip is weighed against. All ratios are one cell: the slip tells none from another.
    mean: Chain,
    spare: Chain,
    tried: Chain,
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
    },
}

impl Contact {
    pub(super) fn new(grid: &FrictionGrid) -> Self {
        let chains: Vec<Chain> = grid.steps.iter().map(Chain::new).collect();
        let longest = grid.steps.iter().map(|steps| steps.ratios.count()).max().unwrap_or(0);
        let mean = Chain { ratios: vec![0.0], ..chains[0].clone() };
        let likelihood = Likelihood { ratios: vec![0.0; longest], ..Likelihood::none(&grid.steps[0]) };
        let log_evidence = vec![0.0; chains.len()];
        let (spare, tried) = (mean.clone(), mean.clone());
        Self {
            spares: chains.clone(),
            chains,
            cells: grid.cells(),
            weights: vec![1.0 / log_evidence.len() as f64; log_evidence.len()],
            log_evidence,
            guess: Guess::NONE,
            likelihood,
            mean,
            spare,
            tried,
        }
    }

    /// So many time steps on.
    pub(super) fn predict(&mut self, grid: &FrictionGrid, times: usize) {
        for ((chain, spare), steps) in self.chains.iter_mut().zip(&mut self.spares).zip(&grid.steps) {
            (0..times).for_each(|_| chain.predict(steps, spare));
        }
    }

    /// Weighs all by the forces.
    pub(super) fn weigh_force(&mut self, force: &Force, grid: &FrictionGrid) {
        let shift = match force {
            Force::Silent => return,
            Force::Presses { touching, .. } => *touching,
            Force::Off | Force::Touches => 0.0,
        };
        for (i, cell) in self.cells.iter().enumerate() {
            self.likelihood.of_force(&grid.steps[i], force, cell);
            self.log_evidence[i] += self.chains[i].weigh(&self.likelihood, &mut self.spares[i]) + shift;
        }
    }

    /// Weighs all by the slip. `turn` is the deviation of the direction of friction, rad; `weight` the power of the density.
    pub(super) fn weigh_slip(&mut self, slip: &Slip, turn: f64, weight: f64, speeds: &Bins) {
        self.likelihood.of_slip(slip, turn, weight, speeds);
        let all = self.chains.iter_mut().zip(&mut self.spares).zip(&mut self.log_evidence);
        for ((chain, spare), log_evidence) in all {
            *log_evidence += chain.weigh(&self.likelihood, spare);
        }
    }

    /// What the ratio says of where in their cells the frictions are, after all of a sample was weighed.
    pub(super) fn learn(&mut self, ratio: &Ratio) {
        let all = self.cells.iter_mut().zip(&self.chains);
        all.for_each(|(cell, chain)| cell.learn(ratio, chain.slides()));
    }

    /// Mean and variance of the friction.
    pub(super) fn friction(&self) -> [f64; 2] {
        guessed(self.weights.iter().copied().zip(&self.cells))
    }

    /// What the modes would be with this slip, without taking it; needs [`Self::average`] before.
    pub(super) fn try_slip(&mut self, slip: &Slip, turn: f64, weight: f64, speeds: &Bins) -> Modes {
        self.likelihood.of_slip(slip, turn, weight, speeds);
        self.tried.clone_from(&self.mean);
        self.tried.weigh(&self.likelihood, &mut self.spare);
        of(&self.tried)
    }

    /// The mean of all chains by the weights of the frictions.
    pub(super) fn average(&mut self) -> Modes {
        let mean = &mut self.mean;
        mean.off = 0.0;
        mean.speeds.fill(0.0);
        mean.ratios[0] = 0.0;
        for (weight, chain) in self.weights.iter().zip(&self.chains) {
            mean.off += weight * chain.off;
            mean.speeds.iter_mut().zip(&chain.speeds).for_each(|(sum, mass)| *sum += weight * mass);
            mean.ratios[0] += weight * chain.sticks();
        }
        of(mean)
    }
}

fn of(chain: &Chain) -> Modes {
    let modes = [chain.off, chain.slides(), chain.sticks()];
    let all: f64 = modes.iter().sum();
    modes.map(|mass| mass / all)
}
