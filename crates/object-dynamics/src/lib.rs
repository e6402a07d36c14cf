//! Newton-Euler dynamics of a smooth convex body held by palms: motion, contact forces, loss of contact, sensor logs.
//!
//! Frames: `W` world (Z up, gravity `(0, 0, -g)`), `O` object (origin in the centre of mass). Units: SI.

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
    ContactLog, ContactLogError, ContactPoints, ForceChannel, LoggedPalm, MeasuredMotion, NotThreePlanes,
    PalmHinge, PalmRecord, RecordedMotion, SensedAxes, SensedForce, ThreePlanes, Touch, TrueContact,
    TwistSource,
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
