//! Three palms, and a body of which nothing is known: motion, mass and inertia from the log.

mod estimate;
mod principal;
mod problem;
mod search;

pub use estimate::{BodyEstimate, IdentifiedBody, UnknownBody, estimate_body, estimate_body_from};
