//! Rolling with an estimator in the loop: palms log poses, contacts and forces with noise while they turn, the motion of the body is estimated from
//! the whole log after each motion, bounds are made of its contacts, and the next motion is planned by these.
//!
//! Nothing true is seen by the planner or by the proof. What the body does between two motions is not assumed to be slow: it rocks, falls and
//! slides by the equations of motion.

mod explore;
mod friction;
mod hands;
mod look;
mod simulated;

pub use explore::{SensedEnd, SensedError, SensedOutcome, SensedStep, SensedTask, explore_sensed};
pub use hands::{Hands, HandsError};
pub use look::{Look, noisy_curves};
pub use simulated::SimulatedHands;
