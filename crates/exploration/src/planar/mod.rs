//! The same in the plane: outlines that are touched by lines. Areas stand for volumes.
//!
//! Between neighbouring contacts the bounds differ by one triangle, and the gap is their sum: scores are closed forms here.

mod caps;
mod knowledge;
mod opening;
mod planners;
mod simulated;
mod start;

pub use knowledge::{Noise, PlanarKnowledge};
pub use planners::{AreaGreedy, FixedSweep, GaussianVariance, HausdorffGreedy, PathAware, RandomTouches};
pub use simulated::SimulatedFinger;
pub use start::{even_start, turned_start};
