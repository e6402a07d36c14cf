use crate::contacts::{ModeError, PalmContactError, SceneState};
use crate::integrate::IntegrationError;
use crate::{LogError, SimulationError};
use thiserror::Error;

/// Why a simulation through contact modes cannot start or go on.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactSimulationError {
    /// Sample times or the state at the start are not usable.
    #[error(transparent)]
    Start(#[from] SimulationError),
    /// The object overlaps a palm.
    #[error(
        "object penetrates palm {palm} by {depth:.3e} m at the start; move it by that along the palm's normal"
    )]
    Penetration {
        /// Palm number from 1.
        palm: usize,
        /// How deep, m.
        depth: f64,
    },
    /// The object touches nothing.
    #[error(
        "object touches no palm at the start: palm {palm} is the nearest, with a gap of {gap:.3e} m; move it there, or \
         say that it starts in flight"
    )]
    NotInContact {
        /// Palm number from 1.
        palm: usize,
        /// The gap, m.
        gap: f64,
    },
    /// Two endless palms are one and the same.
    #[error("palms {first} and {second} ({kind}) are one and the same at the start; leave one of them out")]
    PalmsCoincide {
        /// Palm number from 1.
        first: usize,
        /// Palm number from 1.
        second: usize,
        /// Their kind, as in files.
        kind: &'static str,
    },
    /// Two palms overlap each other.
    #[error("palms {first} and {second} overlap by {depth:.3e} m at the start; move them apart")]
    PalmsOverlap {
        /// Palm number from 1.
        first: usize,
        /// Palm number from 1.
        second: usize,
        /// How deep, m.
        depth: f64,
    },
    /// No contact mode, or more than one, follows from rigid bodies with Coulomb friction.
    #[error("at t = {} s: {source}", state.t)]
    Modes {
        /// Body and palms there.
        state: Box<SceneState>,
        /// Why.
        source: ModeError,
    },
    /// A contact could not be found.
    #[error("at t = {t} s: {source}")]
    Contact {
        /// Time in s.
        t: f64,
        /// Why.
        source: PalmContactError,
    },
    /// So many steps for so little time that the end is out of reach.
    #[error(
        "{steps} steps lead no further than t = {t:.3e} s, where the object turns at {spin:.3e} rad/s and moves at {speed:.3e} m/s, palms \
         at up to {palms:.3e} m/s; slow down object and palms, make springs softer or heavier, or allow a larger tolerance"
    )]
    TooSlow {
        /// Time reached, s.
        t: f64,
        /// Steps until then.
        steps: usize,
        /// Angular speed of the body there, rad/s.
        spin: f64,
        /// Speed of its centre of mass there, m/s.
        speed: f64,
        /// Speed of the fastest palm, m/s.
        palms: f64,
    },
    /// The equations of motion could not be integrated.
    #[error("integration: {0}")]
    Integration(#[source] IntegrationError<PalmContactError>),
    /// The samples do not make a log.
    #[error("sensor log: {0}")]
    Log(#[source] LogError),
}
