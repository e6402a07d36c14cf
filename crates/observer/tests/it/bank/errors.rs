//! What a bank refuses, and that it stays as it was.

use super::target::*;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use observer::bank::*;
use observer::*;
use proptest::prelude::*;

fn members() -> Vec<Box<dyn Member<()>>> {
    vec![member(Cruise), member(Driven)]
}

/// A position alone: one output.
struct Still;

impl Model<1, 1> for Still {
    type Input = ();
    fn flow(&self, x: &SVector<f64, 1>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 1>) {
        (*x, SMatrix::identity())
    }
    fn output(&self, x: &SVector<f64, 1>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 1>) {
        (*x, SMatrix::identity())
    }
    fn scales(&self) -> SVector<f64, 1> {
        SVector::from_element(1.0)
    }
    fn names(&self) -> [&'static str; 1] {
        ["position"]
    }
}

fn still() -> Box<dyn Member<()>> {
    Box::new(KalmanMember::new(Still, SVector::<f64, 1>::new(1.0)).unwrap())
}

#[test]
fn unusable_modes_are_named() {
    let new = |members, switches: &[&[f64]]| Modes::<()>::new(members, switches).err();
    assert_eq!(new(Vec::new(), &[]), Some(BankError::NoMember));
    assert_eq!(
        new(vec![member(Cruise), still()], &[&[1.0, 0.0], &[0.0, 1.0]]),
        Some(BankError::Outputs { mode: 1, found: 1, needed: 2 })
    );
    assert!(matches!(new(members(), &[&[1.0, 0.0]]), Some(BankError::Size { found: 1, needed: 2, .. })));
    assert!(matches!(
        new(members(), &[&[1.0, 0.0], &[1.0]]),
        Some(BankError::Size { mode: 1, found: 1, needed: 2, .. })
    ));
    assert!(matches!(
        new(members(), &[&[1.0, 0.0], &[0.5, 0.5 - 2e-9]]),
        Some(BankError::RowSum { mode: 1, .. })
    ));
    assert_eq!(new(members(), &[&[1.0, 0.0], &[0.5, 0.5 - 0.5e-9]]), None);
    for bad in [-0.1, f64::NAN] {
        assert!(matches!(new(members(), &[&[1.0 - bad, bad], &[0.0, 1.0]]), Some(BankError::Value { .. })));
    }
    assert!(matches!(
        KalmanMember::new(Still, SVector::<f64, 1>::new(0.0)).map(|_| ()),
        Err(BankError::Value { value: 0.0, .. })
    ));
}

#[test]
fn unusable_jumps_are_named() {
    let unmapped = || Modes::new(members(), &[&[0.9, 0.1], &[0.0, 1.0]]).unwrap();
    let error = |from, to, jump| unmapped().with_jump(from, to, jump).err();
    assert_eq!(
        error(1, 0, drives()),
        Some(BankError::Jump { from: 1, to: 0, found: (2, 3), needed: (3, 2) })
    );
    assert_eq!(error(0, 2, drives()), Some(BankError::NoMode { mode: 2, last: 1 }));
    let same = jump(|x: &SVector<f64, 2>, (): &()| Landing {
        state: *x,
        map: SMatrix::<f64, 2, 2>::identity(),
        noise: SMatrix::zeros(),
    });
    assert_eq!(error(0, 0, same), Some(BankError::Stays { mode: 0 }));
    // The switch back has no map either, but cannot happen.
    let missing = BankError::NoJump { from: 0, to: 1, from_states: 2, to_states: 3 };
    assert_eq!(Bank::new(unmapped(), &start(), BankOptions::default()).err(), Some(missing));
    let mapped = unmapped().with_jump(0, 1, drives()).unwrap();
    assert!(Bank::new(mapped, &start(), BankOptions::default()).is_ok());
}

#[test]
fn unusable_starts_and_options_are_named() {
    let with = |change: &dyn Fn(&mut [ModeState; 2], &mut BankOptions)| {
        let (mut start, mut options) = (start(), BankOptions::default());
        change(&mut start, &mut options);
        Bank::new(modes(0.2), &start, options).err()
    };
    assert!(matches!(
        with(&|s, _| s[0].probability = 0.7 + 2e-9),
        Some(BankError::Sum { what: "start probabilities", .. })
    ));
    assert!(matches!(with(&|s, _| s[0].probability = f64::NAN), Some(BankError::Value { .. })));
    assert_eq!(
        with(&|s, _| s[1].state.covariance[(2, 2)] = -1e-3),
        Some(BankError::Covariance { mode: 1, sample: 0 })
    );
    assert_eq!(
        with(&|s, _| s[1].state.covariance[(0, 2)] += 1e-3),
        Some(BankError::Covariance { mode: 1, sample: 0 })
    );
    // Semidefinite is not definite.
    assert_eq!(
        with(&|s, _| s[0].state.covariance = DMatrix::from_element(2, 2, 1.0)),
        Some(BankError::Covariance { mode: 0, sample: 0 })
    );
    assert!(matches!(
        with(&|s, _| s[1].state.mean[0] = f64::NAN),
        Some(BankError::NotFinite { mode: 1, .. })
    ));
    assert!(matches!(
        with(&|s, _| s[0].state.mean = DVector::zeros(3)),
        Some(BankError::Size { mode: 0, found: 3, needed: 2, .. })
    ));
    assert_eq!(
        with(&|_, o| o.memory = Memory::Hypotheses(1)),
        Some(BankError::Hypotheses { found: 1, needed: 2 })
    );
    for share in [1.0, -1e-3, f64::NAN] {
        assert!(matches!(with(&|_, o| o.drop = share), Some(BankError::Value { .. })));
        assert!(matches!(with(&|_, o| o.skip = share), Some(BankError::Value { .. })));
    }
    for (hypotheses, lag) in [(usize::MAX, 0), (8, usize::MAX), (1 << 20, 1 << 10)] {
        let change = |o: &mut BankOptions| (o.memory, o.lag) = (Memory::Hypotheses(hypotheses), lag);
        assert!(matches!(with(&|_, o| change(o)), Some(BankError::Value { .. })), "{hypotheses} {lag}");
    }
    let short = Bank::new(modes(0.2), &start()[..1], BankOptions::default()).err();
    assert!(matches!(short, Some(BankError::Size { found: 1, needed: 2, .. })));
    let bank = Bank::new(modes(0.2), &start(), BankOptions::default()).unwrap();
    assert!(matches!(bank.common(&[&[0]]), Err(BankError::Size { .. })));
    assert!(matches!(bank.common(&[&[0], &[0, 1]]), Err(BankError::Size { mode: 1, .. })));
    assert!(matches!(bank.common(&[&[2], &[2]]), Err(BankError::Size { mode: 0, found: 2, needed: 3, .. })));
    assert!(matches!(bank.common(&[&[usize::MAX], &[2]]), Err(BankError::Size { mode: 0, .. })));
    assert!(bank.probability(2) == 0.0 && bank.smoothed(0, 0).is_none());
}

/// An extra reading, NaN and infinity, and one so far off that every density underflows to zero; and then the bank goes on as
/// one that was never asked.
#[test]
fn a_sample_that_is_refused_leaves_the_bank_as_it_was() {
    let options = BankOptions { lag: 5, drop: 1e-4, ..BankOptions::default() };
    let mut asked = Bank::new(modes(0.2), &start(), options).unwrap();
    let mut unasked = Bank::new(modes(0.2), &start(), options).unwrap();
    for (k, y) in readings(12).iter().enumerate() {
        let found = asked.push(&(), &[Some(1.0)]);
        assert_eq!(found, Err(BankError::Readings { sample: k, found: 1, needed: 2 }));
        for bad in [f64::NAN, f64::INFINITY] {
            let found = asked.push(&(), &[None, Some(bad)]);
            assert_eq!(found, Err(BankError::NotFinite { what: "reading", mode: 1, sample: k }));
        }
        assert_eq!(asked.push(&(), &[Some(1e300), None]), Err(BankError::NoLikelihood { sample: k }));
        assert_eq!(asked.push(&(), y), unasked.push(&(), y));
    }
    assert!(asked.hypotheses().eq(unasked.hypotheses()));
    assert_eq!((asked.samples(), asked.lost()), (12, unasked.lost()));
}

/// A jump whose noise is negative makes a covariance that is none.
#[test]
fn a_covariance_that_is_lost_on_the_way_is_named() {
    let bad = jump(|x: &SVector<f64, 2>, (): &()| Landing {
        state: SVector::<f64, 3>::new(x[0], x[1], 0.0),
        map: SMatrix::<f64, 3, 2>::new(1.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        noise: SMatrix::from_diagonal(&SVector::<f64, 3>::new(0.0, 0.0, -9.0)),
    });
    let modes = Modes::new(members(), &[&[0.9, 0.1], &[0.0, 1.0]]).unwrap().with_jump(0, 1, bad).unwrap();
    let mut bank = Bank::new(modes, &start(), BankOptions::default()).unwrap();
    bank.push(&(), &[None, None]).unwrap();
    assert_eq!(bank.push(&(), &[None, None]), Err(BankError::Covariance { mode: 1, sample: 1 }));
}

/// A tie at densities in which every weight drowns, and then a mode that alone explains the next sample: found by the test below.
#[test]
fn odds_are_probabilities_beyond_any_outlier() {
    let mut bank = Bank::new(modes(0.2), &start(), BankOptions::default()).unwrap();
    for y in [[Some(-3e40), Some(0.0)], [None, Some(0.0)], [Some(0.0), None], [None, Some(2e193)]] {
        bank.push(&(), &y).unwrap_or_default();
        assert!((bank.probability(0) + bank.probability(1) - 1.0).abs() < 1e-12);
    }
    let mut bank = Bank::new(modes(0.2), &start(), BankOptions::default()).unwrap();
    bank.push(&(), &[Some(-1.85e79), None]).unwrap();
    // Both predict the position with the same variance: what was measured says nothing about the mode.
    assert!((bank.probability(0) - 0.7).abs() < 1e-12, "{}", bank.probability(0));
}

proptest! {
    /// Whatever is read, there is an answer: probabilities that sum to one, or an error after which they still do.
    #[test]
    fn no_reading_makes_probabilities_that_are_none(
        readings in proptest::collection::vec(proptest::option::of(any::<f64>()), 24),
    ) {
        let mut bank = Bank::new(modes(0.2), &start(), BankOptions { lag: 3, ..BankOptions::default() }).unwrap();
        for pair in readings.chunks(2) {
            let _ = bank.push(&(), pair);
            let sum = bank.probability(0) + bank.probability(1);
            prop_assert!((sum - 1.0).abs() < 1e-12, "{sum}");
            prop_assert!(bank.hypotheses().all(|h| h.state().mean.iter().all(|x| x.is_finite())));
        }
    }
}
