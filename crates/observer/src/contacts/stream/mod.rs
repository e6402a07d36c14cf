//! The motion sample by sample, from no guess, in bounded memory.
//!
//! A thread of its own estimates the motion over a window of the latest samples, by the same least squares as a whole log:
//! [`estimate_contacts`](crate::contacts::estimate_contacts). It begins where the window before ended up, so that a few linearisations do. The
//! thread that pushes samples carries the motion from the window's end to the newest sample by what was measured since, with its
//! covariance, in a few microseconds.
//!
//! What the thread is given at one sample is taken at a fixed number of samples later, whenever it was done: the same samples give the
//! same estimates on every machine. On one that is too slow for that, a push waits.
//!
//! ```
//! use contact_kinematics::{Ellipsoid, Palm};
//! use glam::{DQuat, DVec3};
//! use object_dynamics::integrate::Tolerance;
//! use object_dynamics::{InitialMotion, MassProperties, SampleTimes, ThreePalmScene};
//! use observer::contacts::stream::{MotionStream, PlaneReadings, StreamOptions, StreamStage};
//! use observer::contacts::{ContactNoiseLevel, ContactOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // What three palms sense of 300 g between them, for three seconds.
//! let axes = DVec3::new(0.05, 0.045, 0.04);
//! let mass = MassProperties::uniform_ellipsoid(0.3, axes)?;
//! let palm = |k: f64| Palm::fixed(k * std::f64::consts::TAU / 3.0, 0.8);
//! let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palm(0.0)?, palm(1.0)?, palm(2.0)?], 9.81)?;
//! let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(2.0, -1.0, 4.0) };
//! let times = SampleTimes { duration: 3.0, rate: 200.0 };
//! let run = scene.simulate(start, times, Tolerance::uniform(1e-12))?;
//! let log = run.sensor_log(&scene)?;
//! let noise = ContactNoiseLevel { contact: 0.0, force_fixed: 0.0, force_share: 0.0, impulse: None, floor: 1e-5 };
//! let options = StreamOptions { contacts: ContactOptions::new(noise, 9.81), sample_rate: 200.0 };
//! let mut stream = MotionStream::new(PlaneReadings::palms(), options)?;
//! // Palms that tell their normals: their rates are those between the samples beside one, so that each comes one sample late.
//! let mut readings = PlaneReadings::new(None);
//! let mut last = None;
//! for sample in log.samples() {
//!     if let Some((t, sensed)) = readings.push(sample)? {
//!         last = Some(stream.push(t, &sensed)?);
//!     }
//! }
//! let last = last.ok_or("no sample")?;
//! assert_eq!(last.stage, StreamStage::Tracking);
//! assert!(last.motion.is_some_and(|motion| (motion.body.mass - 0.3).abs() < 1e-2));
//! # Ok(())
//! # }
//! ```

mod dearer;
mod estimate;
mod freed;
mod front;
mod log;
mod misread;
mod modes;
mod others;
mod planes;
mod sample;
mod schedule;
mod solution;
#[cfg(test)]
mod tests;
mod thread;
mod window;

pub use estimate::{StreamBody, StreamError, StreamEstimate, StreamMotion, StreamOptions, StreamStage};
pub use modes::StreamModes;
pub use planes::PlaneReadings;
pub use sample::{ForceReading, PalmSensed, StreamPalm};
pub use schedule::MotionStream;
