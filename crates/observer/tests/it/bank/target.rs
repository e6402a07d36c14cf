//! A target that cruises (position, velocity) or is driven (position, velocity, acceleration), its position and a mixture of
//! position and velocity measured: two modes of unequal size that share a part of their states.

use crate::generic::wobble;
use nalgebra::{SMatrix, SVector};
use observer::bank::*;
use observer::*;

pub(super) const DT: f64 = 0.1;
/// Deviation of the acceleration with which the target begins to be driven.
pub(super) const ENTRY: f64 = 3.0;
pub(super) const VARIANCES: [f64; 2] = [0.04, 0.25];
/// The outputs by position and velocity.
pub(super) const OUTPUTS: [f64; 4] = [1.0, 0.0, 0.3, 1.0];

pub(super) struct Cruise;
pub(super) struct Driven;
/// The target rests: a position, whose noise is that of cruising; both outputs see it.
pub(super) struct Resting;

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

impl Model<1, 2> for Resting {
    type Input = ();
    fn flow(&self, x: &SVector<f64, 1>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 1>) {
        (*x, SMatrix::identity())
    }
    fn output(&self, x: &SVector<f64, 1>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 1>) {
        let h = SMatrix::<f64, 2, 1>::new(OUTPUTS[0], OUTPUTS[2]);
        (h * x, h)
    }
    fn process_noise(&self, _: &SVector<f64, 1>, (): &()) -> Option<SMatrix<f64, 1, 1>> {
        Some(cruise_noise().fixed_view::<1, 1>(0, 0).into_owned())
    }
    fn scales(&self) -> SVector<f64, 1> {
        SVector::from_element(1.0)
    }
    fn names(&self) -> [&'static str; 1] {
        ["position"]
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

/// The velocity is gone.
fn rests() -> Box<dyn Jump<()>> {
    jump(|x: &SVector<f64, 2>, (): &()| Landing {
        state: SVector::<f64, 1>::new(x[0]),
        map: SMatrix::<f64, 1, 2>::new(1.0, 0.0),
        noise: SMatrix::zeros(),
    })
}

/// Three modes; from cruise, mode 0, the target is driven or rests for ever.
pub(super) fn three_modes() -> (Modes<()>, Vec<ModeState>) {
    let members = vec![member(Cruise), member(Driven), member(Resting)];
    let modes = Modes::new(members, &[&ENDS[0], &ENDS[1], &ENDS[2]]).unwrap();
    let modes = modes.with_jump(0, 1, drives()).unwrap().with_jump(0, 2, rests()).unwrap();
    let [mut cruise, driven] = start();
    cruise.probability = 0.5;
    let state = Gaussian::new(&SVector::<f64, 1>::new(0.15), &SMatrix::<f64, 1, 1>::new(0.2));
    (modes, vec![cruise, driven, ModeState { probability: 0.2, state }])
}

/// The switches of [`three_modes`].
pub(super) const ENDS: [[f64; 3]; 3] = [[0.75, 0.15, 0.1], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

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
