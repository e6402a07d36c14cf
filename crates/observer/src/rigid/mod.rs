//! Orientation and inertia of a rigid body, and how far its poses may be off.

mod inertia;
mod orientations;
mod pose_errors;
mod turns;

pub(crate) use inertia::{INERTIA_NUMBERS, inertia_of_numbers, inertia_slope, numbers_of_inertia};
pub(crate) use pose_errors::{DRAWS, normals, root, turned};
pub(crate) use turns::{cross_matrix, exponential, logarithm};

pub use orientations::{equivalent_orientations, nearest_turn};
pub use pose_errors::{PoseAxes, PoseCovariance, PoseErrors};
