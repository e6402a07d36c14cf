//! Why a quasistatic reconstruction cannot be made.

use contact_kinematics::planar::PalmPairError;
use thiserror::Error;

/// Why a quasistatic reconstruction cannot be made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum QuasistaticError {
    /// Fewer than four samples.
    #[error("{found} sample(s) given, at least 4 are needed")]
    TooFewSamples {
        /// How many there are.
        found: usize,
    },
    /// A palm has no contact.
    #[error("palm {palm} has no contact at sample {sample}")]
    LostContact {
        /// 1 or 2.
        palm: usize,
        /// Index from 0.
        sample: usize,
    },
    /// The wedge is closed or flat.
    #[error("sample {sample}: {source}")]
    Palms {
        /// Index from 0.
        sample: usize,
        /// Why.
        source: PalmPairError,
    },
    /// The centre of mass is where the lines of force meet, as in a centred disc: the orientation cannot be seen.
    #[error(
        "at sample {sample} the centre of mass is {lever:.3e} m from where the lines of force meet; the turn of the object cannot be seen there"
    )]
    NoLever {
        /// Index from 0.
        sample: usize,
        /// Lever in m.
        lever: f64,
    },
    /// The palms do not come back to where they started.
    #[error("palms end {distance:.3e} rad from where they started; closure needs a loop")]
    NoLoop {
        /// Distance in rad.
        distance: f64,
    },
    /// The loop does not say where the centre of mass is.
    #[error(
        "closure changes from {low:.3e} to {high:.3e} rad over the bracket; give another bracket or a loop on which the angle between the palms changes"
    )]
    NoClosure {
        /// Closure at the lower height, rad.
        low: f64,
        /// Closure at the upper height, rad.
        high: f64,
    },
}
