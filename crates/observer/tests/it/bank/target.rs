//! A target that cruises (position, velocity) or is driven (position, velocity, acceleration), its position and a mixture of
//! position and velocity measured: two modes of unequal size that share a part of their states.

use crate::generic::wobble;
use nalgebra::{SMatrix, SVector};
use observer::*;

pub(super) const DT: f64 = 0.1;
/// Deviation of the acceleration with which the target begins to be driven.
pub(super) const ENTRY: f64 = 3.0;
pub(super) const VARIANCES: [f64; 2] = [0.04, 0.25];
/// The outputs by position and velocity.
pub(super) const OUTPUTS: [f64; 4] = [1.0, 0.0, 0.3, 1.0];

pub(super) struct Cruise;
pub(super) struct Driven;

pub(super) fn cruise_flow() -> SMatrix<f64, 2, 2> {
    SMatrix::<f64, 2, 2>::new(1.0, DT, 0.0, 1.0)
}

pub(super) fn cruise_noise() -> SMatrix<f64, 2, 2> {
    SMatrix::<f64, 2, 2>::new(1e-4, 2e-5, 2e-5, 1e-3)
}

pub(super) fn driven_flow() -> SMatrix<f64, 3, 3> {
    SMatrix::<f64, 3, 3>::new(1.0, DT, 0.5 * DT * DT, 0.0, 1.0, DT, 0.0, 0.0, 1.0)
}

pub(super) fn driven_noise() -> SMatrix<f64, 3, 3> {
    SMatrix::<f64, 3, 3>::new(2e-4, 0.0, 0.0, 0.0, 3e-3, 1e-3, 0.0, 1e-3, 0.02)
}

impl Model<2, 2> for Cruise {
    type Input = ();
    fn flow(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
        (cruise_flow() * x, cruise_flow())
    }
    fn output(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
        let h = SMatrix::<f64, 2, 2>::from_row_slice(&OUTPUTS);
        (h * x, h)
    }
    fn process_noise(&self, _: &SVector<f64, 2>, (): &()) -> Option<SMatrix<f64, 2, 2>> {
        Some(cruise_noise())
    }
    fn scales(&self) -> SVector<f64, 2> {
        SVector::from_element(1.0)
    }
    fn names(&self) -> [&'static str; 2] {
        ["position", "velocity"]
    }
}

impl Model<3, 2> for Driven {
    type Input = ();
    fn flow(&self, x: &SVector<f64, 3>, (): &()) -> (SVector<f64, 3>, SMatrix<f64, 3, 3>) {
        (driven_flow() * x, driven_flow())
    }
    fn output(&self, x: &SVector<f64, 3>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 3>) {
        let h = SMatrix::<f64, 2, 3>::new(OUTPUTS[0], OUTPUTS[1], 0.0, OUTPUTS[2], OUTPUTS[3], 0.0);
        (h * x, h)
    }
    fn process_noise(&self, _: &SVector<f64, 3>, (): &()) -> Option<SMatrix<f64, 3, 3>> {
        Some(driven_noise())
    }
    fn scales(&self) -> SVector<f64, 3> {
        SVector::from_element(1.0)
    }
    fn names(&self) -> [&'static str; 3] {
        ["position", "velocity", "acceleration"]
    }
}

pub(super) fn member<Mo, const N: usize>(model: Mo) -> Box<dyn Member<()>>
where
    Mo: Model<N, 2, Input = ()> + Send + 'static,
{
    Box::new(KalmanMember::new(model, SVector::from(VARIANCES)).unwrap())
}

/// An acceleration appears, with a stated spread; everything else is kept.
pub(super) fn drives() -> Box<dyn Jump<()>> {
    jump(|x: &SVector<f64, 2>, (): &()| Landing {
        state: SVector::<f64, 3>::new(x[0], x[1], 0.0),
        map: SMatrix::<f64, 3, 2>::new(1.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        noise: SMatrix::from_diagonal(&SVector::<f64, 3>::new(0.0, 0.0, ENTRY * ENTRY)),
    })
}

/// The acceleration is gone.
pub(super) fn cruises() -> Box<dyn Jump<()>> {
    jump(|x: &SVector<f64, 3>, (): &()| Landing {
        state: SVector::<f64, 2>::new(x[0], x[1]),
        map: SMatrix::<f64, 2, 3>::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0),
        noise: SMatrix::zeros(),
    })
}

/// Cruise is mode 0; `back` is the probability to return to it.
pub(super) fn modes(back: f64) -> Modes<()> {
    let members = vec![member(Cruise), member(Driven)];
    let modes = Modes::new(members, &[&[0.85, 0.15], &[back, 1.0 - back]]).unwrap();
    modes.with_jump(0, 1, drives()).unwrap().with_jump(1, 0, cruises()).unwrap()
}

pub(super) fn start() -> [ModeState; 2] {
    let cruise =
        Gaussian::new(&SVector::<f64, 2>::new(0.1, 0.9), &SMatrix::<f64, 2, 2>::new(0.3, 0.05, 0.05, 0.5));
    let driven = Gaussian::new(
        &SVector::<f64, 3>::new(0.1, 0.8, 0.2),
        &SMatrix::<f64, 3, 3>::new(0.3, 0.0, 0.1, 0.0, 0.6, 0.0, 0.1, 0.0, 4.0),
    );
    [ModeState { probability: 0.7, state: cruise }, ModeState { probability: 0.3, state: driven }]
}

/// The target cruises, is driven from the fourth sample on, and here and there an output is missing.
pub(super) fn readings(count: usize) -> Vec<[Option<f64>; 2]> {
    (0..count)
        .map(|k| {
            let t = k as f64 * DT;
            let driven = (t - 3.5 * DT).max(0.0);
            let (position, velocity) = (0.2 + t + 2.0 * driven * driven, 1.0 + 4.0 * driven);
            let first = position + 0.2 * wobble(k, 4.0);
            let second = 0.3 * position + velocity + 0.5 * wobble(k, 5.0);
            [(k % 6 != 4).then_some(first), (k % 4 != 2 && k % 6 != 4).then_some(second)]
        })
        .collect()
}
