//! Orientation and inertia of a rigid body, and how far its poses may be off.
//!
//! A box looks alike from four sides; an estimate is compared with the truth by the one that is nearest:
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use object_dynamics::MassProperties;
//! use observer::rigid::nearest_turn;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mass = MassProperties::from_principal(1.0, DVec3::new(1.0, 1.5, 2.0))?;
//! let truth = DQuat::from_rotation_z(0.3);
//! let estimated = truth * DQuat::from_rotation_x(std::f64::consts::PI); // a half turn about a principal axis leaves no trace
//! let alike = truth * nearest_turn(&mass, truth, estimated);
//! assert!(alike.dot(estimated).abs() > 1.0 - 1e-12);
//! # Ok(())
//! # }
//! ```

mod inertia;
mod orientations;
mod pose_errors;
mod turns;

pub(crate) use inertia::{INERTIA_NUMBERS, inertia_of_numbers, inertia_slope, numbers_of_inertia};
pub(crate) use pose_errors::{DRAWS, normals, root, turned};
pub(crate) use turns::{cross_matrix, exponential, logarithm, logarithm_slope};

pub use orientations::{equivalent_orientations, nearest_turn};
pub use pose_errors::{PoseAxes, PoseCovariance, PoseErrors};
