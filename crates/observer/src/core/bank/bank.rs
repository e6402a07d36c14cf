//! The bank: hypotheses are carried over a sample, weighed by it, and merged again.

use super::error::BankError;
use super::gaussian::{Branch, Gaussian};
use super::hypothesis::{Hypothesis, Store};
use super::log_weights::log_sum_exp;
use super::mixture::Mixture;
use super::options::{BankOptions, Memory};
use super::system::{Modes, check_sum};

/// A mode with its probability and its state: how a bank starts, and what it says.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeState {
    /// Probability of the mode.
    pub probability: f64,
    /// The state if it is this mode.
    pub state: Gaussian,
}

/// Observers of several modes of a system side by side, weighed by how well each predicts the same outputs.
pub struct Bank<I> {
    modes: Modes<I>,
    options: BankOptions,
    now: Store,
    /// What `now` becomes; in its place only when a sample went through.
    next: Store,
    mixture: Mixture,
    samples: usize,
    log_evidence: f64,
    lost: f64,
}

impl<I> Bank<I> {
    /// A bank that has seen no sample yet; `start` is the state of each mode at the first sample, before it is taken in.
    ///
    /// # Errors
    /// [`BankError::NoJump`] where a switch between states of unequal size has no map; [`BankError::Hypotheses`] and
    /// [`BankError::Value`] for unusable options; [`BankError::Size`], [`BankError::NotFinite`], [`BankError::Covariance`] and
    /// [`BankError::Sum`] for an unusable start.
    pub fn new(modes: Modes<I>, start: &[ModeState], options: BankOptions) -> Result<Self, BankError> {
        modes.check_jumps()?;
        let count = modes.count();
        let kept = options.check(count)?;
        if start.len() != count {
            return Err(BankError::Size { what: "start", mode: 0, found: start.len(), needed: count });
        }
        check_sum("start probabilities", start.iter().map(|s| s.probability))?;
        let sizes: Vec<usize> = (0..count).map(|mode| modes.member(mode).states()).collect();
        let mut now = Store::new(&sizes, kept + 1, options.lag);
        for (mode, ModeState { probability, state }) in start.iter().enumerate() {
            check_start(state, mode, sizes[mode])?;
            if *probability > 0.0 {
                let hypothesis = now.add(mode);
                hypothesis.log_weight = probability.ln();
                hypothesis.state.copy_from(state);
            }
        }
        let mixture = Mixture::new(&sizes, kept + 1).with_paths(options.lag * count);
        let next = now.clone();
        Ok(Self { modes, options, now, next, mixture, samples: 0, log_evidence: 0.0, lost: 0.0 })
    }

    /// Takes a sample: switches, predicts over the interval of `input` (neither for the first one), weighs and corrects.
    /// Outputs that were not measured are `None`; without any the modes only go on. Returns the logarithm of the density of what
    /// was measured, given all before it. Allocates nothing.
    ///
    /// # Errors
    /// [`BankError::Readings`] and [`BankError::NotFinite`] for an unusable sample; [`BankError::Covariance`],
    /// [`BankError::NotFinite`] and [`BankError::NoLikelihood`] where the modes cannot deal with it. The bank is then as before.
    pub fn push(&mut self, input: &I, measured: &[Option<f64>]) -> Result<f64, BankError> {
        let sample = self.samples;
        if measured.len() != self.modes.outputs() {
            let (found, needed) = (measured.len(), self.modes.outputs());
            return Err(BankError::Readings { sample, found, needed });
        }
        if let Some(mode) = measured.iter().position(|y| y.is_some_and(|y| !y.is_finite())) {
            return Err(BankError::NotFinite { what: "reading", mode, sample });
        }
        self.next.clear();
        let lost = if sample == 0 {
            self.copy();
            0.0
        } else {
            self.switch(input);
            self.drop_light()
        };
        self.weigh(input, measured)?;
        let total = self.next.log_total();
        if total == f64::NEG_INFINITY {
            return Err(BankError::NoLikelihood { sample });
        }
        self.next.divide(total);
        // Without outputs the total is one to rounding.
        let log_density = if measured.iter().any(Option::is_some) { total } else { 0.0 };
        self.note_modes();
        self.merge_lightest();
        std::mem::swap(&mut self.now, &mut self.next);
        self.samples += 1;
        self.log_evidence += log_density;
        self.lost += lost;
        Ok(log_density)
    }

    /// The first sample comes before any switch.
    fn copy(&mut self) {
        for hypothesis in self.now.all() {
            keep(hypothesis, hypothesis.log_weight, &mut self.next);
        }
    }

    /// Those that stay go on each by itself; those that come into a mode from others become one hypothesis of it, or, merged
    /// before the update, join those that stay.
    fn switch(&mut self, input: &I) {
        for to in 0..self.modes.count() {
            self.mixture.clear();
            for from in 0..self.modes.count() {
                let log_switch = self.modes.log_switch(from, to);
                if log_switch == f64::NEG_INFINITY {
                    continue;
                }
                let stays = from == to && self.options.memory != Memory::MergedBeforeUpdate;
                for hypothesis in self.now.of(from) {
                    let log_weight = hypothesis.log_weight + log_switch;
                    if stays {
                        keep(hypothesis, log_weight, &mut self.next);
                    } else {
                        let landed = self.mixture.add(to, log_weight, hypothesis);
                        self.modes.land(from, to, &hypothesis.state, input, landed);
                    }
                }
            }
            if self.mixture.len() > 0 {
                let newcomer = self.next.add(to);
                newcomer.since = self.samples;
                self.mixture.merge_into(&self.modes, newcomer);
            }
        }
        for hypothesis in self.next.all_mut() {
            self.modes.member(hypothesis.mode).predict(&mut hypothesis.state, input);
        }
    }

    /// Gives up the lightest hypotheses as long as the mass of all that go stays within the options' share. What goes comes
    /// back through the switches.
    fn drop_light(&mut self) -> f64 {
        let mut gone = 0.0;
        while let Some((mode, index)) = self.next.lightest(1) {
            let mass = self.next.of(mode)[index].probability();
            if gone + mass > self.options.drop || self.next.count() == 1 {
                break;
            }
            gone += mass;
            self.next.remove(mode, index);
        }
        if gone > 0.0 {
            let kept = self.next.log_total();
            self.next.divide(kept);
        }
        gone
    }

    fn weigh(&mut self, input: &I, measured: &[Option<f64>]) -> Result<(), BankError> {
        let sample = self.samples;
        let any = measured.iter().any(Option::is_some);
        for hypothesis in self.next.all_mut() {
            let mode = hypothesis.mode;
            if any {
                let member = self.modes.member(mode);
                let log_density = member.correct(&mut hypothesis.state, input, measured);
                hypothesis.log_weight += log_density.ok_or(BankError::Covariance { mode, sample })?;
            }
            if hypothesis.log_weight.is_nan() || hypothesis.log_weight == f64::INFINITY {
                return Err(BankError::NotFinite { what: "likelihood", mode, sample });
            }
            if !hypothesis.state.is_finite() {
                return Err(BankError::NotFinite { what: "state", mode, sample });
            }
            if hypothesis.state.covariance.diagonal().iter().any(|v| *v < 0.0) {
                return Err(BankError::Covariance { mode, sample });
            }
        }
        Ok(())
    }

    /// Writes the mode of this sample into every path.
    fn note_modes(&mut self) {
        if self.options.lag == 0 {
            return;
        }
        let (count, row) = (self.modes.count(), self.samples % self.options.lag);
        for hypothesis in self.next.all_mut() {
            let here = &mut hypothesis.path[row * count..(row + 1) * count];
            here.fill(0.0);
            here[hypothesis.mode] = 1.0;
        }
    }

    /// As long as there are more hypotheses than are kept, the lightest joins the one of its mode whose switch time is
    /// nearest. Nothing is discarded: the youngest would go first, and with them every switch.
    fn merge_lightest(&mut self) {
        let Memory::Hypotheses(kept) = self.options.memory else { return };
        while self.next.count() > kept {
            // There is one: more hypotheses than modes.
            let Some((mode, index)) = self.next.lightest(2) else { break };
            let Some(other) = self.next.nearest(mode, index) else { break };
            self.mixture.clear();
            for i in [other, index] {
                let hypothesis = &self.next.of(mode)[i];
                self.mixture.add(mode, hypothesis.log_weight, hypothesis).copy_from(&hypothesis.state);
            }
            self.mixture.merge_into(&self.modes, &mut self.next.of_mut(mode)[other]);
            self.next.remove(mode, index);
        }
    }

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

    /// Sum of the probabilities that were given up ([`BankOptions::drop`]): if the model is true, the expected probability that
    /// the true hypothesis is among the lost ones, and over the threshold `a` divided by `a`, a bound of the probability that
    /// the lost ones ever had more than `a` (Doob: a posterior probability is a martingale).
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
            let total = log_sum_exp(self.now.of(mode).iter().map(|h| h.log_weight));
            if total == f64::NEG_INFINITY {
                return ModeState { probability: 0.0, state };
            }
            let branch =
                |h: &Hypothesis| Branch { weight: (h.log_weight - total).exp(), gaussian: h.state.clone() };
            let branches: Vec<Branch> = self.now.of(mode).iter().map(branch).collect();
            member.merge(&branches, &mut state);
            ModeState { probability: total.exp(), state }
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
                    needed: row + 1,
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

fn check_start(state: &Gaussian, mode: usize, needed: usize) -> Result<(), BankError> {
    if !state.is_of_size(needed) {
        return Err(BankError::Size { what: "start state", mode, found: state.mean.len(), needed });
    }
    if !state.is_finite() {
        return Err(BankError::NotFinite { what: "start", mode, sample: 0 });
    }
    state.covariance.clone().cholesky().map(|_| ()).ok_or(BankError::Covariance { mode, sample: 0 })
}

/// A hypothesis goes on as it is, with another weight.
fn keep(hypothesis: &Hypothesis, log_weight: f64, next: &mut Store) {
    let kept = next.add(hypothesis.mode);
    kept.since = hypothesis.since;
    kept.log_weight = log_weight;
    kept.state.copy_from(&hypothesis.state);
    kept.path.copy_from_slice(&hypothesis.path);
}
