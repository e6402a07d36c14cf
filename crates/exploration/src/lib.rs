//! Where to touch an unknown convex body next, and when to stop.
//!
//! Each contact narrows two bounds: the body holds the hull of the points, and is held by the half-spaces of the normals. A
//! [`Planner`] looks at these bounds alone and says where the next touch pays most; a [`Finger`] carries it out; [`explore`] goes
//! around until a [`Goal`] is proven. The proof is by the bounds, so that a planner can be slow but never wrong.
//!
//! Start with [`space::PathAware`], or [`planar::PathAware`] in the plane:
//!
//! ```
//! use exploration::space::{PathAware, SimulatedFinger, SpaceKnowledge, turned_tetrahedron};
//! use exploration::{Goal, Motion, Outcome, Task, explore};
//! use glam::DVec3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // An ellipsoid, which the planner does not see.
//! let axes = DVec3::new(3.0, 2.0, 1.0);
//! let mut finger = SimulatedFinger::new(move |n| axes * axes * n.get() / (axes * n.get()).length(), Motion::Plane);
//! let mut known = SpaceKnowledge::exact();
//! let mut planner = PathAware::new(turned_tetrahedron(1));
//! let task = Task::new(Goal::Gap(0.2), 100);
//! let Outcome::Reached(proof) = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ())? else {
//!     return Err("not reached".into());
//! };
//! assert!(proof.proven <= 0.2 && proof.touches < 52);
//! # Ok(())
//! # }
//! ```
//!
//! A body between palms is felt where it lies: [`rolling`] plans how two palms turn, in the plane, and [`parallel`] how one of two parallel palms with
//! friction moves, in space.
//! A body that is not convex is touched by a round finger: [`contour`] follows outlines, [`relief`] comes down on bodies in space.
//!
//! All lengths are in m, all coordinates in the body's frame. The same seeds give the same touches to the last bit: nothing here
//! runs in more than one thread.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod certificate;
mod confidence;
pub mod contour;
mod finger;
mod gaussian;
#[cfg(any(test, feature = "generators"))]
pub mod generators;
mod goal;
mod heading;
mod knowledge;
mod limits;
pub mod parallel;
pub mod planar;
mod planner;
mod random;
mod reach;
pub mod relief;
pub mod rolling;
pub mod space;
mod theory;
pub mod touching;

pub use certificate::{Certificate, Outcome, Shortfall};
pub use confidence::{Confidence, ConfidenceError, Spending};
pub use finger::{Finger, Motion, TouchError};
pub use goal::{Goal, GoalError};
pub use heading::Heading;
pub use knowledge::{Knowledge, KnowledgeError, Measures};
pub use limits::{Cone, Limits, LimitsError};
pub use planner::{PlanError, Planner, Proposal, Reason, Situation};
pub use random::Source;
pub use reach::{ExploreError, Step, Task, explore};
pub use theory::{least_gap, least_touches, touches_predicted};
