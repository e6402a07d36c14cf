//! Why a planar estimate cannot be made.

use crate::ObserverError;
use contact_kinematics::planar::PalmPairError;
use thiserror::Error;

/// Why a planar estimate cannot be made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum PlanarEstimateError {
    /// A palm has no contact: the object left it, and the equations of two contacts end there.
    #[error("palm {palm} has no contact at t = {t} s; estimate from the samples before it")]
    LostContact {
        /// 1 or 2.
        palm: usize,
        /// Time of the first such sample, s.
        t: f64,
    },
    /// Neither forces nor torques.
    #[error("sample at t = {t} s has neither forces nor torques; use the estimator that needs none")]
    NoForces {
        /// Time of the sample, s.
        t: f64,
    },
    /// A torque cannot be turned into a force so near the hinge.
    #[error(
        "contact on palm {palm} at t = {t} s is {distance} m from the hinge; a torque says nothing about the force there"
    )]
    NoLever {
        /// 1 or 2.
        palm: usize,
        /// Time of the sample, s.
        t: f64,
        /// Distance from the hinge, m.
        distance: f64,
    },
    /// Time does not increase.
    #[error("sample at t = {t} s does not come after t = {previous} s")]
    Time {
        /// Time of the sample, s.
        t: f64,
        /// Time of the sample before, s.
        previous: f64,
    },
    /// The wedge is closed or flat.
    #[error("at t = {t} s: {source}")]
    Palms {
        /// Time of the sample, s.
        t: f64,
        /// Why.
        source: PalmPairError,
    },
    /// A formula of the authors' coordinates divides by something that is zero.
    #[error("{what} is {value}; the coordinates are singular there")]
    Singular {
        /// Which divisor.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The number of states does not match the constants to be estimated.
    #[error("a model of {states} states takes {expected} constants, {found} were given")]
    Constants {
        /// Number of states.
        states: usize,
        /// Constants that it takes.
        expected: usize,
        /// Constants given.
        found: usize,
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
