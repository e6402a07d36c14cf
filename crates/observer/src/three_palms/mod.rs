//! Three palms in space.

mod clean;
mod cold_start;
mod correlation;
mod covariance;
mod curves;
mod estimate;
mod evidence;
mod inertia;
mod momentum;
mod no_force;
mod noise;
mod orientations;
mod paper_method;
mod paper_system;
mod polish;
mod pose_errors;
mod quadrature;
mod random;
mod sensitivity;
#[cfg(test)]
mod test_scenes;
mod track;
mod unknown_body;
mod verdict;

pub(crate) use inertia::{inertia_of_numbers, inertia_slope, numbers_of_inertia};
pub(crate) use pose_errors::{DRAWS, kept, normals, root, turned};
pub(crate) use quadrature::running_integral;
pub(crate) use random::Normal;
pub(crate) use sensitivity::{cross_matrix, exponential, logarithm};
pub(crate) use verdict::{LARGEST_DEVIATION, LARGEST_MISFIT};

pub use covariance::NoiseLevel;
pub use estimate::{EstimateError, KnownBody, MotionEstimate, estimate_motion, estimate_motion_from};
pub use evidence::{Evidence, Quantity, Reason, Reliability, WeakDirection};
pub use momentum::{MotionState, Scales, StartState};
pub use no_force::{
    Closure, KnownTouch, NoForceError, NoForceEstimate, NoForceEvidence, TouchShape, estimate_without_forces,
};
pub use orientations::{equivalent_orientations, nearest_turn};
pub use paper_method::{
    PaperError, PaperMethod, PaperReconstruction, PaperStart, PredictorCorrector, integrate_paper_system,
};
pub use pose_errors::{PoseAxes, PoseCovariance, PoseErrors};
pub use track::{Track, TrackError};
pub use unknown_body::{BodyEstimate, IdentifiedBody, UnknownBody, estimate_body, estimate_body_from};
