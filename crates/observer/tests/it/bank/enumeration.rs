//! Banks against the sum over all sequences of modes, each followed by a Kalman filter in its textbook form.

use super::target::*;
use nalgebra::{DMatrix, DVector};
use observer::bank::*;
use std::f64::consts::TAU;

/// One sequence of modes: its probability together with the density of the readings, and the state at its end.
#[derive(Clone)]
struct Sequence {
    modes: Vec<usize>,
    log_joint: f64,
    x: DVector<f64>,
    p: DMatrix<f64>,
}

fn dynamic<const R: usize, const C: usize>(m: &nalgebra::SMatrix<f64, R, C>) -> DMatrix<f64> {
    DMatrix::from_column_slice(R, C, m.as_slice())
}

/// The states of each mode.
const SIZES: [usize; 3] = [2, 3, 1];

/// The switch in plain matrices: what the new mode lacks is dropped, an acceleration is drawn.
fn switched(s: &Sequence, to: usize, probability: f64) -> Sequence {
    let (size, from) = (SIZES[to], s.x.len());
    let map = DMatrix::identity(size, from);
    let mut p = &map * &s.p * map.transpose();
    if size > from {
        p[(2, 2)] += ENTRY * ENTRY;
    }
    let mut modes = s.modes.clone();
    modes.push(to);
    Sequence { modes, log_joint: s.log_joint + probability.ln(), x: map * &s.x, p }
}

fn predicted(s: Sequence) -> Sequence {
    let (f, q) = match s.x.len() {
        1 => (DMatrix::identity(1, 1), dynamic(&cruise_noise()).view((0, 0), (1, 1)).into_owned()),
        2 => (dynamic(&cruise_flow()), dynamic(&cruise_noise())),
        _ => (dynamic(&driven_flow()), dynamic(&driven_noise())),
    };
    Sequence { x: &f * &s.x, p: &f * &s.p * f.transpose() + q, ..s }
}

/// All outputs at once, with an inverse and a determinant.
fn corrected(s: Sequence, y: &[Option<f64>; 2]) -> Sequence {
    let rows: Vec<usize> = (0..2).filter(|c| y[*c].is_some()).collect();
    if rows.is_empty() {
        return s;
    }
    let h =
        DMatrix::from_fn(rows.len(), s.x.len(), |i, j| if j < 2 { OUTPUTS[2 * rows[i] + j] } else { 0.0 });
    let r = DMatrix::from_diagonal(&DVector::from_iterator(rows.len(), rows.iter().map(|&c| VARIANCES[c])));
    let measured = DVector::from_iterator(rows.len(), rows.iter().map(|&c| y[c].unwrap()));
    let variance = &h * &s.p * h.transpose() + r;
    let inverse = variance.clone().try_inverse().unwrap();
    let innovation = measured - &h * &s.x;
    let log_density =
        -0.5 * (innovation.dot(&(&inverse * &innovation)) + (variance * TAU).determinant().ln());
    let gain = &s.p * h.transpose() * inverse;
    let p = &s.p - &gain * &h * &s.p;
    Sequence { x: &s.x + gain * innovation, p, log_joint: s.log_joint + log_density, ..s }
}

/// All sequences after each sample.
fn enumerate<const K: usize>(
    table: [[f64; K]; K],
    start: &[ModeState],
    readings: &[[Option<f64>; 2]],
) -> Vec<Vec<Sequence>> {
    let mut now: Vec<Sequence> = start
        .iter()
        .cloned()
        .enumerate()
        .map(|(mode, s)| Sequence {
            modes: vec![mode],
            log_joint: s.probability.ln(),
            x: s.state.mean,
            p: s.state.covariance,
        })
        .map(|s| corrected(s, &readings[0]))
        .collect();
    let mut all = vec![now.clone()];
    for y in &readings[1..] {
        now = now
            .iter()
            .flat_map(|s| {
                let from = *s.modes.last().unwrap();
                (0..K)
                    .filter(move |to| table[from][*to] > 0.0)
                    .map(move |to| switched(s, to, table[from][to]))
            })
            .map(|s| corrected(predicted(s), y))
            .collect();
        all.push(now.clone());
    }
    all
}

fn evidence(sequences: &[Sequence]) -> f64 {
    sequences.iter().map(|s| s.log_joint.exp()).sum::<f64>().ln()
}

/// Probability that sequences have that mode at that sample.
fn probability(sequences: &[Sequence], sample: usize, mode: usize) -> f64 {
    let total = evidence(sequences);
    sequences.iter().filter(|s| s.modes[sample] == mode).map(|s| (s.log_joint - total).exp()).sum()
}

/// Where no switch leads back, mode and switch time are the whole sequence, and nothing is merged: filtered and smoothed modes,
/// evidence and the moments of the common states are exact.
fn assert_exact(
    modes: Modes<()>,
    start: &[ModeState],
    exact: &[Vec<Sequence>],
    common: &[usize],
) -> Bank<()> {
    let options = BankOptions { memory: Memory::Hypotheses(23), drop: 0.0, skip: 0.0, lag: 10 };
    let count = modes.count();
    let mut bank = Bank::new(modes, start, options).unwrap();
    for (k, (y, sequences)) in readings(exact.len()).iter().zip(exact).enumerate() {
        bank.push(&(), y).unwrap();
        assert_eq!(bank.hypotheses().count(), sequences.len());
        assert!((bank.log_evidence() - evidence(sequences)).abs() < 1e-10, "evidence at {k}");
        for mode in 0..count {
            for back in 0..=k {
                let expected = probability(sequences, k - back, mode);
                let found = bank.smoothed(back, mode).unwrap();
                assert!((found - expected).abs() < 1e-10, "{k} back {back}: {found} {expected}");
            }
            assert!((bank.probability(mode) - probability(sequences, k, mode)).abs() < 1e-10);
        }
        let weight = |s: &Sequence| (s.log_joint - evidence(sequences)).exp();
        let size = common.len();
        let mean: DVector<f64> = sequences.iter().map(|s| s.x.rows(0, size) * weight(s)).sum();
        let spread = |s: &Sequence| {
            let d = s.x.rows(0, size) - &mean;
            (s.p.view((0, 0), (size, size)) + &d * d.transpose()) * weight(s)
        };
        let covariance: DMatrix<f64> = sequences.iter().map(spread).sum();
        let found = bank.common(&vec![common; count]).unwrap();
        assert!((found.mean - mean).amax() < 1e-10, "mean at {k}");
        assert!((found.covariance - covariance).amax() < 1e-10, "covariance at {k}");
    }
    bank
}

#[test]
fn with_switches_one_way_a_bank_is_exact() {
    let exact = enumerate([[0.85, 0.15], [0.0, 1.0]], &start(), &readings(10));
    assert_eq!(exact[9].len(), 11);
    let bank = assert_exact(modes(0.0), &start(), &exact, &[0, 1]);
    // Without data it would be 0.84.
    assert!(bank.probability(1) > 0.97);
}

/// Two states, three and one.
#[test]
fn with_three_modes_of_unequal_size_a_bank_is_exact() {
    let (modes, start) = three_modes();
    let exact = enumerate(ENDS, &start, &readings(10));
    assert_eq!(exact[9].len(), 21);
    let bank = assert_exact(modes, &start, &exact, &[0]);
    // The target does not rest.
    assert!(bank.probability(2) < 0.01);
}

/// With switches both ways 1024 sequences go into 20 hypotheses; what is lost is what lies beyond the last switch.
#[test]
fn with_switches_both_ways_every_switch_time_is_nearly_exact() {
    let readings = readings(10);
    let exact = enumerate([[0.85, 0.15], [0.2, 0.8]], &start(), &readings);
    assert_eq!(exact[9].len(), 1024);
    let worst = |memory| {
        let mut bank =
            Bank::new(modes(0.2), &start(), BankOptions { memory, drop: 0.0, skip: 0.0, lag: 0 }).unwrap();
        let mut worst: f64 = 0.0;
        for (y, sequences) in readings.iter().zip(&exact) {
            bank.push(&(), y).unwrap();
            let last = sequences[0].modes.len() - 1;
            worst = worst.max((bank.probability(1) - probability(sequences, last, 1)).abs());
        }
        (worst, (bank.log_evidence() - evidence(&exact[9])).abs())
    };
    let merged = worst(Memory::MergedBeforeUpdate);
    let all = worst(Memory::Hypotheses(20));
    assert!(all.0 < 0.02 && all.1 < 0.02, "{all:?}");
    assert!(all.0 < 0.5 * merged.0, "{all:?} {merged:?}");
}
