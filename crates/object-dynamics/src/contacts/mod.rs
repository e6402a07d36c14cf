//! A smooth convex body on palms of any number, shape, pose and motion, with Coulomb friction.

mod choose;
mod cones;
mod coulomb;
mod directions;
mod drive;
mod instant;
mod law;
mod painleve;
mod problem;
mod scene;
mod solve;

pub use choose::ModeError;
pub(crate) use choose::{Choice, EXACT, Left, Touch};
pub(crate) use coulomb::{Forces, Search};
pub(crate) use directions::NO_DIRECTIONS;
pub use drive::{DriveError, PalmDrive, PalmSpring, PalmTorque};
pub(crate) use instant::Contacts;
pub use instant::{PalmContactError, PalmCoordinates, SceneState};
pub(crate) use problem::{ContactProblem, Directions, FULFILLED, Modes, Reaction};
pub use scene::{ContactScene, ContactSceneError, MOST_PALMS, ScenePalm};
