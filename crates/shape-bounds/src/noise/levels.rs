//! Where along a curve contacts are noisier than they are said to be.

use super::assumptions::RESOLVED;
use super::polynomial::{Known, Polynomials, Predictor, around, neighbours};
use super::roughness::departures;
use super::traced::{Part, Traced, overlap};
use glam::DVec3;
use std::ops::Range;

/// Predictions from both sides that leave the noise: each overestimates it by what it leaves of the curve, so that the smallest is right.
const PREDICTORS: [Predictor; 4] =
    [around(1, 1, 6, 3), around(1, 1, 4, 3), around(1, 1, 6, 5), around(1, 1, 6, 7)];
/// Contacts of the shortest run that is judged.
const SHORTEST: usize = 16;

/// A run of contacts that is rougher than stated.
#[derive(Clone, Debug)]
pub(super) struct Rough {
    pub(super) part: Part,
    pub(super) contacts: Range<usize>,
    /// Whether it is the whole curve.
    pub(super) whole: bool,
    /// Root mean square, over the stated deviation.
    pub(super) ratio: f64,
    /// The deviation of the noise over the stated one, no less than it is but for the stated odds.
    pub(super) at_most: f64,
    /// Odds of as much or more from noise as stated, at most, over all runs that were judged.
    pub(super) p_value: f64,
    /// Whether two predictions agree on the ratio: else some of it may be the curve, or an edge of the body.
    pub(super) resolved: bool,
}

/// Runs of 16, 32, 64 ... contacts, each beginning a quarter of its length after the one before, and the whole curve, that are rougher
/// than stated: by a binomial test on the share of departures from what their neighbours predict that is beyond two deviations, of
/// which a few are an edge and no noise. False alarms have the `odds` over all of the curve; the level of each run is `at_most` as
/// stated but for the odds `alpha`. Contacts that stand out of the curve are not looked at.
pub(super) fn rougher(curve: &Traced, odds: f64, alpha: f64) -> Vec<Rough> {
    let (left, [points, normals]) = departures(curve.contacts, alpha, curve.dimension);
    let runs = runs(left.len());
    let tests = (runs.len() * Part::ALL.len()).max(1) as f64;
    let mut found = Vec::new();
    for part in Part::ALL {
        let sums = PREDICTORS.map(|predictor| Sums::new(curve, &left, part, predictor));
        let departures = if part == Part::Normal { &normals } else { &points };
        let Some(beyond) = Sums::of_departures(curve, &left, part, departures) else { continue };
        for run in &runs {
            let mut squares: Vec<_> = sums.iter().filter_map(|s| s.as_ref()?.of(run)).collect();
            squares.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            let [(square, free), (next, _), ..] = squares[..] else { continue };
            let Some((share, _)) = beyond.of(run) else { continue };
            let p_value = (tests * share_tail(share, free)).min(1.0);
            if square > 1.0 && p_value < odds {
                found.push(Rough {
                    part,
                    contacts: span(&left, run, curve.contacts.len()),
                    whole: run.len() == left.len(),
                    ratio: square.sqrt(),
                    at_most: (square / least(alpha, free)).sqrt(),
                    p_value,
                    resolved: square > RESOLVED * RESOLVED * next,
                });
            }
        }
    }
    // Where noise is as stated as far as can be told, what is left elsewhere is the curve.
    if found.iter().any(|run| run.resolved) { found } else { Vec::new() }
}

/// The contacts of a run of those `left`, with what was left out between them and at the ends of the curve.
fn span(left: &[usize], run: &Range<usize>, count: usize) -> Range<usize> {
    let first = if run.start == 0 { 0 } else { left[run.start] };
    let end = if run.end == left.len() { count } else { left[run.end - 1] + 1 };
    first..end
}

fn runs(count: usize) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut length = SHORTEST;
    while length < count {
        let starts = (0..count - length).step_by(length / 4);
        runs.extend(starts.chain([count - length]).map(|first| first..first + length));
        length *= 2;
    }
    if count >= SHORTEST {
        runs.push(0..count);
    }
    runs
}

/// Sums of the squares that are not predicted, over those that were stated, from the first contact on.
struct Sums {
    sums: Vec<f64>,
    /// Components of a contact, and how many of them say as much as one that is independent.
    components: f64,
    overlap: f64,
}

impl Sums {
    fn new(curve: &Traced, left: &[usize], part: Part, predictor: Predictor) -> Option<Self> {
        let mut known = Known::default();
        let mut sums = vec![0.0];
        let mut components = 1;
        for (k, one) in left.iter().enumerate() {
            let others = neighbours(left, k, predictor)?;
            let polynomials = known.polynomials(*one, &others, predictor.degree);
            let contact = &curve.contacts[*one];
            let square = |j: usize| part.stated(&curve.contacts[j], curve.dimension).powi(2);
            let (mut vector, mut variance) = (part.value(contact), square(*one));
            for (j, weight) in others.iter().zip(&polynomials.weights) {
                vector -= part.value(&curve.contacts[*j]) * *weight;
                variance += square(*j) * weight * weight;
            }
            let (values, all) = part.components(contact, curve.dimension, vector);
            components = all;
            if variance <= 0.0 {
                return None;
            }
            sums.push(sums[k] + values.iter().map(|v| v * v).sum::<f64>() / variance);
        }
        let (reach, degree) = (predictor.before.1 as isize, predictor.degree);
        let places: Vec<f64> = (-reach..=reach).filter(|p| *p != 0).map(|p| p as f64).collect();
        let mut weights: Vec<f64> = Polynomials::over(&places, degree).weights.iter().map(|w| -w).collect();
        weights.insert(reach as usize, 1.0);
        Some(Self { sums, components: components as f64, overlap: overlap(&weights) })
    }

    /// The same of ones and zeros, for components of departures that are beyond two deviations or not.
    fn of_departures(curve: &Traced, left: &[usize], part: Part, departures: &[DVec3]) -> Option<Self> {
        let (mut sums, mut components) = (vec![0.0], 1);
        for (k, (one, vector)) in left.iter().zip(departures).enumerate() {
            let contact = &curve.contacts[*one];
            let variance = part.stated(contact, curve.dimension).powi(2);
            if variance <= 0.0 {
                return None;
            }
            let (values, all) = part.components(contact, curve.dimension, *vector);
            let beyond = values[..all].iter().filter(|v| **v * **v > 4.0 * variance).count();
            sums.push(sums[k] + beyond as f64);
            components = all;
        }
        Some(Self { sums, components: components as f64, overlap: 1.0 })
    }

    /// Mean square of a run, and how many independent ones it is the mean of.
    fn of(&self, run: &Range<usize>) -> Option<(f64, f64)> {
        let all = self.components * run.len() as f64;
        Some(((self.sums.get(run.end)? - self.sums[run.start]) / all, all / self.overlap))
    }
}

/// Odds of a normal deviate beyond two deviations.
const BEYOND: f64 = 0.045_500_3;

/// Odds of at least that share of so many normal deviates beyond two deviations, at most (Chernoff's bound).
fn share_tail(share: f64, count: f64) -> f64 {
    if share <= BEYOND {
        return 1.0;
    }
    let rest = if share < 1.0 { (1.0 - share) * ((1.0 - share) / (1.0 - BEYOND)).ln() } else { 0.0 };
    (-count * (share * (share / BEYOND).ln() + rest)).exp()
}

/// What a mean of so many squares of standard normals is below with odds of `alpha` at most (Chernoff's bound).
fn least(alpha: f64, count: f64) -> f64 {
    let tail = |mean: f64| (-0.5 * count * (mean - 1.0 - mean.ln())).exp();
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if tail(middle) > alpha { high = middle } else { low = middle }
    }
    low
}
