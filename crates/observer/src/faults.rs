//! What may be wrong with sensors and with a stated body, and what data say of it.
//!
//! ```
//! use observer::faults::{Constant, Suspect};
//!
//! // The second palm seems to say 4 % too little, and more than 1 % would turn the motion.
//! let fault = Constant::ForceGain { palm: 2 };
//! let suspect = Suspect { fault, value: 0.04, deviation: 0.005, tolerated: 0.01 };
//! assert_eq!(suspect.score(), 8.0); // deviations: not by chance
//! assert!(suspect.untold() > 1.0); // a gain that goes unseen may be off by more than the motion bears
//! assert!(suspect.to_string().starts_with("gain of the forces of palm 2 less 1, which comes out as 4.00e-2"));
//! ```

use std::fmt;

/// Deviations from which on a two-sided test at one in a hundred (2.576 of them) tells nine times in ten (1.282 more).
const TOLD: f64 = 3.858;

/// A constant that was taken as known: of the sensors, or of a stated body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constant {
    /// Share by which the forces of a palm are more than it says.
    ForceGain {
        /// Number from 1.
        palm: usize,
    },
    /// Force along the normal that a palm has beside what it says, N.
    ForceBias {
        /// Number from 1.
        palm: usize,
    },
    /// Time by which all forces come late, s.
    ForceDelay,
    /// Time by which all contacts come late, s. Tested of flat palms in the plane.
    ContactDelay,
    /// How far contacts are from where a palm says, along one of its axes, m.
    ContactOffset {
        /// Number from 1.
        palm: usize,
        /// Axis of the palm: 0 for x, 1 for y.
        axis: usize,
    },
    /// How far a palm is turned about one of its axes through the origin of its frame, rad.
    PalmTilt {
        /// Number from 1.
        palm: usize,
        /// Axis of the palm: 0 for x, 1 for y.
        axis: usize,
    },
    /// Friction of all palms that are taken for frictionless.
    Friction,
    /// Share by which the mass is more than stated, the inertia as it is.
    Mass,
    /// Share by which a principal moment of inertia is more than stated, the others as they are. In the plane the one about its normal is the largest.
    Moment {
        /// Its place: 0 for the smallest, 2 for the largest.
        axis: usize,
    },
}

impl Constant {
    /// Whether it is one of a stated body.
    #[must_use]
    pub fn is_of_body(self) -> bool {
        matches!(self, Self::Mass | Self::Moment { .. })
    }
}

/// What the data say of one such constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suspect {
    /// The constant.
    pub fault: Constant,
    /// What it is beside what it was taken for, to first order.
    pub value: f64,
    /// Standard deviation of that: infinite where the data cannot tell.
    pub deviation: f64,
    /// What it may be off by until some number of the motion is off by one of its deviations.
    pub tolerated: f64,
}

impl Suspect {
    /// The value in its deviations: a standard normal number where nothing is wrong.
    #[must_use]
    pub fn score(&self) -> f64 {
        if self.deviation.is_finite() { self.value / self.deviation } else { 0.0 }
    }

    /// What it must be off by for a score test at one false alarm in a hundred to tell it nine times in ten; infinite where the data cannot.
    #[must_use]
    pub fn told_from(&self) -> f64 {
        TOLD * self.deviation
    }

    /// By how many of its deviations a number of the motion may be off through what is not told of this constant.
    #[must_use]
    pub fn untold(&self) -> f64 {
        self.told_from() / self.tolerated
    }
}

/// What was taken as known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Assumption {
    /// Nothing is wrong.
    None,
    /// One constant.
    One(Constant),
    /// Mass and inertia of the body.
    Body,
    /// How noisy the readings are.
    Noise,
}

/// That one of them is wrong, and how probable that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explanation {
    /// What would be wrong.
    pub assumption: Assumption,
    /// By how much: a constant in its unit, factors of the mass or of the noise less 1.
    pub value: f64,
    /// Standard deviation of that.
    pub deviation: f64,
    /// Chi-squared over the number of conditions that it leaves.
    pub misfit: f64,
    /// Natural logarithm of the odds against that nothing is wrong, all being as probable beforehand.
    pub log_odds: f64,
}

impl fmt::Display for Assumption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => write!(f, "nothing is wrong"),
            Self::One(fault) => write!(f, "{fault}"),
            Self::Body => write!(f, "mass and inertia; factor of the mass less 1"),
            Self::Noise => write!(f, "noise of all readings (or a wrong motion), its factor less 1"),
        }
    }
}

impl fmt::Display for Constant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |axis: usize| ["x", "y"][axis.min(1)];
        match *self {
            Self::ForceGain { palm } => write!(f, "gain of the forces of palm {palm} less 1"),
            Self::ForceBias { palm } => write!(f, "bias of the forces of palm {palm} (N)"),
            Self::ForceDelay => write!(f, "delay of the forces (s)"),
            Self::ContactDelay => write!(f, "delay of the contacts (s)"),
            Self::ContactOffset { palm, axis } => {
                write!(f, "offset of the contacts of palm {palm} along its {} axis (m)", name(axis))
            }
            Self::PalmTilt { palm, axis } => {
                write!(f, "tilt of palm {palm} about its {} axis (rad)", name(axis))
            }
            Self::Friction => write!(f, "coefficient of friction"),
            Self::Mass => write!(f, "mass over the stated one, less 1"),
            Self::Moment { axis } => {
                let which = ["smallest", "middle", "largest"][axis.min(2)];
                write!(f, "{which} moment of inertia over the stated one, less 1")
            }
        }
    }
}

impl fmt::Display for Suspect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { fault, value, deviation, .. } = self;
        write!(
            f,
            "{fault}, which comes out as {value:.2e} +- {deviation:.1e}, {:.1} deviations off",
            self.score().abs()
        )
    }
}
