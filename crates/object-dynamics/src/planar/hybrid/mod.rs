//! Simulation through changes of contact modes: located events, blows, flight.

mod decide;
mod error;
mod events;
mod phase;
mod run;
mod start;
mod state;
#[cfg(test)]
mod tests;
mod tracker;

pub use error::{ContactSimulationError, FieldError, StartError};
pub use events::Cause;
pub use run::{ContactEvent, ContactReading, ContactRun, ContactRunSample};
pub use start::ContactStart;
pub use state::BodyState;
