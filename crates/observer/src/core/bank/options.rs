//! How a bank works.

use super::error::BankError;

/// What a bank remembers of the past.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// One Gaussian for each mode, merged before the update: the interacting multiple model of H. A. P. Blom and
    /// Y. Bar-Shalom (IEEE Trans. Automatic Control 33 (1988) 780-783). The cheapest; who has just switched is at once averaged
    /// with who has long been there, so switches are seen late where the mode's own states tell them apart.
    MergedBeforeUpdate,
    /// This many hypotheses about mode and time of the last switch after each sample, at least one for each mode. Those that come
    /// into a mode at a sample are one hypothesis; the lightest is merged into the nearest switch time of its mode.
    Hypotheses(usize),
}

/// How a [`Bank`](crate::bank::Bank) works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BankOptions {
    /// What is remembered of the past.
    pub memory: Memory,
    /// Probability that may be given up after each sample, from 0 to below 1, to run fewer hypotheses; with zero none is. Its sum
    /// is kept: [`Bank::lost`](crate::bank::Bank::lost).
    pub drop: f64,
    /// Probability, from 0 to below 1, under which a hypothesis is not even run, before a sample is weighed; what is skipped
    /// is counted as given up. Keep it well below the probability of every switch that matters: a switch that is less likely
    /// is never tried, however clearly the data speak for it.
    pub skip: f64,
    /// Samples, the newest included, over which modes are smoothed; with zero they are not. Costs that many numbers for each
    /// mode and hypothesis, copied at each sample.
    pub lag: usize,
}

/// Most numbers that a bank makes room for: four gigabytes.
const MOST_NUMBERS: f64 = 536_870_912.0;

impl Default for BankOptions {
    /// Eight hypotheses, nothing given up, no smoothing.
    fn default() -> Self {
        Self { memory: Memory::Hypotheses(8), drop: 0.0, skip: 0.0, lag: 0 }
    }
}

impl BankOptions {
    /// The largest number of hypotheses after a sample, for that many modes, the largest of them with so many states.
    pub(super) fn check(&self, modes: usize, states: usize) -> Result<usize, BankError> {
        for (what, value) in [("probability to drop", self.drop), ("probability to skip", self.skip)] {
            if !(0.0..1.0).contains(&value) {
                return Err(BankError::Value { what, value, needed: "from zero to below one" });
            }
        }
        let kept = match self.memory {
            Memory::MergedBeforeUpdate => modes,
            Memory::Hypotheses(found) if found < modes => {
                return Err(BankError::Hypotheses { found, needed: modes });
            }
            Memory::Hypotheses(kept) => kept,
        };
        // Two stores and the branches of a mixture, each with room for all in one mode.
        let each = (states * (states + 1)) as f64 + self.lag as f64 * modes as f64;
        let value = 3.0 * modes as f64 * (kept as f64 + 1.0) * each;
        if value > MOST_NUMBERS {
            let what = "number of numbers that the hypotheses and their paths take";
            let needed = "at most 2^29: keep fewer hypotheses, or smooth over a shorter lag";
            return Err(BankError::Value { what, value, needed });
        }
        Ok(kept)
    }
}
