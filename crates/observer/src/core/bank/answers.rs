//! What a bank says about modes and states.

use super::bank::{Bank, ModeState};
use super::error::BankError;
use super::gaussian::{Branch, Gaussian};
use super::hypothesis::Hypothesis;
use super::log_weights::{log_sum, log_sum_exp};
use super::system::Modes;

impl<I> Bank<I> {
    /// The modes and their switches.
    #[must_use]
    pub fn modes(&self) -> &Modes<I> {
        &self.modes
    }

    /// Samples taken.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Logarithm of the density of all that was measured.
    #[must_use]
    pub fn log_evidence(&self) -> f64 {
        self.log_evidence
    }

    /// Sum of the probabilities that were given up ([`BankOptions::drop`](crate::bank::BankOptions::drop),
    /// [`BankOptions::skip`](crate::bank::BankOptions::skip)). If the model is true, the truth is among what went with at most this
    /// probability; and the probability that what went ever comes to have more than a share `a` is at most this over `a`
    /// (a posterior probability is a martingale; Doob).
    #[must_use]
    pub fn lost(&self) -> f64 {
        self.lost
    }

    /// Probability of a mode given all samples so far; zero for a mode that there is not.
    #[must_use]
    pub fn probability(&self, mode: usize) -> f64 {
        if mode < self.modes.count() {
            log_sum_exp(self.now.of(mode).iter().map(|h| h.log_weight)).exp()
        } else {
            0.0
        }
    }

    /// What the bank holds, mode by mode.
    pub fn hypotheses(&self) -> impl Iterator<Item = &Hypothesis> {
        self.now.all()
    }

    /// Probability that the mode was `mode` so many samples before the newest, given all so far. None beyond the options' lag
    /// or the first sample.
    #[must_use]
    pub fn smoothed(&self, back: usize, mode: usize) -> Option<f64> {
        if back >= self.samples.min(self.options.lag) || mode >= self.modes.count() {
            return None;
        }
        let row = (self.samples - 1 - back) % self.options.lag;
        let of = |h: &Hypothesis| h.probability() * h.path[row * self.modes.count() + mode];
        Some(self.now.all().map(of).sum())
    }

    /// Each mode with its probability and its state; a mode without any hypothesis has probability zero and a state of zeros.
    /// Allocates.
    #[must_use]
    pub fn mode_states(&self) -> Vec<ModeState> {
        let of = |mode| {
            let member = self.modes.member(mode);
            let mut state = Gaussian::zeros(member.states());
            let (largest, rest) = log_sum(self.now.of(mode).iter().map(|h| h.log_weight));
            if largest == f64::NEG_INFINITY {
                return ModeState { probability: 0.0, state };
            }
            let branch = |h: &Hypothesis| Branch {
                weight: (h.log_weight - largest - rest).exp(),
                gaussian: h.state.clone(),
            };
            let branches: Vec<Branch> = self.now.of(mode).iter().map(branch).collect();
            member.merge(&branches, &mut state);
            ModeState { probability: (largest + rest).exp(), state }
        };
        (0..self.modes.count()).map(of).collect()
    }

    /// Mean and covariance, over all modes, of what they have in common: `rows[mode]` names the entries of that mode's state, in
    /// the same order for every mode. The entries are averaged as numbers: not for orientations. Allocates.
    ///
    /// # Errors
    /// [`BankError::Size`] for rows that do not fit the modes or each other.
    pub fn common(&self, rows: &[&[usize]]) -> Result<Gaussian, BankError> {
        let count = self.modes.count();
        if rows.len() != count {
            return Err(BankError::Size { what: "list of rows", mode: 0, found: rows.len(), needed: count });
        }
        for (mode, of_mode) in rows.iter().enumerate() {
            let needed = rows[0].len();
            if of_mode.len() != needed {
                return Err(BankError::Size { what: "rows", mode, found: of_mode.len(), needed });
            }
            let states = self.modes.member(mode).states();
            if let Some(&row) = of_mode.iter().find(|r| **r >= states) {
                return Err(BankError::Size {
                    what: "state, short of its rows,",
                    mode,
                    found: states,
                    needed: row.saturating_add(1),
                });
            }
        }
        let mut common = Gaussian::zeros(rows[0].len());
        let entry = |h: &Hypothesis, i: usize| h.state.mean[rows[h.mode][i]];
        for h in self.now.all() {
            for i in 0..common.mean.len() {
                common.mean[i] += h.probability() * entry(h, i);
            }
        }
        for h in self.now.all() {
            for (i, &row) in rows[h.mode].iter().enumerate() {
                for (j, &column) in rows[h.mode].iter().enumerate() {
                    let apart = (entry(h, i) - common.mean[i]) * (entry(h, j) - common.mean[j]);
                    common.covariance[(i, j)] +=
                        h.probability() * (h.state.covariance[(row, column)] + apart);
                }
            }
        }
        Ok(common)
    }
}
