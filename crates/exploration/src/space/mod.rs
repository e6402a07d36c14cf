//! Bodies in space.

mod candidates;
mod cap;
mod knowledge;
pub mod metric;
mod opening;
mod planners;
mod sequence;
mod simulated;
mod start;

pub use knowledge::{Noise, SpaceKnowledge};
pub use planners::{FixedSweep, GaussianVariance, HausdorffGreedy, PathAware, RandomTouches, VolumeGreedy};
pub use sequence::low_discrepancy;
pub use simulated::SimulatedFinger;
pub use start::{tetrahedron, turned_tetrahedron};
