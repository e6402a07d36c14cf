//! Odds of modes whose observers keep to themselves.

use super::error::BankError;
use super::log_weights::{log_sum, log_sum_exp};
use super::system::{check_sum, log_switches};

/// Odds between modes whose observers run apart, each on its own data, and do not mix: observers on a moving window
/// ([`NewtonObserver::log_density`](crate::newton::NewtonObserver::log_density),
/// [`BatchSolution::log_evidence`](crate::batch::BatchSolution::log_evidence)), or models that differ in a constant. A
/// [`Bank`](crate::bank::Bank) mixes states too, and is what to use where modes change.
///
/// ```
/// # fn main() -> Result<(), observer::bank::BankError> {
/// let mut odds = observer::bank::Odds::new(&[0.5, 0.5], &[&[1.0, 0.0], &[0.0, 1.0]])?;
/// odds.push(&[-1.0, -1.0 + 3.0_f64.ln()])?; // a sample that is three times as likely in mode 1
/// assert!((odds.probability(1) - 0.75).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Odds {
    log_switches: Vec<f64>,
    log_weights: Vec<f64>,
    /// The weights of a sample that may yet be refused.
    next: Vec<f64>,
    samples: usize,
}

impl Odds {
    /// Modes with these probabilities at the first sample, and `switches[from][to]` from sample to sample.
    ///
    /// # Errors
    /// [`BankError::NoMember`]; [`BankError::Sum`], [`BankError::RowSum`] and [`BankError::Value`] for what are no
    /// probabilities; [`BankError::Size`] for a table of the wrong size.
    pub fn new(start: &[f64], switches: &[&[f64]]) -> Result<Self, BankError> {
        if start.is_empty() {
            return Err(BankError::NoMember);
        }
        check_sum("start probabilities", start.iter().copied())?;
        let log_switches = log_switches(start.len(), switches)?;
        let log_weights: Vec<f64> = start.iter().map(|p| p.ln()).collect();
        Ok(Self { log_switches, next: log_weights.clone(), log_weights, samples: 0 })
    }

    /// Takes what each mode says of a sample: the logarithm of the density of the same outputs, given all before them; zeros
    /// where nothing was measured. Returns that of all modes together.
    ///
    /// # Errors
    /// [`BankError::Size`] for another number of modes; [`BankError::NotFinite`] for NaN or plus infinity;
    /// [`BankError::NoLikelihood`] where no mode that can be has any. The odds are then as before.
    pub fn push(&mut self, log_densities: &[f64]) -> Result<f64, BankError> {
        let (count, sample) = (self.log_weights.len(), self.samples);
        if log_densities.len() != count {
            let (what, found) = ("list of densities", log_densities.len());
            return Err(BankError::Size { what, mode: 0, found, needed: count });
        }
        if let Some(mode) = log_densities.iter().position(|l| l.is_nan() || *l == f64::INFINITY) {
            return Err(BankError::NotFinite { what: "likelihood", mode, sample });
        }
        // Against the largest: a weight would drown in the density of an outlier.
        let likeliest = log_densities.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if likeliest == f64::NEG_INFINITY {
            return Err(BankError::NoLikelihood { sample });
        }
        for (to, log_density) in log_densities.iter().enumerate() {
            let from = self.log_weights.iter().enumerate();
            let predicted = if sample == 0 {
                self.log_weights[to]
            } else {
                log_sum_exp(from.map(|(from, weight)| weight + self.log_switches[from * count + to]))
            };
            self.next[to] = predicted + (log_density - likeliest);
        }
        let (largest, rest) = log_sum(self.next.iter().copied());
        if largest == f64::NEG_INFINITY {
            return Err(BankError::NoLikelihood { sample });
        }
        self.next.iter_mut().for_each(|weight| *weight = *weight - largest - rest);
        std::mem::swap(&mut self.log_weights, &mut self.next);
        self.samples += 1;
        Ok(likeliest + largest + rest)
    }

    /// Probability of a mode; zero for a mode that there is not.
    #[must_use]
    pub fn probability(&self, mode: usize) -> f64 {
        self.log_weights.get(mode).map_or(0.0, |weight| weight.exp())
    }
}
