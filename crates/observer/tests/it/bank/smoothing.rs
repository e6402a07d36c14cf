//! Modes and states after the fact.

use super::target::*;
use nalgebra::SVector;
use observer::bank::*;
use observer::batch::*;
use observer::*;

/// With one mode the pass backward is the smoother of Rauch, Tung and Striebel, which a batch solution is too.
#[test]
fn one_mode_backward_is_the_batch_solution() {
    let readings = readings(15);
    let samples: Vec<Sample<(), 2>> = readings
        .iter()
        .map(|y| Sample {
            input: (),
            measured: SVector::<f64, 2>::from_fn(|c, _| y[c].unwrap_or(0.0)),
            information: SVector::<f64, 2>::from_fn(|c, _| y[c].map_or(0.0, |_| 1.0 / VARIANCES[c])),
        })
        .collect();
    let first = &start()[1].state;
    let (state, covariance) = first.read::<3>();
    let prior = Start { state, information: covariance.try_inverse().unwrap() };
    let batch = solve_batch(&Driven, &samples, &prior, &BatchOptions::default()).unwrap();
    let modes = Modes::new(vec![member(Driven)], &[&[1.0]]).unwrap();
    let alone = ModeState { probability: 1.0, state: first.clone() };
    let mut bank = Bank::new(modes, &[alone], BankOptions::default()).unwrap();
    let filtered: Vec<_> = readings
        .iter()
        .map(|y| {
            bank.push(&(), y).unwrap();
            bank.mode_states()
        })
        .collect();
    let smoothed = smooth_backward(bank.modes(), &filtered, &[(); 15]).unwrap();
    for (k, states) in smoothed.iter().enumerate() {
        let (mean, covariance) = states[0].state.read::<3>();
        assert!((mean - batch.states[k]).amax() < 1e-9, "{k}");
        assert!((covariance - batch.covariances[k]).amax() < 1e-9, "{k}");
        assert!((states[0].probability - 1.0).abs() < 1e-12);
    }
    // It is no idle pass.
    assert!((&smoothed[3][0].state.mean - &filtered[3][0].state.mean).amax() > 0.01);
}

/// Where no switch leads back the pass backward has the exact answer to compare with: paths of hypotheses that were never merged.
/// Its probabilities are near, not equal: a mode is not one Gaussian.
#[test]
fn the_pass_backward_is_near_the_paths_but_not_equal() {
    let readings = readings(12);
    let run = |memory, lag| {
        let mut bank =
            Bank::new(modes(0.0), &start(), BankOptions { memory, drop: 0.0, skip: 0.0, lag }).unwrap();
        let each = |y: &[Option<f64>; 2]| {
            bank.push(&(), y).unwrap();
            bank.mode_states()
        };
        let filtered: Vec<_> = readings.iter().map(each).collect();
        (bank, filtered)
    };
    let (bank, filtered) = run(Memory::MergedBeforeUpdate, 0);
    let backward = smooth_backward(bank.modes(), &filtered, &[(); 12]).unwrap();
    let (exact, _) = run(Memory::Hypotheses(13), 12);
    let off: Vec<f64> =
        (0..12).map(|k| (backward[k][1].probability - exact.smoothed(11 - k, 1).unwrap()).abs()).collect();
    let largest = off.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1e-6 && largest < 0.1, "{off:?}");
    for states in &backward {
        assert!((states[0].probability + states[1].probability - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_does_not_fit_is_named() {
    let modes = modes(0.2);
    let filtered = vec![start().to_vec(); 3];
    let error = |filtered: &[Vec<ModeState>], inputs: &[()]| smooth_backward(&modes, filtered, inputs).err();
    assert!(matches!(error(&filtered, &[(); 2]), Some(BankError::Size { found: 2, needed: 3, .. })));
    let mut short = filtered.clone();
    short[1].pop();
    assert!(matches!(error(&short, &[(); 3]), Some(BankError::Size { found: 1, needed: 2, .. })));
    let mut swapped = filtered.clone();
    swapped[2].swap(0, 1);
    assert!(matches!(error(&swapped, &[(); 3]), Some(BankError::Size { mode: 0, found: 3, needed: 2, .. })));
    let mut singular = filtered.clone();
    singular[2][0].state.covariance.fill(0.0);
    assert_eq!(error(&singular, &[(); 3]), Some(BankError::Covariance { mode: 0, sample: 2 }));
    let mut nan = filtered.clone();
    nan[0][1].state.mean[0] = f64::NAN;
    assert!(matches!(error(&nan, &[(); 3]), Some(BankError::NotFinite { mode: 1, sample: 0, .. })));
    let mut more = filtered.clone();
    more[1][0].probability = 0.8;
    assert!(matches!(error(&more, &[(); 3]), Some(BankError::Sum { .. })));
    assert_eq!(error(&[], &[]), None);
}
