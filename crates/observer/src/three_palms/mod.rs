//! Three palms in space.

mod cold_start;
mod correlation;
mod covariance;
mod curves;
mod estimate;
mod evidence;
mod momentum;
mod noise;
mod quadrature;
mod track;

pub use covariance::NoiseLevel;
pub use estimate::{EstimateError, KnownBody, MotionEstimate, equivalent_orientations, estimate_motion};
pub use evidence::{Evidence, Quantity, Reason, Reliability, WeakDirection};
pub use momentum::{MotionState, Scales, StartState};
pub use track::{Track, TrackError};
