//! No force sensors: motion, shape and inertia over mass from contacts and palm poses alone.
//!
//! ```
//! use contact_kinematics::{Ellipsoid, Palm};
//! use glam::{DQuat, DVec3};
//! use object_dynamics::integrate::Tolerance;
//! use object_dynamics::{InitialMotion, MassProperties, SampleTimes, ThreePalmScene};
//! use observer::three_palms::no_force::{KnownTouch, estimate_without_forces};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Where an ellipsoid touches three palms, for a second and a half. Forces are not read.
//! let axes = DVec3::new(0.05, 0.045, 0.04);
//! let mass = MassProperties::uniform_ellipsoid(0.3, axes)?;
//! let palm = |k: f64| Palm::fixed(k * std::f64::consts::TAU / 3.0, 0.8);
//! let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palm(0.0)?, palm(1.0)?, palm(2.0)?], 9.81)?;
//! let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(2.0, -1.0, 4.0) };
//! let times = SampleTimes { duration: 1.5, rate: 200.0 };
//! let run = scene.simulate(start, times, Tolerance::uniform(1e-12))?;
//! let log = run.sensor_log(&scene)?;
//! let known = KnownTouch { gravity: scene.gravity(), contact_noise: None };
//! let found = estimate_without_forces(&log, &known)?;
//! // Semi-axes ascend.
//! assert!((found.shape.semi_axes - DVec3::new(0.04, 0.045, 0.05)).length() < 1e-5, "{}", found.shape.semi_axes);
//! # Ok(())
//! # }
//! ```

mod closure;
mod deviations;
mod error;
mod estimate;
mod orientations;
mod problem;
mod search;
mod series;
mod shape;
mod suspects;

#[cfg(test)]
mod tests;

pub use closure::Closure;
pub use error::NoForceError;
pub use estimate::{KnownTouch, NoForceEstimate, NoForceEvidence, TouchShape, estimate_without_forces};
