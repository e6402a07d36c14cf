//! A body on a belt that moves to and fro: it sticks or slides, and only its position is measured.
//!
//! Sticking has two states, position and friction coefficient: the velocity is the belt's. Sliding has three.

use crate::Random;
use nalgebra::{SMatrix, SVector};
use recon::observer::Model;
use recon::observer::bank::{Gaussian, KalmanMember, Landing, ModeState, Modes, jump};

/// Sampling interval, gravity (natural units).
const DT: f64 = 0.01;
const GRAVITY: f64 = 1.0;
/// Noise of the position, of the position's and the velocity's step.
const NOISE: f64 = 4e-3;
const STEP_POSITION: f64 = 2e-4;
const STEP_VELOCITY: f64 = 2e-3;
/// Deviation of the velocity from the belt's at the start of sliding.
const ENTRY: f64 = 0.15;
/// Probability of a switch at a sample.
const SWITCH: f64 = 0.02;
/// Friction coefficient and its deviation, known beforehand.
const FRICTION: (f64, f64) = (0.3, 0.1);
/// Variance of the position at the start.
const START: f64 = 1e-8;

/// Velocity of the belt at a sample.
#[must_use]
pub fn belt_velocity(sample: usize) -> f64 {
    0.3 * (std::f64::consts::TAU * sample as f64 * DT / 1.3).sin() + 0.2
}

/// Mode 0 of the belt: position and friction coefficient.
pub struct Stick;

/// Mode 1 of the belt: position, velocity and friction coefficient.
pub struct Slide;

impl Model<2, 1> for Stick {
    type Input = f64;
    fn flow(&self, x: &SVector<f64, 2>, belt: &f64) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
        (SVector::<f64, 2>::new(x[0] + belt * DT, x[1]), SMatrix::identity())
    }
    fn output(&self, x: &SVector<f64, 2>, _: &f64) -> (SVector<f64, 1>, SMatrix<f64, 1, 2>) {
        (SVector::<f64, 1>::new(x[0]), SMatrix::<f64, 1, 2>::new(1.0, 0.0))
    }
    fn process_noise(&self, _: &SVector<f64, 2>, _: &f64) -> Option<SMatrix<f64, 2, 2>> {
        Some(SMatrix::from_diagonal(&SVector::<f64, 2>::new(STEP_POSITION * STEP_POSITION, 0.0)))
    }
    fn scales(&self) -> SVector<f64, 2> {
        SVector::<f64, 2>::new(0.1, 0.3)
    }
    fn names(&self) -> [&'static str; 2] {
        ["position", "friction coefficient"]
    }
}

impl Model<3, 1> for Slide {
    type Input = f64;
    fn flow(&self, x: &SVector<f64, 3>, _: &f64) -> (SVector<f64, 3>, SMatrix<f64, 3, 3>) {
        let transition = SMatrix::<f64, 3, 3>::new(1.0, DT, 0.0, 0.0, 1.0, -GRAVITY * DT, 0.0, 0.0, 1.0);
        (transition * x, transition)
    }
    fn output(&self, x: &SVector<f64, 3>, _: &f64) -> (SVector<f64, 1>, SMatrix<f64, 1, 3>) {
        (SVector::<f64, 1>::new(x[0]), SMatrix::<f64, 1, 3>::new(1.0, 0.0, 0.0))
    }
    fn process_noise(&self, _: &SVector<f64, 3>, _: &f64) -> Option<SMatrix<f64, 3, 3>> {
        let variances =
            SVector::<f64, 3>::new(STEP_POSITION * STEP_POSITION, STEP_VELOCITY * STEP_VELOCITY, 0.0);
        Some(SMatrix::from_diagonal(&variances))
    }
    fn scales(&self) -> SVector<f64, 3> {
        SVector::<f64, 3>::new(0.1, 0.3, 0.3)
    }
    fn names(&self) -> [&'static str; 3] {
        ["position", "velocity", "friction coefficient"]
    }
}

/// What fills the velocity of a body that begins to slide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Mean, as a share of the belt's velocity.
    pub share: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Entry {
    /// As the motions are drawn.
    pub const TRUE: Self = Self { share: 1.0, deviation: ENTRY };
    /// What padding the smaller state with zeros comes to.
    pub const ZEROS: Self = Self { share: 0.0, deviation: 0.0 };
}

/// The two modes; the velocity at the start of sliding is filled as said.
///
/// # Panics
/// Never: the constants are usable.
#[must_use]
pub fn modes(entry: Entry) -> Modes<f64> {
    let variance = SVector::<f64, 1>::new(NOISE * NOISE);
    let members = vec![
        Box::new(KalmanMember::new(Stick, variance).unwrap()) as _,
        Box::new(KalmanMember::new(Slide, variance).unwrap()) as _,
    ];
    let switches: [&[f64]; 2] = [&[1.0 - SWITCH, SWITCH], &[SWITCH, 1.0 - SWITCH]];
    let slides = jump(move |x: &SVector<f64, 2>, belt: &f64| Landing {
        state: SVector::<f64, 3>::new(x[0], entry.share * belt, x[1]),
        map: SMatrix::<f64, 3, 2>::new(1.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        noise: SMatrix::from_diagonal(&SVector::<f64, 3>::new(0.0, entry.deviation.powi(2), 0.0)),
    });
    let sticks = jump(|x: &SVector<f64, 3>, _: &f64| Landing {
        state: SVector::<f64, 2>::new(x[0], x[2]),
        map: SMatrix::<f64, 2, 3>::new(1.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        noise: SMatrix::zeros(),
    });
    Modes::new(members, &switches).unwrap().with_jump(0, 1, slides).unwrap().with_jump(1, 0, sticks).unwrap()
}

/// Both modes at the first sample, as likely as each other: one step, without a switch, after position zero.
#[must_use]
pub fn start() -> Vec<ModeState> {
    let belt = belt_velocity(0);
    let friction = FRICTION.1 * FRICTION.1;
    let predicted = |probability, state| ModeState { probability, state };
    let x = SVector::<f64, 2>::new(0.0, FRICTION.0);
    let p = SMatrix::from_diagonal(&SVector::<f64, 2>::new(START, friction));
    let (state, f) = Stick.flow(&x, &belt);
    let q = Stick.process_noise(&x, &belt).unwrap_or_else(SMatrix::zeros);
    let stick = Gaussian::new(&state, &(f * p * f.transpose() + q));
    let x = SVector::<f64, 3>::new(0.0, belt, FRICTION.0);
    let p = SMatrix::from_diagonal(&SVector::<f64, 3>::new(START, ENTRY * ENTRY, friction));
    let (state, f) = Slide.flow(&x, &belt);
    let q = Slide.process_noise(&x, &belt).unwrap_or_else(SMatrix::zeros);
    let slide = Gaussian::new(&state, &(f * p * f.transpose() + q));
    vec![predicted(0.5, stick), predicted(0.5, slide)]
}

/// A motion drawn from the model itself: whether the body slides, and the measured position, at each sample.
#[must_use]
pub fn run(seed: u64, samples: usize) -> Vec<(bool, f64)> {
    let mut random = Random::new(seed);
    let mut normal = move || {
        let (a, b) = (random.within(0.0, 1.0), random.within(0.0, 1.0));
        // One minus a number below one: the logarithm is finite.
        ((-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos(), b)
    };
    let friction = FRICTION.0 + FRICTION.1 * normal().0;
    let (mut position, mut sliding) = (START.sqrt() * normal().0, normal().1 < 0.5);
    let mut velocity = belt_velocity(0) + ENTRY * normal().0;
    let mut out = Vec::with_capacity(samples);
    for k in 0..samples {
        let belt = belt_velocity(k);
        if k > 0 && normal().1 < SWITCH {
            sliding = !sliding;
            velocity = belt + ENTRY * normal().0;
        }
        if sliding {
            position += velocity * DT + STEP_POSITION * normal().0;
            velocity += -friction * GRAVITY * DT + STEP_VELOCITY * normal().0;
        } else {
            position += belt * DT + STEP_POSITION * normal().0;
        }
        out.push((sliding, position + NOISE * normal().0));
    }
    out
}
