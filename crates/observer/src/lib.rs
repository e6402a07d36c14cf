//! Observers: estimate the state of a system from its outputs, and say how well it is known.
//!
//! The generic part needs a [`Model`] (flow, output, linearisation) and knows nothing about palms: the Newton-method
//! observer on a moving window ([`NewtonObserver`]), all samples at once ([`solve_batch`]) and the extended Kalman filter
//! ([`ExtendedKalmanFilter`]). Each estimate comes with a [`Report`]: status, residual, rank, smallest information and its
//! direction, condition, covariance. For a system that changes between modes there is a bank of filters, one for each
//! ([`Bank`]), which says how probable each mode is.
//!
//! Start with [`estimate_contacts`] for the motion, mass and inertia of a body between palms; for a system of your own with a [`Model`]:
//!
//! ```
//! use nalgebra::{SMatrix, SVector};
//! use observer::{ExtendedKalmanFilter, Model, Sample, Start, Status};
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
//! The feature `palms` (on by default) adds the estimators of shape and motion from touch.

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "palms")]
mod chance;
#[cfg(feature = "palms")]
mod contact_modes;
#[cfg(feature = "palms")]
mod contacts;
mod core;
#[cfg(feature = "palms")]
mod doubted;
#[cfg(feature = "palms")]
mod faults;
mod least_squares;
#[cfg(feature = "palms")]
pub mod planar;
#[cfg(feature = "palms")]
pub mod pushes;
#[cfg(feature = "palms")]
mod quadrature;
#[cfg(feature = "palms")]
mod random;
#[cfg(feature = "palms")]
mod reliability;
#[cfg(feature = "palms")]
mod rigid;
#[cfg(feature = "palms")]
mod roughness;
#[cfg(feature = "palms")]
mod three_palms;

#[cfg(feature = "palms")]
pub use contact_modes::{
    ContactFriction, ContactModes, ContactModesDoubt, ContactModesError, ContactModesOptions, ContactOdds,
    ContactReading, ContactSeen, ContactSlip, DoubtedReading, LearnedFriction, TwistError, WholeModes,
    whole_modes,
};
#[cfg(feature = "palms")]
pub use contacts::{
    ContactEstimate, ContactEstimateError, ContactEvidence, ContactNoiseLevel, ContactOptions,
    EstimatedModes, ForceReading, ImpulseNoise, MotionStream, PalmSensed, PlaneReadings, StreamBody,
    StreamError, StreamEstimate, StreamMotion, StreamOptions, StreamPalm, StreamStage, estimate_contacts,
};
pub use core::{
    Arrival, Bank, BankError, BankOptions, BatchOptions, BatchSolution, Branch, EkfEstimate,
    ExtendedKalmanFilter, Gaussian, Hypothesis, Jump, KalmanMember, Landing, Link, Member, Memory, ModeLabel,
    ModeState, Model, Modes, NewtonEstimate, NewtonObserver, NewtonOptions, ObserverError, Odds, Report,
    Sample, Start, Status, describe_direction, jump, match_rotations, rk4, rk4_linearised,
    rotation_difference, rotation_retract, rotation_slope, smooth_backward, solve_batch, solve_batch_along,
    solve_batch_from,
};
#[cfg(feature = "palms")]
pub use faults::{Assumption, Explanation, SensorFault, Suspect};
pub use least_squares::{Fit, FitStatus, LeastSquares, LevenbergMarquardt, NormalEquations, Observability};
#[cfg(feature = "palms")]
pub use reliability::{Reason, Reliability};
#[cfg(feature = "palms")]
pub use rigid::{PoseAxes, PoseCovariance, PoseErrors, equivalent_orientations, nearest_turn};
#[cfg(feature = "palms")]
pub use three_palms::{
    Closure, KnownTouch, MotionState, NoForceError, NoForceEstimate, NoForceEvidence, PaperError,
    PaperMethod, PaperReconstruction, PaperStart, PredictorCorrector, TouchShape, Track, TrackError,
    estimate_without_forces, integrate_paper_system,
};

/// How much of a test is run: a decisive part of it, all of it where the environment says `RECON_TESTS=all`, as
/// `cargo xtask verify --only all-tests` does.
#[cfg(all(test, feature = "palms"))]
pub(crate) fn few_or_all<T>(few: T, all: T) -> T {
    if std::env::var_os("RECON_TESTS").is_some_and(|asked| asked == "all") { all } else { few }
}
