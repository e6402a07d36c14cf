//! Simulation through contact modes: smooth motion between located events, and what happens at each.

mod blow;
mod change;
mod crawl;
mod error;
mod events;
mod field;
mod gaps;
mod guards;
mod instant;
mod packed;
mod project;
mod result;
mod run;
mod smooth;
mod start;
mod step;

pub use error::ContactSimulationError;
pub use instant::ContactInstantError;
pub use result::{ContactEvent, ContactEventKind, ContactInstant, ContactSimulation};
pub use start::ContactStart;
