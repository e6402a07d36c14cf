//! Switches whose probabilities depend on the state.

use super::target::*;
use observer::bank::*;

fn bank(modes: Modes<()>, memory: Memory) -> Bank<()> {
    Bank::new(modes, &start(), BankOptions { memory, lag: 5, ..BankOptions::default() }).unwrap()
}

/// Rates that are constant are the table.
#[test]
fn constant_rates_are_the_table() {
    let rates =
        |cruise: f64| move |_: &Gaussian, (): &(), row: &mut [f64]| (row[0], row[1]) = (cruise, 1.0 - cruise);
    for memory in [Memory::MergedBeforeUpdate, Memory::Hypotheses(5)] {
        let with = modes(0.5).with_rates(0, rates(0.85)).unwrap().with_rates(1, rates(0.2)).unwrap();
        let (mut with, mut table) = (bank(with, memory), bank(modes(0.2), memory));
        let mut filtered = Vec::new();
        for y in readings(15) {
            let (a, b) = (with.push(&(), &y).unwrap(), table.push(&(), &y).unwrap());
            assert!((a - b).abs() < 1e-14 && (with.probability(1) - table.probability(1)).abs() < 1e-14);
            filtered.push(table.mode_states());
        }
        let inputs = [(); 15];
        let backward = |bank: &Bank<()>| smooth_backward(bank.modes(), &filtered, &inputs).unwrap();
        let off = backward(&with)[3][1].probability - backward(&table)[3][1].probability;
        assert!(off.abs() < 1e-11, "{off}");
    }
}

/// A mode that can only be left while an acceleration is near zero: the probability to leave it is the mean, over the state, of the
/// probability at each state, here by quadrature.
#[test]
fn a_rate_that_depends_on_the_state_is_a_mean_over_it() {
    const RATE: f64 = 0.6;
    const WIDTH: f64 = 0.8;
    let leave = |a: f64| RATE * (-0.5 * (a / WIDTH).powi(2)).exp();
    let rates = |state: &Gaussian, (): &(), row: &mut [f64]| {
        let variance = state.covariance[(2, 2)] + WIDTH * WIDTH;
        row[0] = RATE * WIDTH / variance.sqrt() * (-0.5 * state.mean[2].powi(2) / variance).exp();
        row[1] = 1.0 - row[0];
    };
    let mut bank = bank(modes(0.2).with_rates(1, rates).unwrap(), Memory::Hypotheses(4));
    bank.push(&(), &[None, None]).unwrap();
    bank.push(&(), &[None, None]).unwrap();
    let driven = &start()[1].state;
    let (mean, deviation) = (driven.mean[2], driven.covariance[(2, 2)].sqrt());
    let density = |z: f64| (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    let step = 1e-3;
    let left: f64 = (-9000..=9000)
        .map(|i| f64::from(i) * step)
        .map(|z| step * density(z) * leave(mean + deviation * z))
        .sum();
    let expected = 0.7 * 0.85 + 0.3 * left;
    assert!((bank.probability(0) - expected).abs() < 1e-12, "{} {expected}", bank.probability(0));
}

#[test]
fn unusable_rates_are_named_and_change_nothing() {
    let fill = |row: [f64; 2]| move |_: &Gaussian, (): &(), out: &mut [f64]| out.copy_from_slice(&row);
    let refused = |back: f64, row: [f64; 2]| {
        let mut bank = bank(modes(back).with_rates(1, fill(row)).unwrap(), Memory::Hypotheses(4));
        bank.push(&(), &[None, None]).unwrap();
        let before = (bank.probability(0), bank.samples());
        let error = bank.push(&(), &[None, None]).err();
        assert!(error.is_none() || before == (bank.probability(0), bank.samples()));
        error
    };
    assert!(matches!(refused(0.2, [0.5, 0.4]), Some(BankError::RowSum { mode: 1, .. })));
    assert!(matches!(refused(0.2, [f64::NAN, 0.4]), Some(BankError::Value { .. })));
    // The table has no way back, and no map for it might be there.
    assert!(matches!(refused(0.0, [0.5, 0.5]), Some(BankError::Value { value: 0.5, .. })));
    assert_eq!(refused(0.2, [0.5, 0.5]), None);
    let none = modes(0.2).with_rates(2, fill([1.0, 0.0])).err();
    assert_eq!(none, Some(BankError::NoMode { mode: 2, last: 1 }));
}
