//! Rolling in space: a body is squeezed between two parallel palms with friction, and rolls as the upper one is moved.
//!
//! Neither contact slips, and the pads do not let the body spin about their normal (soft fingers: Mason and Salisbury, 1985). A motion of the upper palm
//! straight along `e` then turns the body about `z x e`, so that the outward normal at the upper contact runs along a great circle in the frame of the
//! body, and that at the lower contact along the opposite one: one motion feels two arcs. With the points `x(u)` of the body, `d = x(u) - x(-u)` from the lower contact to the upper one, and
//! the width `w(u) = u . d`, a turn by `da` moves the upper palm by `w da` along `e`, and each contact along its pad by the arc that is rolled over.
//!
//! The weight is taken to be small against the squeeze. Two forces that hold a body are on one line, along `d`: nothing slips as long as its tangent to
//! the normals, `|d - w u| / w = |grad w| / w`, is at most the coefficient of friction (Nguyen, 1988). Palms feel this ratio, and stop short of it. What is squeezed where the ratio is larger tips over to where it is narrower.
//!
//! World Z is up; the lower palm is the plane `z = 0` and stands still; all angles are in rad, lengths in m. Contacts are in the frame of the body. [`EstimatedPalms`] has it
//! from what palms sense ([`observer::rolling`]), with how far it may be off: that neither contact slips is looked at there, that pads let it spin no more than stated is taken for true. Of exact contacts
//! what is proven rests on the contacts alone, and on none of the above.

mod belief;
mod estimated;
mod explore;
mod hold;
mod palms;
mod planner;
mod planners;
mod predict;
mod simulated;
mod workspace;

pub use estimated::EstimatedPalms;
pub use explore::{ParallelError, ParallelStep, ParallelTask, explore_parallel};
pub use hold::{Hold, Stop, Stroke, Wall};
pub use palms::{FeltBetween, ParallelPalms, ParallelPalmsError, SensedPalms};
pub use planner::{ParallelPlanError, ParallelPlanner, ParallelProposal, ParallelView};
pub use planners::{LargestGap, NearestGap, PathRate, RandomStrokes, RasterSweep};
pub use predict::Prediction;
pub use simulated::SimulatedParallelPalms;
pub use workspace::{ParallelWorkspace, ParallelWorkspaceError};
