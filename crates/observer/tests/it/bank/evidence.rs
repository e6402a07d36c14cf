//! What windows of samples say about modes: evidence, not cost.

use super::target::*;
use nalgebra::{SMatrix, SVector};
use observer::bank::*;
use observer::batch::*;
use observer::newton::*;
use observer::*;

fn samples(count: usize) -> Vec<Sample<(), 2>> {
    let one = |y: [Option<f64>; 2]| Sample {
        input: (),
        measured: SVector::<f64, 2>::from_fn(|c, _| y[c].unwrap_or(f64::NAN)),
        information: SVector::<f64, 2>::from_fn(|c, _| if y[c].is_some() { 1.0 / VARIANCES[c] } else { 0.0 }),
    };
    readings(count).into_iter().map(one).collect()
}

fn prior<const N: usize>(mode: usize) -> Start<N> {
    let (state, covariance) = start()[mode].state.read::<N>();
    Start { state, information: covariance.try_inverse().unwrap() }
}

/// Log-evidence of the first samples, from none on.
fn evidences<Mo: Model<N, 2, Input = ()>, const N: usize>(model: &Mo, mode: usize, count: usize) -> Vec<f64> {
    let (samples, prior) = (samples(count), prior::<N>(mode));
    (2..=count)
        .map(|k| {
            let solution = solve_batch(model, &samples[..k], &prior, &BatchOptions::default()).unwrap();
            solution.log_evidence(&samples[..k], &prior).unwrap()
        })
        .collect()
}

/// Log-densities of each sample by a bank of one mode.
fn innovations(member: Box<dyn Member<()>>, mode: usize, count: usize) -> Vec<f64> {
    let modes = Modes::new(vec![member], &[&[1.0]]).unwrap();
    let alone = ModeState { probability: 1.0, state: start()[mode].state.clone() };
    let mut bank = Bank::new(modes, &[alone], BankOptions::default()).unwrap();
    readings(count).iter().map(|y| bank.push(&(), y).unwrap()).collect()
}

/// Of a linear system what a sample adds to the evidence of a window is the density of its innovation.
#[test]
fn evidence_grows_by_the_density_of_the_innovation() {
    const COUNT: usize = 14;
    for (evidence, densities) in [
        (evidences(&Cruise, 0, COUNT), innovations(member(Cruise), 0, COUNT)),
        (evidences(&Driven, 1, COUNT), innovations(member(Driven), 1, COUNT)),
    ] {
        let first: f64 = densities[..2].iter().sum();
        assert!((evidence[0] - first).abs() < 1e-12, "{} {first}", evidence[0]);
        for (k, (pair, density)) in evidence.windows(2).zip(&densities[2..]).enumerate() {
            assert!((pair[1] - pair[0] - density).abs() < 1e-12, "{k}: {pair:?} {density}");
        }
    }
}

/// Log-densities of each sample by an observer on a moving window, which is full after five samples.
fn of_windows<Mo: Model<N, 2, Input = ()>, const N: usize>(model: Mo, mode: usize) -> Vec<Option<f64>> {
    let options = NewtonOptions { window: 5, steps: 1, damping: 0.0, arrival: Arrival::Carry(1.0) };
    let mut observer = NewtonObserver::new(model, options, prior::<N>(mode)).unwrap();
    assert_eq!(observer.log_density(), None);
    let one = |sample| {
        observer.push(sample);
        observer.log_density()
    };
    samples(14).into_iter().map(one).collect()
}

/// An observer on a window tells the density of its newest sample from what that sample left of itself.
#[test]
fn a_window_tells_the_density_of_its_newest_sample() {
    let cases = [
        (of_windows(Cruise, 0), innovations(member(Cruise), 0, 14)),
        (of_windows(Driven, 1), innovations(member(Driven), 1, 14)),
    ];
    for (found, expected) in cases {
        for (k, (found, expected)) in found.into_iter().zip(expected).enumerate() {
            assert!((found.unwrap() - expected).abs() < 1e-12, "{k}: {found:?} {expected}");
        }
    }
}

/// One sample of a state of which nothing else is known fits itself.
#[test]
fn a_sample_that_nothing_predicted_has_no_density() {
    let options = NewtonOptions { window: 5, steps: 1, damping: 0.0, arrival: Arrival::Forget };
    let guess = Start::guess(SVector::<f64, 2>::zeros());
    let mut observer = NewtonObserver::new(Cruise, options, guess).unwrap();
    let first = samples(1)[0];
    observer.push(first);
    assert_eq!(observer.log_density(), None);
    for sample in samples(8) {
        observer.push(sample);
    }
    assert!(observer.log_density().is_some());
}

/// Costs alone leave out how much narrower a sample makes the estimate; on these data by more than a tenth of a unit for at least
/// one sample.
#[test]
fn cost_is_no_evidence() {
    let (samples, prior) = (samples(14), prior::<3>(1));
    let cost = |k: usize| {
        let solution = solve_batch(&Driven, &samples[..k], &prior, &BatchOptions::default()).unwrap();
        -0.5 * (solution.chi_squared + solution.prior_cost)
    };
    let densities = innovations(member(Driven), 1, 14);
    let channels = |k: usize| {
        samples[k].information.iter().filter(|i| **i > 0.0).map(|i| (i / std::f64::consts::TAU).ln())
    };
    let off = (2..14).map(|k| (cost(k + 1) - cost(k) + 0.5 * channels(k).sum::<f64>() - densities[k]).abs());
    assert!(off.fold(0.0, f64::max) > 0.1);
}

#[test]
fn a_guess_has_no_evidence() {
    let samples = samples(6);
    let guess = Start::guess(SVector::<f64, 2>::zeros());
    let solution = solve_batch(&Cruise, &samples, &guess, &BatchOptions::default()).unwrap();
    assert_eq!(solution.log_evidence(&samples, &guess), None);
    let negative = Start { state: guess.state, information: -SMatrix::identity() };
    assert_eq!(solution.log_evidence(&samples, &negative), None);
}

/// Two windows that do not mix, weighed by their evidence, are a bank without switches.
#[test]
fn odds_of_windows_are_those_of_a_bank_without_switches() {
    const COUNT: usize = 14;
    let stay: [&[f64]; 2] = [&[1.0, 0.0], &[0.0, 1.0]];
    let mut bank = Bank::new(
        Modes::new(vec![member(Cruise), member(Driven)], &stay).unwrap(),
        &start(),
        BankOptions::default(),
    )
    .unwrap();
    let mut odds = Odds::new(&[0.7, 0.3], &stay).unwrap();
    let (cruise, driven) = (evidences(&Cruise, 0, COUNT), evidences(&Driven, 1, COUNT));
    let readings = readings(COUNT);
    bank.push(&(), &readings[0]).unwrap();
    let mut last = [0.0; 2];
    for (k, now) in cruise.into_iter().zip(driven).map(|(a, b)| [a, b]).enumerate() {
        bank.push(&(), &readings[k + 1]).unwrap();
        odds.push(&[now[0] - last[0], now[1] - last[1]]).unwrap();
        last = now;
        assert!((odds.probability(0) - bank.probability(0)).abs() < 1e-11, "{k}");
    }
    assert!(bank.probability(1) > 0.9, "{}", bank.probability(1));
}

/// The forward recursion of a hidden Markov chain, by hand.
#[test]
fn odds_follow_the_switches() {
    let mut odds = Odds::new(&[0.5, 0.5], &[&[0.9, 0.1], &[0.3, 0.7]]).unwrap();
    let total = odds.push(&[0.2_f64.ln(), 0.6_f64.ln()]).unwrap();
    assert!((total - 0.4_f64.ln()).abs() < 1e-15 && (odds.probability(0) - 0.25).abs() < 1e-15);
    // 0.25 * 0.9 + 0.75 * 0.3 = 0.45; nothing measured.
    assert!(odds.push(&[0.0, 0.0]).unwrap().abs() < 1e-15);
    assert!((odds.probability(0) - 0.45).abs() < 1e-15 && odds.probability(7) == 0.0);
    let before = odds.clone();
    assert_eq!(odds.push(&[f64::NEG_INFINITY; 2]), Err(BankError::NoLikelihood { sample: 2 }));
    assert!(matches!(odds.push(&[0.0, f64::NAN]), Err(BankError::NotFinite { mode: 1, sample: 2, .. })));
    assert!(matches!(odds.push(&[0.0]), Err(BankError::Size { found: 1, needed: 2, .. })));
    assert!(odds.push(&[0.0, f64::NEG_INFINITY]).is_ok() && before.probability(1) > 0.5);
    assert_eq!(odds.probability(1), 0.0);
    assert_eq!(Odds::new(&[], &[]), Err(BankError::NoMember));
    assert!(matches!(Odds::new(&[1.0], &[&[0.9]]), Err(BankError::RowSum { mode: 0, .. })));
}
