//! Three palms, and a body of which nothing is known: motion, mass and inertia from the log.

mod estimate;
mod principal;
mod problem;
mod search;

pub(crate) use estimate::STATES;
pub use estimate::{BodyEstimate, IdentifiedBody, UnknownBody, estimate_body, estimate_body_from};
pub(crate) use problem::{BODY_UNKNOWNS, BodyPoint, BodyProblem};
pub(crate) use search::{begin, mass_of_weight, scales_of_ball, spins};
