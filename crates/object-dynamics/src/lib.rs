//! Newton-Euler dynamics of a smooth convex body held by palms: motion, contact forces, loss of contact, sensor logs.
//!
//! Start with [`ThreePalmScene`] for a body on three flat palms, [`ContactScene`] for any palms, friction, blows and flights:
//!
//! ```
//! use contact_kinematics::{Ellipsoid, Palm};
//! use glam::{DQuat, DVec3};
//! use object_dynamics::integrate::Tolerance;
//! use object_dynamics::{End, InitialMotion, MassProperties, SampleTimes, ThreePalmScene};
//! use std::f64::consts::TAU;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let axes = DVec3::new(0.05, 0.045, 0.04);
//! let mass = MassProperties::uniform_ellipsoid(0.3, axes)?;
//! // Three palms that slope like the faces of a cup and stand still.
//! let palm = |k: f64| Palm::fixed(k * TAU / 3.0, 0.8);
//! let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palm(0.0)?, palm(1.0)?, palm(2.0)?], 9.81)?;
//! let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.5, 0.2, 1.0) };
//! let times = SampleTimes { duration: 1.0, rate: 100.0 };
//! let run = scene.simulate(start, times, Tolerance { absolute: 1e-12, relative: 1e-12 })?;
//! assert_eq!(run.end, End::Completed);
//! // Nothing rubs and nothing is pushed: the energy stays.
//! let energies: Vec<f64> = run.instants.iter().map(|now| now.energy(&scene)).collect();
//! assert!(energies.iter().all(|e| (e - energies[0]).abs() < 1e-9));
//! # Ok(())
//! # }
//! ```
//!
//! [`planar`] and [`pushing`] do the same in the plane and on a table; [`ContactLog`] is what palms that sense would tell.
//!
//! Frames: `W` world (Z up, gravity `(0, 0, -g)`), `O` object (origin in the centre of mass). Units: SI.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod condensed;
mod contact_log;
mod contacts;
mod hybrid;
pub mod integrate;
mod log;
mod mass;
mod modes;
#[cfg(feature = "noise")]
mod noise;
pub mod planar;
pub mod pushing;
mod series;
mod state;
mod streams;
mod three_palms;

#[cfg(feature = "noise")]
pub use contact_log::{ChannelNoise, ContactNoise};
pub use contact_log::{
    ContactLog, ContactLogError, ContactPoints, ForceChannel, Held, LoggedPalm, MeasuredMotion,
    NotThreePlanes, PalmHinge, PalmRecord, RecordedMotion, RepeatedReading, SensedAxes, SensedForce, Stuck,
    StuckWatch, ThreePlanes, Touch, TrueContact, TwistSource,
};
pub use contacts::{
    ContactScene, ContactSceneError, DriveError, MOST_PALMS, ModeError, PalmContactError, PalmCoordinates,
    PalmDrive, PalmSpring, PalmTorque, ScenePalm, SceneState,
};
pub use hybrid::{
    ContactEvent, ContactEventKind, ContactInstant, ContactInstantError, ContactSimulation,
    ContactSimulationError, ContactStart,
};
pub use log::{LogError, PalmReading, Sample, SensorLog, TrueState};
pub use mass::{MassError, MassProperties, PrincipalInertia};
pub use modes::{ContactMode, FrictionError, MOST_FRICTION, check_friction};
#[cfg(feature = "noise")]
pub use noise::SensorNoise;
pub use series::SeriesError;
pub use state::BodyState;
pub use streams::{ClockOffset, PoseTrack, Rhythm, Silence, Track, TrackError, TurnAndShift, clock_offset};
pub use three_palms::{
    Accelerations, End, InitialMotion, Instant, MultiplierSolution, SampleTimes, SceneError, Simulation,
    SimulationError, ThreePalmScene,
};
