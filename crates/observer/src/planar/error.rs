//! Why a planar estimate without forces cannot be made.

use crate::ObserverError;
use contact_kinematics::planar::PalmPairError;
use thiserror::Error;

/// Why a planar estimate cannot be made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PlanarEstimateError {
    /// A palm has no contact: the object left it, and what two contacts tell ends there.
    #[error("palm {palm} has no contact at t = {t} s; estimate from the samples before it")]
    LostContact {
        /// 1 or 2.
        palm: usize,
        /// Time of the first such sample, s.
        t: f64,
    },
    /// The wedge is closed or flat.
    #[error("at t = {t} s: {source}")]
    Palms {
        /// Time of the sample, s.
        t: f64,
        /// Why.
        source: PalmPairError,
    },
    /// A chain of vector fields with more members than are kept track of.
    #[error("a chain of {found} fields: at most {most} are differentiated along")]
    ChainTooLong {
        /// Fields given.
        found: usize,
        /// Fields allowed.
        most: usize,
    },
    /// A formula of the authors' coordinates divides by something that is zero.
    #[error("{what} is {value}; the coordinates are singular there")]
    Singular {
        /// Which divisor.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The generic observer refuses.
    #[error(transparent)]
    Observer(#[from] ObserverError),
    /// A mass property or noise level is not a usable number.
    #[error("{what} is {value}; it must be {needed}")]
    Value {
        /// What the number is.
        what: &'static str,
        /// As given.
        value: f64,
        /// What it has to be.
        needed: &'static str,
    },
}
