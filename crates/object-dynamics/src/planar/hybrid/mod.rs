//! Simulation through contact modes: smooth motion between located events, and what happens at each.

mod decide;
mod error;
mod events;
mod instant;
mod phase;
mod result;
mod run;
mod start;
mod state;
#[cfg(test)]
mod tests;
mod tracker;

pub use error::{ContactSimulationError, FieldError, PalmContactError, StartError};
pub use events::ContactEventKind;
pub use instant::ContactInstantError;
pub use result::{ContactEvent, ContactInstant, ContactSimulation};
pub use start::ContactStart;
pub use state::BodyState;
