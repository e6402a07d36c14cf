//! Modes of a whole log: what comes after a sample counts as much as what came before it.
//!
//! Given the friction a contact is a chain, and forward and backward messages give its modes at every sample exactly. Frictions are
//! weighed by the evidence of the whole log, under two hypotheses that are weighed as well: that all contacts have one
//! friction, and that each has its own.

use super::classifier::ContactOdds;
use super::error::ContactModesError;
use super::friction::{LearnedFriction, learned, values};
use super::options::ContactModesOptions;
use super::passage::{Pace, Passage};
use super::reading::{ContactSeen, Place};

/// Prior probability that all contacts have one friction.
const ALIKE: f64 = 0.5;
/// Frictions whose probability is below this share of the most probable one's are left out of the modes.
const FAINT: f64 = 1e-4;
/// Frictions of a contact at most that modes are made for: of a contact that never slides neighbours count as one.
const MOST: usize = 24;

/// What a whole log tells of the modes of its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct WholeModes {
    /// For each contact its modes at each sample, given all samples.
    pub odds: Vec<Vec<ContactOdds>>,
    /// Of each contact, where it, or one of the same material, has slid for 10 ms with slips read and a probability of 0.99.
    pub frictions: Vec<Option<LearnedFriction>>,
    /// Probability that all contacts have one friction.
    pub one_friction: f64,
}

/// Tells the modes of contacts at all samples of a log from all of them, the friction unknown (from 0.02 to 2).
///
/// `times` are those of the samples, s; `seen` has for each contact what is read of it at each sample, slips with errors that
/// last for `lasting`, s (0 where they are independent from sample to sample).
///
/// # Errors
/// Where there is no contact, time does not go on, numbers of samples differ, an option is not usable, or a reading is not a number, has
/// no noise or is beyond reason.
pub fn whole_modes(
    times: &[f64],
    seen: &[Vec<ContactSeen>],
    lasting: f64,
    options: &ContactModesOptions,
) -> Result<WholeModes, ContactModesError> {
    check(times, seen, lasting, options)?;
    let pace = Pace::new(times, lasting);
    let frictions = values();
    let passages: Vec<Passage> = seen.iter().map(|seen| Passage::new(seen, &pace, options)).collect();
    let evidence: Vec<Vec<f64>> =
        passages.iter().map(|passage| passage.evidence(&pace, &frictions)).collect();
    let (one_friction, weights) = weigh(&evidence);
    if std::env::var("DBG").is_ok() {
        let best =
            |logs: &Vec<f64>| (0..logs.len()).max_by(|a, b| logs[*a].total_cmp(&logs[*b])).unwrap_or(0);
        let sums: Vec<f64> =
            (0..frictions.len()).map(|k| evidence.iter().map(|logs| logs[k]).sum()).collect();
        let shared = best(&sums);
        for logs in &evidence {
            let own = best(logs);
            eprintln!(
                "DBG own {:.3} log {:.1}, at shared {:.3} log {:.1}",
                frictions[own], logs[own], frictions[shared], logs[shared]
            );
        }
    }
    let odds: Vec<Vec<ContactOdds>> = passages
        .iter()
        .zip(&weights)
        .map(|(passage, weights)| {
            let mut sums = vec![[0.0; 3]; times.len()];
            for (friction, weight) in fewer(&frictions, weights) {
                passage.add(&pace, friction, weight, &mut sums);
            }
            sums.into_iter().map(normal).collect()
        })
        .collect();
    let slid: Vec<f64> = odds.iter().zip(seen).map(|(odds, seen)| pace.slid(odds, seen)).collect();
    let any = slid.iter().copied().fold(0.0, f64::max);
    let of = |(own, weights): (&f64, &Vec<f64>)| {
        learned(&frictions, weights, if one_friction > 0.5 { any } else { *own })
    };
    let frictions = slid.iter().zip(&weights).map(of).collect();
    Ok(WholeModes { odds, frictions, one_friction })
}

fn normal(sums: [f64; 3]) -> ContactOdds {
    let all: f64 = sums.iter().sum();
    let [off, slide, stick] = sums.map(|sum| sum / all);
    ContactOdds { off, slide, stick }
}

/// Probability that all contacts have one friction, and the weights of the frictions for each contact, which sum to one.
///
/// Of one friction all evidences multiply, and one prior counts; of one for each contact each has a prior of its own.
fn weigh(evidence: &[Vec<f64>]) -> (f64, Vec<Vec<f64>>) {
    let count = evidence[0].len();
    let sums: Vec<f64> = (0..count).map(|k| evidence.iter().map(|logs| logs[k]).sum()).collect();
    let (together, shared) = soft(&sums);
    let apart: Vec<(f64, Vec<f64>)> = evidence.iter().map(|logs| soft(logs)).collect();
    // Each mean over the grid is the evidence of a hypothesis with a prior that is even over it.
    let even = (count as f64).ln();
    let odds = (ALIKE / (1.0 - ALIKE)).ln() + (together - even)
        - apart.iter().map(|(log, _)| log - even).sum::<f64>();
    let one = if evidence.len() > 1 { 1.0 / (1.0 + (-odds).exp()) } else { 1.0 };
    let mixed = |(_, own): &(f64, Vec<f64>)| {
        own.iter().zip(&shared).map(|(own, shared)| one * shared + (1.0 - one) * own).collect()
    };
    (one, apart.iter().map(mixed).collect())
}

/// The logarithm of the sum of the exponentials, and their shares of it.
fn soft(logs: &[f64]) -> (f64, Vec<f64>) {
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = logs.iter().map(|log| (log - largest).exp()).sum();
    (largest + sum.ln(), logs.iter().map(|log| (log - largest).exp() / sum).collect())
}

/// The frictions that count, with their weights; neighbours are taken together where they are many.
fn fewer(frictions: &[f64], weights: &[f64]) -> Vec<(f64, f64)> {
    let most = weights.iter().copied().fold(0.0, f64::max);
    let counts: Vec<(f64, f64)> = frictions
        .iter()
        .zip(weights)
        .filter(|(_, weight)| **weight > FAINT * most)
        .map(|(friction, weight)| (*friction, *weight))
        .collect();
    counts
        .chunks(counts.len().div_ceil(MOST))
        .map(|group| {
            let sum: f64 = group.iter().map(|(_, weight)| weight).sum();
            (group.iter().map(|(friction, weight)| friction * weight).sum::<f64>() / sum, sum)
        })
        .collect()
}

fn check(
    times: &[f64],
    seen: &[Vec<ContactSeen>],
    lasting: f64,
    options: &ContactModesOptions,
) -> Result<(), ContactModesError> {
    options.check()?;
    if seen.is_empty() {
        return Err(ContactModesError::NoContact);
    }
    if !(0.0..1e9).contains(&lasting) {
        let (what, needed) = ("time for which errors of slips last", "not below zero and finite, in seconds");
        return Err(ContactModesError::Option { what, value: lasting, needed });
    }
    for (k, pair) in times.windows(2).enumerate() {
        let value = pair[1] - pair[0];
        if !(value > 0.0 && value < super::classifier::LONGEST) {
            return Err(ContactModesError::TimeStep { sample: k + 1, value });
        }
    }
    for (contact, seen) in seen.iter().enumerate() {
        if seen.len() != times.len() {
            let (found, samples) = (seen.len(), times.len());
            return Err(ContactModesError::Samples { contact, found, samples });
        }
        for (sample, seen) in seen.iter().enumerate() {
            if let ContactSeen::Read(reading) = seen {
                reading.check(Place { contact, sample }, options)?;
            }
        }
    }
    Ok(())
}
