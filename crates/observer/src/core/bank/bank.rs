//! The bank: hypotheses are carried over a sample, weighed by it, and merged again.

use super::error::BankError;
use super::gaussian::Gaussian;
use super::hypothesis::{Hypothesis, Store};
use super::mixture::Mixture;
use super::options::{BankOptions, Memory};
use super::system::{Modes, check_sum};

/// Difference of a covariance from its transpose, as a share of its largest entry, that passes for rounding.
const ASYMMETRY: f64 = 1e-9;

/// A mode with its probability and its state: how a bank starts, and what it says.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeState {
    /// Probability of the mode.
    pub probability: f64,
    /// The state if it is this mode.
    pub state: Gaussian,
}

/// Observers of several modes of a system side by side, weighed by how well each predicts the same outputs.
///
/// The modes may have states of different size. Each sample is one step of all hypotheses, and a hypothesis is a mode and the
/// time of its last switch; [`Memory`] says how many are kept. A bank makes nothing on the way: all room is made at the start.
pub struct Bank<I> {
    pub(super) modes: Modes<I>,
    pub(super) options: BankOptions,
    pub(super) now: Store,
    /// What `now` becomes; in its place only when a sample went through.
    next: Store,
    mixture: Mixture,
    pub(super) samples: usize,
    pub(super) log_evidence: f64,
    pub(super) lost: f64,
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
        if start.len() != count {
            return Err(BankError::Size { what: "start", mode: 0, found: start.len(), needed: count });
        }
        check_sum("start probabilities", start.iter().map(|s| s.probability))?;
        let sizes: Vec<usize> = (0..count).map(|mode| modes.member(mode).states()).collect();
        let kept = options.check(count, sizes.iter().copied().max().unwrap_or(0))?;
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
    /// [`BankError::Readings`] and [`BankError::NotFinite`] for an unusable sample; [`BankError::RowSum`] and
    /// [`BankError::Value`] for rates ([`Modes::with_rates`]) that are no probabilities; [`BankError::Covariance`],
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
        let BankOptions { skip, drop, .. } = self.options;
        let mut lost = 0.0;
        if sample == 0 {
            self.copy();
        } else {
            self.switch(input)?;
            lost += self.next.give_up(|mass, _| mass < skip);
            self.predict(input);
        }
        let log_density = self.weigh(input, measured)?;
        // What goes comes back through the switches; as it is weighed before it goes, also through rare ones.
        lost += self.next.give_up(|_, gone| drop > 0.0 && gone <= drop);
        self.note_modes();
        self.merge_lightest();
        self.check_states()?;
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
    fn switch(&mut self, input: &I) -> Result<(), BankError> {
        for Hypothesis { mode, state, log_row, .. } in self.now.all_mut() {
            self.modes.log_row(*mode, state, input, log_row)?;
        }
        for to in 0..self.modes.count() {
            self.mixture.clear();
            for from in 0..self.modes.count() {
                let stays = from == to && self.options.memory != Memory::MergedBeforeUpdate;
                for hypothesis in self.now.of(from) {
                    let log_weight = hypothesis.log_weight + hypothesis.log_row[to];
                    if log_weight == f64::NEG_INFINITY {
                        continue;
                    }
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
        Ok(())
    }

    fn predict(&mut self, input: &I) {
        for hypothesis in self.next.all_mut() {
            self.modes.member(hypothesis.mode).predict(&mut hypothesis.state, input);
        }
    }

    /// Corrects every hypothesis and weighs it. Returns the logarithm of the density of all together.
    fn weigh(&mut self, input: &I, measured: &[Option<f64>]) -> Result<f64, BankError> {
        let sample = self.samples;
        let any = measured.iter().any(Option::is_some);
        let mut largest = f64::NEG_INFINITY;
        for hypothesis in self.next.all_mut() {
            let mode = hypothesis.mode;
            hypothesis.log_density = 0.0;
            if any {
                let member = self.modes.member(mode);
                let log_density = member.correct(&mut hypothesis.state, input, measured);
                hypothesis.log_density = log_density.ok_or(BankError::Covariance { mode, sample })?;
            }
            if hypothesis.log_density.is_nan() || hypothesis.log_density == f64::INFINITY {
                return Err(BankError::NotFinite { what: "likelihood", mode, sample });
            }
            largest = largest.max(hypothesis.log_density);
        }
        if largest == f64::NEG_INFINITY {
            return Err(BankError::NoLikelihood { sample });
        }
        // Against the largest: a weight would drown in the density of an outlier.
        self.next.all_mut().for_each(|h| h.log_weight += h.log_density - largest);
        let total = self.next.normalise();
        if total == f64::NEG_INFINITY {
            return Err(BankError::NoLikelihood { sample });
        }
        // Without outputs the total is one to rounding.
        Ok(if any { largest + total } else { 0.0 })
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

    fn check_states(&self) -> Result<(), BankError> {
        let sample = self.samples;
        for &Hypothesis { mode, ref state, .. } in self.next.all() {
            if !state.is_finite() {
                return Err(BankError::NotFinite { what: "state", mode, sample });
            }
            if state.has_negative_variance() {
                return Err(BankError::Covariance { mode, sample });
            }
        }
        Ok(())
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
}

fn check_start(state: &Gaussian, mode: usize, needed: usize) -> Result<(), BankError> {
    if !state.is_of_size(needed) {
        return Err(BankError::Size { what: "start state", mode, found: state.mean.len(), needed });
    }
    if !state.is_finite() {
        return Err(BankError::NotFinite { what: "start", mode, sample: 0 });
    }
    let asymmetry = (&state.covariance - state.covariance.transpose()).amax();
    if asymmetry > ASYMMETRY * state.covariance.amax() {
        return Err(BankError::Covariance { mode, sample: 0 });
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
