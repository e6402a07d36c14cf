//! A smooth convex body on palms of any number, shape, pose and motion, with Coulomb friction.

mod drive;
mod scene;

pub use drive::{DriveError, PalmDrive, PalmSpring, PalmTorque};
pub use scene::{ContactScene, ContactSceneError, MOST_PALMS, ScenePalm};
