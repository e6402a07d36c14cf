//! Hypotheses that are about to become one, in room that is made once.

use super::gaussian::{Branch, Gaussian};
use super::hypothesis::Hypothesis;
use super::log_weights::log_sum;
use super::system::Modes;

/// Branches of one mode at a time.
pub(super) struct Mixture {
    /// Room for the branches of each mode, in its own size.
    rooms: Vec<Vec<Branch>>,
    log_weights: Vec<f64>,
    /// Of every branch the path that leads to it.
    paths: Vec<Vec<f64>>,
    used: usize,
    mode: usize,
}

impl Mixture {
    /// Room for so many branches of any mode; `states` are the modes' sizes.
    pub(super) fn new(states: &[usize], room: usize) -> Self {
        let branch = |size: usize| Branch { weight: 0.0, gaussian: Gaussian::zeros(size) };
        Self {
            rooms: states.iter().map(|&size| vec![branch(size); room]).collect(),
            log_weights: vec![0.0; room],
            paths: vec![Vec::new(); room],
            used: 0,
            mode: 0,
        }
    }

    /// The same with room for paths of that length.
    pub(super) fn with_paths(mut self, length: usize) -> Self {
        self.paths.iter_mut().for_each(|p| p.resize(length, 0.0));
        self
    }

    pub(super) fn clear(&mut self) {
        self.used = 0;
    }

    pub(super) fn len(&self) -> usize {
        self.used
    }

    /// One more branch, all of the same mode, that comes from `source`; its state is what is returned, to be written.
    pub(super) fn add(&mut self, mode: usize, log_weight: f64, source: &Hypothesis) -> &mut Gaussian {
        let index = self.used;
        (self.used, self.mode) = (index + 1, mode);
        self.log_weights[index] = log_weight;
        self.paths[index].copy_from_slice(&source.path);
        &mut self.rooms[mode][index].gaussian
    }

    /// Puts all branches into one: weight, state and path. There is at least one.
    pub(super) fn merge_into<I>(&mut self, modes: &Modes<I>, into: &mut Hypothesis) {
        let branches = &mut self.rooms[self.mode][..self.used];
        let (largest, rest) = log_sum(self.log_weights[..self.used].iter().copied());
        for (branch, log_weight) in branches.iter_mut().zip(&self.log_weights) {
            branch.weight = (log_weight - largest - rest).exp();
        }
        modes.member(self.mode).merge(branches, &mut into.state);
        into.log_weight = largest + rest;
        into.path.fill(0.0);
        for (branch, path) in branches.iter().zip(&self.paths) {
            into.path.iter_mut().zip(path).for_each(|(sum, p)| *sum += branch.weight * p);
        }
    }
}
