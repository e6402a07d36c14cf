//! Banks: several modes of a system side by side, weighed by how well each predicts the outputs.
//!
//! [`Modes`] holds what does not change with the data: a [`Member`] for each mode, the probabilities of switches, and the
//! [`jump`]s that say what a switch does to the state. A [`Bank`] takes samples. `bank.rs` is the way of a sample,
//! `answers.rs` what can be asked.
//!
//! A cart coasts (position and speed), or someone pushes it (the push is a state too); only its position is measured:
//!
//! ```
//! use nalgebra::{SMatrix, SVector};
//! use observer::Model;
//! use observer::bank::{Bank, BankOptions, Gaussian, KalmanMember, Landing, ModeState, Modes, jump};
//!
//! const DT: f64 = 0.05; // s
//!
//! /// Position and speed, or position, speed and acceleration.
//! struct Cart<const N: usize>;
//!
//! impl<const N: usize> Model<N, 1> for Cart<N> {
//!     type Input = ();
//!     fn flow(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
//!         let f = SMatrix::from_fn(|i, j| match j as i32 - i as i32 { 0 => 1.0, 1 => DT, 2 => 0.5 * DT * DT, _ => 0.0 });
//!         (f * x, f)
//!     }
//!     fn output(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, N>) {
//!         (SVector::<f64, 1>::new(x[0]), SMatrix::from_fn(|_, j| f64::from(u8::from(j == 0))))
//!     }
//!     fn process_noise(&self, _: &SVector<f64, N>, (): &()) -> Option<SMatrix<f64, N, N>> {
//!         Some(SMatrix::identity() * 1e-8)
//!     }
//!     fn scales(&self) -> SVector<f64, N> { SVector::from_element(1.0) }
//!     fn names(&self) -> [&'static str; N] {
//!         std::array::from_fn(|i| ["position", "speed", "acceleration"][i])
//!     }
//! }
//!
//! # fn main() -> Result<(), observer::bank::BankError> {
//! let variance = SVector::<f64, 1>::new(0.005 * 0.005); // of the position, the same sensor in both modes
//! let coasts = Box::new(KalmanMember::new(Cart::<2>, variance)?);
//! let pushed = Box::new(KalmanMember::new(Cart::<3>, variance)?);
//! // One switch in a hundred samples; when a push begins it is drawn from what a hand can do, and at its end it is gone.
//! let modes = Modes::new(vec![coasts, pushed], &[&[0.99, 0.01], &[0.01, 0.99]])?
//!     .with_jump(0, 1, jump(|x: &SVector<f64, 2>, (): &()| Landing {
//!         state: SVector::<f64, 3>::new(x[0], x[1], 0.0),
//!         map: SMatrix::<f64, 3, 2>::identity(),
//!         noise: SMatrix::from_diagonal(&SVector::<f64, 3>::new(0.0, 0.0, 2.0 * 2.0)),
//!     }))?
//!     .with_jump(1, 0, jump(|x: &SVector<f64, 3>, (): &()| Landing {
//!         state: SVector::<f64, 2>::new(x[0], x[1]),
//!         map: SMatrix::<f64, 2, 3>::identity(),
//!         noise: SMatrix::zeros(),
//!     }))?;
//! let rest = Gaussian::new::<2>(&SVector::zeros(), &SMatrix::identity());
//! let push = Gaussian::new::<3>(&SVector::zeros(), &SMatrix::identity());
//! let start = [ModeState { probability: 0.99, state: rest }, ModeState { probability: 0.01, state: push }];
//! let mut bank = Bank::new(modes, &start, BankOptions { lag: 20, ..BankOptions::default() })?;
//!
//! // Coasts at 0.5 m/s for 2 s, then is pushed with 1.5 m/s^2.
//! for k in 0..70 {
//!     let t = f64::from(k) * DT;
//!     let truth = 0.5 * t + 0.75 * (t - 2.0).max(0.0).powi(2);
//!     let noise = 0.005 * (f64::from(k * k) * 0.7).sin();
//!     bank.push(&(), &[Some(truth + noise)])?;
//!     if k == 40 {
//!         assert!(bank.probability(0) > 0.9); // the push has only just begun
//!     }
//! }
//! assert!(bank.probability(1) > 0.9);
//! let push = &bank.mode_states()[1].state;
//! assert!((push.mean[2] - 1.5).abs() < 3.0 * push.covariance[(2, 2)].sqrt());
//! // What both modes know, over both: position and speed. And what was the mode 19 samples ago, now that more is known?
//! let common = bank.common(&[&[0, 1], &[0, 1]])?;
//! assert!((common.mean[1] - (0.5 + 1.5 * 1.45)).abs() < 0.1);
//! assert!(bank.smoothed(19, 1).is_some_and(|p| p > 0.99));
//! # Ok(())
//! # }
//! ```

mod answers;
mod backward;
#[expect(clippy::module_inception, reason = "the bank of the module of banks")]
mod bank;
mod error;
mod gaussian;
mod hypothesis;
mod jump;
mod label;
mod log_weights;
mod member;
mod merge;
mod mixture;
mod odds;
mod options;
mod rotation;
mod system;

pub use backward::smooth_backward;
pub use bank::{Bank, ModeState};
pub use error::BankError;
pub use gaussian::{Branch, Gaussian};
pub use hypothesis::Hypothesis;
pub use jump::{Jump, Landing, jump};
pub use label::ModeLabel;
pub use member::{KalmanMember, Member};
pub use odds::Odds;
pub use options::{BankOptions, Memory};
pub use rotation::{match_rotations, rotation_difference, rotation_retract, rotation_slope};
pub use system::Modes;
