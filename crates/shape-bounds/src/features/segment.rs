//! A curve of contacts, cut into runs of one kind.

use super::evidence::{Evidence, evidence};
use super::found::{FeatureOptions, FeatureRun};
use super::moments::Sums;

/// Places of a curve at which a run may begin, at most, before the ends are refined sample by sample.
const PLACES: usize = 300;

/// The runs of a curve that are most probable together; their curve is left 0.
///
/// A run costs what its begin is known by, one of all samples, and what Schwarz takes for its two constants.
pub(super) fn runs(sums: &Sums, options: &FeatureOptions) -> Vec<FeatureRun> {
    if sums.len() == 0 {
        return Vec::new();
    }
    let mut ends = coarse(sums);
    let step = sums.len().div_ceil(PLACES);
    // Ends move by less than a step each time; a second time after their neighbours have.
    for _ in 0..2 {
        refine(sums, &mut ends, step);
    }
    let mut first = 0;
    let mut runs = Vec::with_capacity(ends.len());
    for end in ends {
        let evidence = of(sums, first, end);
        let (kind, odds) = evidence.best();
        let is_sure = odds >= options.odds.ln();
        runs.push(FeatureRun {
            curve: 0,
            first,
            count: end - first,
            kind: is_sure.then_some(kind),
            log_evidence: evidence.0,
            log_odds: odds,
            feature: None,
        });
        first = end;
    }
    runs
}

fn of(sums: &Sums, first: usize, end: usize) -> Evidence {
    evidence(&sums.of(first, end))
}

/// Ends of the runs, on a grid: the best way to each place from all before it that may still lead to the best (Killick, Fearnhead and
/// Eckley 2012).
fn coarse(sums: &Sums) -> Vec<usize> {
    let cost = 2.0 * (sums.len() as f64).ln();
    let places = sums.len().min(PLACES);
    let at = |k: usize| k * sums.len() / places;
    let mut best = vec![(0.0, 0)];
    let mut open = vec![0];
    for k in 1..=places {
        let reached: Vec<f64> =
            open.iter().map(|&i: &usize| best[i].0 + of(sums, at(i), at(k)).total()).collect();
        let (from, value) = open.iter().zip(&reached).fold((0, f64::NEG_INFINITY), |most, (&i, &value)| {
            if value > most.1 { (i, value) } else { most }
        });
        best.push((value - cost, from));
        let mut values = reached.into_iter();
        // Twice the cost: evidence of two parts may be below that of the whole by what each pays for its angles.
        open.retain(|_| values.next().is_some_and(|v| v >= value - 2.0 * cost));
        open.push(k);
    }
    let mut ends = vec![];
    let mut k = places;
    while k > 0 {
        ends.push(at(k));
        k = best[k].1;
    }
    ends.reverse();
    ends
}

/// Moves each end to where the two runs beside it are most probable together, by less than `step`.
fn refine(sums: &Sums, ends: &mut [usize], step: usize) {
    for k in 0..ends.len().saturating_sub(1) {
        let first = if k == 0 { 0 } else { ends[k - 1] };
        let (now, end) = (ends[k], ends[k + 1]);
        let low = (first + 1).max(now.saturating_sub(step - 1));
        let high = (end - 1).min(now + step - 1);
        let total = |at: usize| of(sums, first, at).total() + of(sums, at, end).total();
        let start = (now, total(now));
        let better = |most: (usize, f64), at: usize| {
            let value = total(at);
            if value > most.1 { (at, value) } else { most }
        };
        ends[k] = (low..=high).fold(start, better).0;
    }
}
