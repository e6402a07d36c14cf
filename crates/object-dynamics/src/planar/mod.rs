//! The planar case: motion, contact forces and sensor logs of an object between two hinged palms, frictionless; and
//! on one to five palms of any shape and motion, with friction ([`ContactScene`]).
//!
//! Conventions as in [`contact_kinematics::planar`]; gravity is `(0, -g)`. While both contacts hold, the object has
//! one degree of freedom, its orientation `phi0`, and nothing is divided by but `sin phi2` and `I0/m + <d, d>`, both
//! positive: the equations are regular at every speed and in every orientation.

mod contact_log;
mod contacts;
mod error;
mod hybrid;
mod in_space;
mod lagrange;
mod log;
mod mass;
mod motion;
#[cfg(feature = "noise")]
mod noise;
mod quasistatic;
mod reaction;
mod simulate;
mod torque_driven;

pub use contact_log::{ContactLog, ContactLogError, ContactLogSample, PalmSample};
pub use contacts::{ContactScene, ContactSceneError, Jammed, ModeError, ScenePalm};
pub use error::{PlanarLogError, PlanarSimulationError};
pub use hybrid::{
    BodyState, ContactEvent, ContactEventKind, ContactInstant, ContactInstantError, ContactSimulation,
    ContactSimulationError, ContactStart, FieldError, PalmContactError, StartError,
};
pub use in_space::{in_plane, in_space, turn_in_space};
pub use lagrange::lagrange;
pub use log::{PlanarLog, PlanarSample, PlanarTruth};
pub use mass::{PlanarMass, PlanarMassError};
pub use motion::{ConstantRates, HarmonicPalms, PairMotion};
#[cfg(feature = "noise")]
pub use noise::{ContactNoise, PlanarNoise};
pub use quasistatic::{Equilibrium, FollowError, PlanarEquilibria};
pub use reaction::{PairReaction, PlanarObject};
pub use simulate::{LostContact, PlanarRun, PlanarRunSample, PlanarStart, simulate_prescribed};
pub use torque_driven::{DrivenPalms, TorqueReaction, TorqueStart, TorqueState, simulate_torque_driven};
