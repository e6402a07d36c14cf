//! Units are a convention: odds do not depend on them.

use super::target::*;
use nalgebra::{SMatrix, SVector};
use observer::bank::*;
use observer::*;

/// Of position, velocity and acceleration, and of the outputs.
const STATES: [f64; 3] = [1e3, 1.0 / 3.6, 1e-2];
const OUTPUTS_IN: [f64; 2] = [39.37, 2.0e-3];

fn states<const N: usize>() -> SMatrix<f64, N, N> {
    SMatrix::from_diagonal(&SVector::from_fn(|i, _| STATES[i]))
}

fn back<const N: usize>() -> SMatrix<f64, N, N> {
    SMatrix::from_diagonal(&SVector::from_fn(|i, _| 1.0 / STATES[i]))
}

/// A model in other units.
struct Scaled<Mo>(Mo);

impl<Mo: Model<N, 2, Input = ()>, const N: usize> Model<N, 2> for Scaled<Mo> {
    type Input = ();
    fn flow(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        let (x, f) = self.0.flow(&(back() * x), &());
        (states() * x, states() * f * back())
    }
    fn output(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, N>) {
        let (y, h) = self.0.output(&(back() * x), &());
        let units = SMatrix::from_diagonal(&SVector::from(OUTPUTS_IN));
        (units * y, units * h * back())
    }
    fn process_noise(&self, x: &SVector<f64, N>, (): &()) -> Option<SMatrix<f64, N, N>> {
        self.0.process_noise(&(back() * x), &()).map(|q| states() * q * states())
    }
    fn scales(&self) -> SVector<f64, N> {
        states() * self.0.scales()
    }
    fn names(&self) -> [&'static str; N] {
        self.0.names()
    }
}

fn scaled_member<Mo, const N: usize>(model: Mo) -> Box<dyn Member<()>>
where
    Mo: Model<N, 2, Input = ()> + Send + 'static,
{
    let variances = SVector::<f64, 2>::from_fn(|c, _| VARIANCES[c] * OUTPUTS_IN[c].powi(2));
    Box::new(KalmanMember::new(Scaled(model), variances).unwrap())
}

fn scaled_modes() -> Modes<()> {
    let drives = jump(|x: &SVector<f64, 2>, (): &()| Landing {
        state: SVector::<f64, 3>::new(x[0], x[1], 0.0),
        map: SMatrix::<f64, 3, 2>::identity(),
        noise: SMatrix::from_diagonal(&SVector::<f64, 3>::new(0.0, 0.0, (ENTRY * STATES[2]).powi(2))),
    });
    let members = vec![scaled_member(Cruise), scaled_member(Driven)];
    let modes = Modes::new(members, &[&[0.85, 0.15], &[0.2, 0.8]]).unwrap();
    modes.with_jump(0, 1, drives).unwrap().with_jump(1, 0, cruises()).unwrap()
}

fn scaled_state<const N: usize>(state: &ModeState) -> ModeState {
    let (mean, covariance) = state.state.read::<N>();
    let state_in = Gaussian::new(&(states() * mean), &(states() * covariance * states()));
    ModeState { probability: state.probability, state: state_in }
}

#[test]
fn odds_do_not_depend_on_units() {
    for memory in [Memory::MergedBeforeUpdate, Memory::Hypotheses(6)] {
        let options = BankOptions { memory, lag: 20, ..BankOptions::default() };
        let [cruise, driven] = start();
        let scaled_start = [scaled_state::<2>(&cruise), scaled_state::<3>(&driven)];
        let mut plain = Bank::new(modes(0.2), &[cruise, driven], options).unwrap();
        let mut scaled = Bank::new(scaled_modes(), &scaled_start, options).unwrap();
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for y in readings(20) {
            let in_units: Vec<_> = y.iter().zip(OUTPUTS_IN).map(|(y, unit)| y.map(|y| y * unit)).collect();
            let densities = (plain.push(&(), &y).unwrap(), scaled.push(&(), &in_units).unwrap());
            let per_unit: f64 = y.iter().zip(OUTPUTS_IN).map(|(y, unit)| y.map_or(0.0, |_| unit.ln())).sum();
            assert!((densities.0 - densities.1 - per_unit).abs() < 1e-9);
            a.push(plain.mode_states());
            b.push(scaled.mode_states());
        }
        let inputs = [(); 20];
        let backward = [
            smooth_backward(plain.modes(), &a, &inputs).unwrap(),
            smooth_backward(scaled.modes(), &b, &inputs).unwrap(),
        ];
        for k in 0..20 {
            assert!((a[k][1].probability - b[k][1].probability).abs() < 1e-10, "filtered {k}");
            let paths = (plain.smoothed(19 - k, 1).unwrap(), scaled.smoothed(19 - k, 1).unwrap());
            assert!((paths.0 - paths.1).abs() < 1e-10, "paths {k}");
            let off = backward[0][k][1].probability - backward[1][k][1].probability;
            assert!(off.abs() < 1e-8, "backward {k}: {off}");
        }
    }
}
