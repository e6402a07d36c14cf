//! Two palms that log what they sense.

use object_dynamics::planar::{
    ContactLog, ContactLogError, ContactSceneError, ContactSimulationError, StartError,
};
use thiserror::Error;

/// Why palms cannot go on.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum HandsError {
    /// The body left the palms.
    #[error("a contact on palm {palm} is {s:.4} m from the hinge; the palm is {length} m long")]
    Off {
        /// From 1.
        palm: usize,
        /// In m; negative behind the hinge.
        s: f64,
        /// Of the palm, m.
        length: f64,
    },
    /// Palms that are none.
    #[error(transparent)]
    Scene(#[from] ContactSceneError),
    /// The body cannot be between the palms as asked.
    #[error(transparent)]
    Start(#[from] StartError),
    /// Rigid bodies have no motion here, or several.
    #[error(transparent)]
    Simulation(#[from] ContactSimulationError),
    /// What was sensed is no log.
    #[error(transparent)]
    Log(#[from] ContactLogError),
}

/// Two palms hinged at the origin with a body between them, and all that they have sensed so far.
pub trait Hands {
    /// Absolute angles now, rad.
    fn palms(&self) -> [f64; 2];

    /// Turns both palms to absolute angles (rad), from rest to rest within `seconds`, and waits for `wait` s, with the sensors on.
    ///
    /// # Errors
    /// [`HandsError`]; what was sensed until then may be in the log.
    fn turn(&mut self, to: [f64; 2], seconds: f64, wait: f64) -> Result<(), HandsError>;

    /// All that was sensed.
    ///
    /// # Errors
    /// [`HandsError::Log`] where that is too little.
    fn log(&self) -> Result<ContactLog, HandsError>;
}
