//! What a bank keeps, merges and gives up; and that it makes nothing on the way.

use super::target::*;
use observer::bank::*;

fn bank(back: f64, options: BankOptions) -> Bank<()> {
    Bank::new(modes(back), &start(), options).unwrap()
}

/// Merging keeps probability, mean and covariance of what the modes have in common: only what comes after differs.
#[test]
fn merging_keeps_the_moments() {
    let readings = readings(5);
    let rows: [&[usize]; 2] = [&[0, 1], &[0, 1]];
    let after = |memory| {
        let mut bank = bank(0.2, BankOptions { memory, ..BankOptions::default() });
        for y in &readings[..3] {
            bank.push(&(), y).unwrap();
        }
        bank
    };
    // Nothing was merged after the update with eight; with five some were at the third sample alone.
    let (all, merged) = (after(Memory::Hypotheses(8)), after(Memory::Hypotheses(5)));
    assert_eq!((all.hypotheses().count(), merged.hypotheses().count()), (6, 5));
    assert!((all.probability(1) - merged.probability(1)).abs() < 1e-14);
    let (a, b) = (all.common(&rows).unwrap(), merged.common(&rows).unwrap());
    assert!((a.mean - b.mean).amax() < 1e-13 && (a.covariance - b.covariance).amax() < 1e-13);
    let (a, b) = (all.mode_states(), merged.mode_states());
    for (a, b) in a.iter().zip(&b) {
        assert!((&a.state.mean - &b.state.mean).amax() < 1e-13);
        assert!((&a.state.covariance - &b.state.covariance).amax() < 1e-12);
    }
}

/// Two modes that are the same system: however they are mixed, the bank is its Kalman filter, and readings do not tell them
/// apart.
#[test]
fn modes_that_are_one_system_are_one_filter() {
    let twins = |count: usize| {
        let members = (0..count).map(|_| member(Cruise)).collect();
        let row: Vec<f64> = vec![1.0 / count as f64; count];
        let modes = Modes::new(members, &vec![&row[..]; count]).unwrap();
        let one = ModeState { probability: 1.0 / count as f64, state: start()[0].state.clone() };
        Bank::new(modes, &vec![one; count], BankOptions { lag: 4, ..BankOptions::default() }).unwrap()
    };
    let (mut alone, mut three) = (twins(1), twins(3));
    for y in readings(20) {
        let (a, b) = (alone.push(&(), &y).unwrap(), three.push(&(), &y).unwrap());
        assert!((a - b).abs() < 1e-11, "{a} {b}");
        let (a, b) = (alone.mode_states(), three.common(&[&[0, 1][..]; 3]).unwrap());
        assert!((&a[0].state.mean - b.mean).amax() < 1e-12);
        assert!((&a[0].state.covariance - b.covariance).amax() < 1e-12);
        assert!((0..3).all(|mode| (three.probability(mode) - 1.0 / 3.0).abs() < 1e-12));
    }
    assert!((three.smoothed(3, 2).unwrap() - 1.0 / 3.0).abs() < 1e-12);
}

/// Without readings the modes are a Markov chain: the odds follow its powers, and what was known is spread, not lost.
#[test]
fn samples_without_readings_leave_the_odds_to_the_switches() {
    let mut bank = bank(0.2, BankOptions::default());
    let mut cruise = 0.7;
    for k in 0..30 {
        assert_eq!(bank.push(&(), &[None, None]).unwrap(), 0.0);
        assert!((bank.probability(0) - cruise).abs() < 1e-12, "{k}");
        cruise = 0.85 * cruise + 0.2 * (1.0 - cruise);
    }
    assert_eq!(bank.log_evidence(), 0.0);
}

/// An outlier whose densities are far below the range of numbers: the odds are those of the logarithms, not a tie.
#[test]
fn an_outlier_keeps_the_odds() {
    let cases = [Memory::MergedBeforeUpdate, Memory::Hypotheses(8)];
    for memory in cases {
        let mut bank = bank(0.2, BankOptions { memory, ..BankOptions::default() });
        let log_density = bank.push(&(), &[None, Some(300.0)]).unwrap();
        assert!(log_density < -30_000.0, "{log_density}");
        // One output of each mode with its own variance: the wider one explains it better, by e^100 and more.
        let states = start();
        let log_odds = |mode: usize| {
            let s = &states[mode].state;
            let (h, p) = (&OUTPUTS[2..], s.covariance.view((0, 0), (2, 2)).into_owned());
            let variance = (0..2).map(|i| (0..2).map(|j| h[i] * p[(i, j)] * h[j]).sum::<f64>()).sum::<f64>()
                + VARIANCES[1];
            let residual = 300.0 - h[0] * s.mean[0] - h[1] * s.mean[1];
            states[mode].probability.ln() - 0.5 * (residual * residual / variance + variance.ln())
        };
        let expected = log_odds(0) - log_odds(1);
        assert!(expected.abs() > 100.0, "{expected}");
        let found: Vec<f64> = (0..2).map(|mode| bank.probability(mode)).collect();
        assert!(
            (found[0] - expected.exp()).abs() <= 1e-9 * expected.exp() && found[1] == 1.0,
            "{found:?} {expected}"
        );
    }
}

/// A mode that was given up comes back through the switches, with the prior of its entry.
#[test]
fn a_mode_that_was_given_up_comes_back() {
    let mut bank = bank(0.2, BankOptions { drop: 0.3, ..BankOptions::default() });
    let mut gone = false;
    for y in readings(25) {
        bank.push(&(), &y).unwrap();
        gone |= bank.probability(1) == 0.0;
    }
    assert!(gone && bank.probability(1) > 0.9, "{gone} {}", bank.probability(1));
    assert!(bank.lost() > 0.1 && bank.lost() <= 25.0 * 0.3, "{}", bank.lost());
}

/// The number of hypotheses never exceeds what is kept, each mode keeps at least one, and switch times lie in the past.
#[test]
fn no_more_hypotheses_than_are_kept() {
    for kept in [2, 3, 8] {
        let mut bank = bank(0.2, BankOptions { memory: Memory::Hypotheses(kept), ..BankOptions::default() });
        for (k, y) in readings(30).iter().enumerate() {
            bank.push(&(), y).unwrap();
            assert!(bank.hypotheses().count() == kept.min(2 * (k + 1)), "{kept} {k}");
            assert!((0..2).all(|mode| bank.hypotheses().any(|h| h.mode() == mode)));
            assert!(bank.hypotheses().all(|h| h.since() <= k));
            let sum: f64 = bank.hypotheses().map(Hypothesis::probability).sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn no_sample_allocates() {
    for memory in [Memory::MergedBeforeUpdate, Memory::Hypotheses(8)] {
        let mut bank = bank(0.2, BankOptions { memory, drop: 1e-6, skip: 1e-9, lag: 6 });
        let readings = readings(50);
        let mut merged = 0;
        let counted = allocation_counter::measure(|| {
            for y in &readings {
                merged += usize::from(bank.push(&(), y).is_ok());
                merged += usize::from(bank.smoothed(2, 1).is_some_and(|p| p > 2.0));
            }
        });
        assert_eq!((merged, counted.count_total), (50, 0), "{memory:?}");
    }
    // What counts is at work.
    assert!(allocation_counter::measure(|| drop(bank(0.2, BankOptions::default()))).count_total > 0);
}

/// A bank is used where samples arrive, which may be another thread than the one that made it.
#[test]
fn a_bank_may_change_threads() {
    let (mut here, mut there) = (bank(0.2, BankOptions::default()), bank(0.2, BankOptions::default()));
    let readings = readings(10);
    let odds = |bank: &mut Bank<()>| {
        readings.iter().map(|y| bank.push(&(), y).unwrap()).sum::<f64>() + bank.probability(1)
    };
    let elsewhere = std::thread::scope(|scope| scope.spawn(|| odds(&mut there)).join().unwrap());
    assert_eq!(odds(&mut here), elsewhere);
}
