//! The same in the plane: outlines that are touched by lines. Areas stand for volumes.
//!
//! Between neighbouring contacts the bounds differ by one triangle, and the gap is their sum: scores are closed forms here.

mod caps;
mod knowledge;
mod simulated;
mod start;
mod touches;

pub use knowledge::{Noise, PlanarKnowledge};
pub use simulated::SimulatedFinger;
pub use start::{even_start, turned_start};

use crate::touching;
use shape_bounds::exact_hull::planar::Direction;

/// [`touching::PathAware`] in the plane.
pub type PathAware = touching::PathAware<Direction>;
/// [`touching::VolumeGreedy`] in the plane, by areas.
pub type AreaGreedy = touching::VolumeGreedy<Direction>;
/// [`touching::HausdorffGreedy`] in the plane.
pub type HausdorffGreedy = touching::HausdorffGreedy<Direction>;
/// [`touching::FixedSweep`] in the plane.
pub type FixedSweep = touching::FixedSweep<Direction>;
/// [`touching::RandomTouches`] in the plane.
pub type RandomTouches = touching::RandomTouches<Direction>;
/// [`touching::GaussianVariance`] in the plane.
pub type GaussianVariance = touching::GaussianVariance<Direction>;
