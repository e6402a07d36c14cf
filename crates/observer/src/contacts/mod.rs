//! Motion, mass and inertia from contacts of any palms: nodes linked by measured impulses.
//!
//! ```
//! use contact_kinematics::{Ellipsoid, Palm};
//! use glam::{DQuat, DVec3};
//! use object_dynamics::integrate::Tolerance;
//! use object_dynamics::{ContactLog, InitialMotion, MassProperties, SampleTimes, ThreePalmScene};
//! use observer::contacts::{ContactNoiseLevel, ContactOptions, estimate_contacts};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // What three palms sense of 300 g between them, for a second and a half.
//! let axes = DVec3::new(0.05, 0.045, 0.04);
//! let mass = MassProperties::uniform_ellipsoid(0.3, axes)?;
//! let palm = |k: f64| Palm::fixed(k * std::f64::consts::TAU / 3.0, 0.8);
//! let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palm(0.0)?, palm(1.0)?, palm(2.0)?], 9.81)?;
//! let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(2.0, -1.0, 4.0) };
//! let times = SampleTimes { duration: 1.5, rate: 200.0 };
//! let run = scene.simulate(start, times, Tolerance::uniform(1e-12))?;
//! let log = run.sensor_log(&scene)?;
//! let noise = ContactNoiseLevel { contact: 0.0, force_fixed: 0.0, force_share: 0.0, impulse: None, floor: 1e-6 };
//! let options = ContactOptions { friction: Some(0.0), ..ContactOptions::new(noise, 9.81) };
//! let found = estimate_contacts(&ContactLog::try_from(&log)?, None, &options)?;
//! assert!((found.mass - 0.3).abs() < 1e-4, "{}", found.mass);
//! assert!((found.states[0].w_WO - start.w_WO).length() < 1e-3, "{}", found.states[0].w_WO);
//! # Ok(())
//! # }
//! ```

mod any_axes;
mod axes;
mod backwards;
mod beginning;
mod between;
mod body;
mod both;
mod chain;
mod changed;
mod cold;
mod directly;
mod drawn;
mod elimination;
mod ends;
mod equations;
mod estimate;
mod expected;
mod explanations;
mod feet;
mod first;
mod flow;
mod gaps;
mod impulses;
mod joint;
mod levers;
mod link;
mod lost;
mod misread_forces;
mod mode_odds;
mod modes;
mod noise;
mod onward;
mod options;
mod outliers;
mod palm_rates;
mod plane;
mod problem;
mod ranges;
mod reach;
mod record;
mod redrawn;
mod relabel;
mod rivals;
mod roughness;
mod rows;
mod samples;
mod search;
mod sensor_change;
mod serial;
mod sharp;
mod slips;
mod slopes;
mod solve;
mod split;
mod spurious;
mod stage;
mod state;
mod stated_body;
mod stepping;
pub mod stream;
mod surprise;
mod suspects;
#[cfg(test)]
mod tests;
mod trial;
mod triangular;
mod unresolved;
mod verdict;
mod way;
mod widened;
mod windows;

pub use beginning::Beginning;
pub use estimate::{ContactEstimate, estimate_contacts, estimate_contacts_from};
pub use mode_odds::EstimatedModes;
pub use noise::{ContactNoiseLevel, ImpulseNoise};
pub use options::{ContactEstimateError, ContactOptions};
pub use verdict::ContactEvidence;
