//! A smooth convex body on three flat frictionless palms.

mod instant;
mod minimal;
mod multiplier;
mod scene;
mod simulate;

pub use instant::{Accelerations, Instant};
pub use multiplier::MultiplierSolution;
pub use scene::{SceneError, ThreePalmScene};
pub(crate) use simulate::check_times;
pub use simulate::{End, InitialMotion, SampleTimes, Simulation, SimulationError};
