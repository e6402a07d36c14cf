//! Rolling in the plane: a body lies between two palms that turn about a common hinge, and is felt where it touches them.
//!
//! Palms turn slowly, without friction, so that the body is where its centre of mass is lowest. Where that is follows in closed form from
//! the support function: the torque balance `d_1 sin P_2 + d_2 sin P_1 = 0` of two forces along the palms' normals and the weight. A motion
//! of the palms is a curve of contacts on the body; what it will be is predicted on bodies drawn between the bounds, as the planner never sees
//! the true one. Where a minimum ends in a fold the body falls to the next one; nothing is felt while it does.
//!
//! World X is right, Y up; the hinge is the origin; angles are absolute, counter-clockwise, in rad. Contacts are in the frame of
//! the body, whose orientation `phi` an estimator gives: what that is worth is part of the noise that is stated.

mod balance;
mod belief;
mod drawn;
mod dynamics;
mod explore;
mod flood;
mod gain;
mod metric;
mod outcome;
mod palms;
mod planner;
mod planners;
mod predict;
mod sensed;
mod simulated;
mod track;
mod workspace;

pub use balance::{Balance, Rest, RollingBody, settle};
pub use drawn::DrawnBody;
pub use dynamics::Dynamics;
pub use explore::{RollError, RollStep, RollTask, explore_rolling};
pub use metric::{PalmsInBody, distance, duration};
pub use outcome::{RollEnd, RollOutcome};
pub use palms::{Palms, PalmsError, Reading};
pub use planner::{RollPlanError, RollPlanner, RollProposal, View};
pub use planners::{InformationRate, LargestGap, NearestGap, PalmSweep, RandomTurns};
pub use predict::Prediction;
pub use sensed::{
    Hands, HandsError, Look, SensedEnd, SensedError, SensedOutcome, SensedStep, SensedTask, SimulatedHands,
    explore_sensed, noisy_curves,
};
pub use simulated::SimulatedPalms;
pub use track::Track;
pub use workspace::{Workspace, WorkspaceError};
