//! Observers: estimate the state of a system from its outputs, and say how well it is known.
//!
//! # Start here
//! With a system of your own: describe it by a [`Model`] (flow, output, linearisation) and take one of the first four rows. With palms that
//! sense: [`contacts::estimate_contacts`], which needs no guess. Each module has a worked example. Every estimate comes with a [`Report`] or
//! its like: status, residual, rank, the worst known direction, condition, covariance.
//!
//! | to do | take |
//! |---|---|
//! | follow a system sample by sample: by Newton's method on a moving window; by a Kalman filter | [`newton`]; [`ekf`] |
//! | estimate from all samples at once | [`batch`] |
//! | follow a system that changes between modes, and tell how probable each is | [`bank`] |
//! | integrate a flow with its linearisation | [`rk4`] |
//! | nonlinear least squares of few unknowns | [`least_squares`] |
//! | motion, mass and inertia of a body from what palms sense; the same sample by sample | [`contacts`]; [`contacts::stream`] |
//! | motion and shape from where three palms are touched, without forces | [`three_palms::no_force`] |
//! | tell whether contacts slide, stick or are off | [`contact_modes`] |
//! | all that in the plane | [`planar`] |
//! | pose of an object that two parallel palms roll between them | [`rolling`] |
//! | outline and friction of an object that is pushed over a table | [`pushes`] |
//! | read what an estimate says of itself, of sensors, of poses | [`reliability`], [`faults`], [`rigid`] |
//! | the paper's own method, as an oracle | [`three_palms::paper_method`] |
//!
//! A Kalman filter of a cart:
//!
//! ```
//! use nalgebra::{SMatrix, SVector};
//! use observer::{Model, Sample, Start, Status, ekf::ExtendedKalmanFilter};
//!
//! /// Position and speed of a cart, sampled at 10 Hz; its position is measured.
//! struct Cart;
//!
//! impl Model<2, 1> for Cart {
//!     type Input = ();
//!     fn flow(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
//!         let slope = SMatrix::<f64, 2, 2>::new(1.0, 0.1, 0.0, 1.0);
//!         (slope * x, slope)
//!     }
//!     fn output(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 2>) {
//!         (SVector::<f64, 1>::new(x[0]), SMatrix::<f64, 1, 2>::new(1.0, 0.0))
//!     }
//!     fn scales(&self) -> SVector<f64, 2> { SVector::<f64, 2>::new(1.0, 1.0) }
//!     fn names(&self) -> [&'static str; 2] { ["position", "speed"] }
//! }
//!
//! # fn main() -> Result<(), observer::ObserverError> {
//! let mut filter = ExtendedKalmanFilter::new(Cart, &Start::guess(SVector::<f64, 2>::zeros()))?;
//! let at = |position: f64| Sample {
//!     input: (),
//!     measured: SVector::<f64, 1>::new(position),
//!     information: SVector::<f64, 1>::new(1e6), // one over (1 mm)^2
//! };
//! filter.push(&at(2.0));
//! // One position says nothing of the speed, and the report says so.
//! let report = filter.estimate().report;
//! assert_eq!((report.status, report.rank), (Status::NotObservable, 1));
//! (1..50).for_each(|k| filter.push(&at(2.0 + 0.03 * f64::from(k))));
//! let found = filter.estimate();
//! assert_eq!(found.report.status, Status::Converged);
//! assert!((found.state[1] - 0.3).abs() < 1e-3);
//! # Ok(())
//! # }
//! ```
//!
//! The feature `palms` (on by default) adds the estimators of shape and motion from touch: all rows from the sixth on.

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "palms")]
mod chance;
#[cfg(feature = "palms")]
pub mod contact_modes;
#[cfg(feature = "palms")]
pub mod contacts;
mod core;
#[cfg(feature = "palms")]
mod doubted;
#[cfg(feature = "palms")]
pub mod faults;
pub mod least_squares;
#[cfg(feature = "palms")]
pub mod planar;
#[cfg(feature = "palms")]
mod predicted;
#[cfg(feature = "palms")]
pub mod pushes;
#[cfg(feature = "palms")]
mod quadrature;
#[cfg(feature = "palms")]
mod random;
#[cfg(feature = "palms")]
pub mod reliability;
#[cfg(feature = "palms")]
pub mod rigid;
#[cfg(feature = "palms")]
pub mod rolling;
#[cfg(feature = "palms")]
mod roughness;
#[cfg(feature = "palms")]
pub mod three_palms;

pub use core::{
    Model, ObserverError, Report, Sample, Start, Status, bank, batch, describe_direction, ekf, newton, rk4,
};

/// How much of a test is run: a decisive part of it, all of it where the environment says `RECON_TESTS=all`, as
/// `cargo xtask verify --only all-tests` does.
#[cfg(all(test, feature = "palms"))]
pub(crate) fn few_or_all<T>(few: T, all: T) -> T {
    if std::env::var_os("RECON_TESTS").is_some_and(|asked| asked == "all") { all } else { few }
}
