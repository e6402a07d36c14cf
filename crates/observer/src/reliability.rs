//! Whether to believe an estimate, and why not.
//!
//! ```
//! use observer::reliability::{Reason, Reliability};
//!
//! let told = Reliability::Unreliable(vec![Reason::TooShort { duration: 0.2, needed: 0.5 }]);
//! match told {
//!     Reliability::Reliable => println!("off by its deviations"),
//!     Reliability::Unreliable(reasons) => {
//!         assert!(reasons[0].to_string().starts_with("0.20 s are too short"));
//!     }
//! }
//! ```

use crate::faults::Suspect;
use std::fmt;

/// A row known to worse than this share of the natural sizes is not to be relied on: the linearisation that its covariance comes from does not
/// reach that far. An error of five deviations without another warning was seen at 0.24 (two palms 30 degrees apart), none below 0.2.
pub(crate) const LARGEST_DEVIATION: f64 = 0.15;
/// Chi-squared over its degrees of freedom beyond which noise does not explain an estimate. With hundreds of degrees it
/// scatters by a few percent about 0.85 to 1; noise levels that are read off the data are good to 5 %.
pub(crate) const LARGEST_MISFIT: f64 = 1.4;

/// Whether to believe an estimate.
#[derive(Clone, Debug, PartialEq)]
pub enum Reliability {
    /// Its covariance tells how far.
    Reliable,
    /// It may be wrong by more than its numbers say.
    Unreliable(Vec<Reason>),
}

/// Why not to believe an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The fit did not settle.
    NotConverged {
        /// Linearisations used.
        iterations: usize,
    },
    /// Contacts and forces had to be corrected by more than their noise.
    Inconsistent {
        /// Chi-squared over its degrees of freedom; about 1 when all is as stated.
        misfit: f64,
    },
    /// Something that was taken as known of the sensors is not so.
    Fault(Suspect),
    /// Mass and moments of inertia that were stated contradict those that the log has without them.
    OtherBody {
        /// What the mass of the log is of the stated one.
        mass: f64,
        /// How many of its deviations that is off.
        deviations: f64,
        /// Squared departure of mass and moments in their covariance, four degrees of freedom.
        squares: f64,
    },
    /// The body hardly turns: where its centre of mass is, and its inertia, follow from how the spin changes.
    Still {
        /// Largest change of the angular velocity from its mean, in its deviations.
        deviations: f64,
    },
    /// Without the stated mass and inertia the search leads to no motion, so that nothing confirms the one that was found with them.
    Unconfirmed,
    /// Another motion explains the log as well.
    Ambiguous {
        /// How far it is from this one, in deviations of the velocities or positions.
        apart: f64,
    },
    /// The log is not exact, and short beside the time in which the body falls its own length.
    TooShort {
        /// Length of the log, s.
        duration: f64,
        /// Length that is needed, s.
        needed: f64,
    },
    /// Samples are far apart beside the time in which the body falls its own length: what forces do in between is not known.
    TooSparse {
        /// Median of the time from sample to sample, s.
        spacing: f64,
        /// Largest that serves, s.
        most: f64,
    },
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotConverged { iterations } => {
                write!(f, "the fit did not settle in {iterations} iterations")
            }
            Self::Fault(suspect) => {
                let of = if suspect.fault.is_of_body() { "body" } else { "sensors" };
                write!(
                    f,
                    "the data speak for a wrong constant of the {of}, most of all for this one: {suspect}"
                )
            }
            Self::OtherBody { mass, deviations, squares } => write!(
                f,
                "the stated mass and inertia are not those of this object: without them the mass comes out {mass:.4} times as large, which is \
                 {deviations:.1} deviations off, and mass and moments together depart by {squares:.0} squared deviations, where chance makes \
                 a few: state others, or none"
            ),
            Self::Inconsistent { misfit } => write!(
                f,
                "contacts and forces had to be corrected by {:.2} times their noise: a wrong motion, a wrong constant of \
                 body or sensors (a force gain, say), or more noise than was stated",
                misfit.sqrt()
            ),
            Self::Still { deviations } => write!(
                f,
                "the body hardly turns: its angular velocity changes by {deviations:.1} of its deviations at most, and where its centre of mass is \
                 follows from such changes"
            ),
            Self::Ambiguous { apart } => write!(
                f,
                "another motion explains the log as well, {apart:.0} deviations away: the readings change too little to tell which"
            ),
            Self::Unconfirmed => write!(
                f,
                "without the stated mass and inertia the search leads to no motion that explains the log, so that nothing confirms this one"
            ),
            Self::TooShort { duration, needed } => write!(
                f,
                "{duration:.2} s are too short for a body of this size and data that are not exact: at least {needed:.2} s are needed"
            ),
            Self::TooSparse { spacing, most } => write!(
                f,
                "samples {spacing:.3} s apart are too far apart for a body of this size: what forces do in between is known up to {most:.3} s"
            ),
        }
    }
}

impl Reliability {
    /// One more reason.
    pub(crate) fn add(&mut self, reason: Reason) {
        match self {
            Self::Reliable => *self = Self::Unreliable(vec![reason]),
            Self::Unreliable(reasons) => reasons.push(reason),
        }
    }

    /// Whether the estimate may be believed to within its covariance.
    #[must_use]
    pub fn is_reliable(&self) -> bool {
        *self == Self::Reliable
    }
}
