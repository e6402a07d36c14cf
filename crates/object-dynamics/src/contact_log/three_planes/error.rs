use crate::LogError;
use contact_kinematics::PalmError;
use thiserror::Error;

/// Why a log is not one of three flat frictionless palms through one point, which the estimators of frictionless motion take.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotThreePlanes {
    /// Another number of palms.
    #[error("log has {found} palm(s), not three")]
    Count {
        /// How many.
        found: usize,
    },
    /// A palm that is not flat.
    #[error("palm {palm} is not flat but a {kind}")]
    Curved {
        /// Palm number from 1.
        palm: usize,
        /// Name of its kind.
        kind: &'static str,
    },
    /// The planes meet in a line, or in none.
    #[error("the palms' normals are parallel to one plane throughout the log: they meet in no single point")]
    NoPoint,
    /// The planes do not go through one point that rests.
    #[error(
        "palm {palm} passes the point in which the palms meet best at {distance:.1e} m (sample {sample}, t = {time} s; {limit:.1e} m \
         would be taken for rounding or noise)"
    )]
    Apart {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0 of the sample at which it is farthest.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// Distance in m.
        distance: f64,
        /// What rounding explains, or how well the poses were said to be known, m.
        limit: f64,
    },
    /// The tangential forces are more than noise.
    #[error(
        "friction is felt on palm {palm}: its tangential force is {ratio:.1e} of the normal force and agrees from sample to \
         sample ({deviations:.0} deviations of what noise does; if it is the palm's orientation that is off, give the normal \
         force alone)"
    )]
    Rubs {
        /// Number from 1 of the palm where the ratio is largest.
        palm: usize,
        /// `|f_t| / f_n` without its noise.
        ratio: f64,
        /// Over all palms, in standard deviations.
        deviations: f64,
    },
    /// Friction is stated, and no sensor shows how much of it there is.
    #[error("friction of palm {palm} is stated as {friction}, and its sensor has the normal force alone")]
    Friction {
        /// Palm number from 1.
        palm: usize,
        /// Coefficient of friction.
        friction: f64,
    },
    /// Of a palm's force the impulse alone is measured.
    #[error("palm {palm} measures the impulse of its force and not the force")]
    ImpulseAlone {
        /// Palm number from 1.
        palm: usize,
    },
    /// A palm has no frame.
    #[error("palm {palm} at sample {sample} (t = {time} s): {source}")]
    Frame {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// Why.
        source: PalmError,
    },
    /// The readings do not make a log.
    #[error(transparent)]
    Log(#[from] LogError),
}
