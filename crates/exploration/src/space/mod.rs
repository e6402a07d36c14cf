//! Bodies in space.

mod candidates;
mod cap;
mod knowledge;
pub mod metric;
mod sequence;
mod simulated;
mod start;
mod touches;

pub use knowledge::{Noise, SpaceKnowledge};
pub use sequence::low_discrepancy;
pub use simulated::SimulatedFinger;
pub use start::{tetrahedron, turned_tetrahedron};

use crate::touching;
use contact_kinematics::Direction;

/// [`touching::PathAware`] in space.
pub type PathAware = touching::PathAware<Direction>;
/// [`touching::VolumeGreedy`] in space.
pub type VolumeGreedy = touching::VolumeGreedy<Direction>;
/// [`touching::HausdorffGreedy`] in space.
pub type HausdorffGreedy = touching::HausdorffGreedy<Direction>;
/// [`touching::FixedSweep`] in space.
pub type FixedSweep = touching::FixedSweep<Direction>;
/// [`touching::RandomTouches`] in space.
pub type RandomTouches = touching::RandomTouches<Direction>;
/// [`touching::GaussianVariance`] in space.
pub type GaussianVariance = touching::GaussianVariance<Direction>;
