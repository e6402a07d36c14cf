use crate::modes::FrictionError;
use crate::series::{MOST_READING, SeriesError};
use contact_kinematics::{PalmError, SurfaceError};
use glam::DVec3;
use thiserror::Error;

/// Why what palms recorded is not a log. Palms count from 1, samples from 0.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactLogError {
    /// Too few samples, out of order, or with truth of another length.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// A time is not a number.
    #[error("t of sample {sample} is {value}; it must be finite")]
    TimeNotFinite {
        /// Index from 0.
        sample: usize,
        /// As given.
        value: f64,
    },
    /// No palm, or too many.
    #[error("log has {found} palms; 1 to {} are possible", crate::MOST_PALMS)]
    PalmCount {
        /// How many.
        found: usize,
    },
    /// A palm's shape.
    #[error("palm {palm}: {source}")]
    Surface {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: SurfaceError,
    },
    /// A palm's friction.
    #[error("palm {palm}: {source}")]
    Friction {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: FrictionError,
    },
    /// A channel has another number of samples than there are times.
    #[error("{what} of palm {palm} has {found} samples where the log has {expected}")]
    ChannelLength {
        /// Which channel.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Times of the log.
        expected: usize,
        /// Samples of the channel.
        found: usize,
    },
    /// A pose is no pose.
    #[error("palm {palm} at sample {sample} (t = {time} s): {source}")]
    Pose {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// Why.
        source: SurfaceError,
    },
    /// The twist of a palm cannot be taken from its poses.
    #[error(
        "palm {palm}: its twist cannot be taken from {samples} poses; give it (V and W), or at least 4 samples"
    )]
    TwistFromPoses {
        /// Palm number from 1.
        palm: usize,
        /// How many poses there are.
        samples: usize,
    },
    /// A reading is NaN or infinite.
    #[error("{what} of palm {palm} at sample {sample} (t = {time} s) is {value}; it must be finite")]
    ReadingNotFinite {
        /// Which reading.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// As given.
        value: f64,
    },
    /// A reading is larger than any.
    #[error(
        "{what} of palm {palm} at sample {sample} (t = {time} s) is {value:.3e}; {MOST_READING:e} is the most that is taken; check its unit"
    )]
    TooLarge {
        /// Which reading.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// As given.
        value: f64,
    },
    /// A palm is said to move faster than any.
    #[error(
        "{what} of palm {palm} at sample {sample} (t = {time} s) is {value:.3e}; {most:.0} is the most that is taken; check its unit"
    )]
    TooFast {
        /// Which velocity, with its unit.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// As given.
        value: f64,
        /// Largest accepted.
        most: f64,
    },
    /// What a palm's twists say is not what its poses show.
    #[error(
        "the {what} of palm {palm} contradicts its poses: from the first sample to sample {sample} (t = {time} s) it adds up to \
         {stated:.2e}, the poses move by {posed:.2e}, and these are {distance:.2e} apart; check its unit, its sign, its axes (the \
         world's) and the times, or leave out the columns of V and W, which then come from the poses"
    )]
    TwistAgainstPoses {
        /// Which velocity, with its unit.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Index from 0 of the sample up to which both are farthest apart.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// Way of the poses until then, m or rad.
        posed: f64,
        /// Integral of the velocity.
        stated: f64,
        /// How far apart the two end.
        distance: f64,
    },
    /// A palm's impulses are not those of its forces.
    #[error(
        "the impulses (J) of palm {palm} contradict its forces (f): from sample to sample they are {} N s in the median, and the \
         integral of the forces is {} N s (in the palm's axes, or along z the part along its normal); check that both are \
         columns of this palm, their units (N s and N) and their signs, or leave out the columns that are wrong",
        in_words(*impulse), in_words(*integral)
    )]
    ImpulseAgainstForce {
        /// Palm number from 1.
        palm: usize,
        /// Median from sample to sample, N s, palm axes.
        impulse: DVec3,
        /// Median of the integral of the forces, N s, palm axes.
        integral: DVec3,
    },
    /// The torque of a palm's motor is not that of its forces.
    #[error(
        "the torque (tau) of palm {palm} contradicts its forces (f): less what turns the palm itself it is {torque:.3e} N m in \
         the median, and the forces have a moment of {moment:.3e} N m about the hinge; check that both are columns of this \
         palm, their units and signs, and pivot, axis and inertia of its motor, or leave out the columns that are wrong"
    )]
    TorqueAgainstForce {
        /// Palm number from 1.
        palm: usize,
        /// Median of what the torque leaves beside turning the palm, N m.
        torque: f64,
        /// Median of the moment of the palm's force on the object about the hinge, N m.
        moment: f64,
    },
    /// A contact point is not on its palm.
    #[error(
        "contact of palm {palm} at sample {sample} (t = {time} s) is {distance} m off the palm's surface, and {limit} m is \
         the most that was said to be noise; check the palm's shape, its pose and the units"
    )]
    OffPalm {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// Along the normal, m, positive on the object's side.
        distance: f64,
        /// Largest accepted, m.
        limit: f64,
    },
    /// A contact point lies where the palm has no normal.
    #[error(
        "contact of palm {palm} at sample {sample} (t = {time} s) lies in the palm's centre or on its axis, where no point \
         of its surface is nearest; check the palm's shape and its pose"
    )]
    NoNormal {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
    },
    /// A contact force pulls.
    #[error(
        "force of palm {palm} at sample {sample} (t = {time} s) pulls with {value} N along the normal; a palm cannot pull: \
         check the sign of its force, its axes (the world's), and that the columns are those of this palm"
    )]
    Pull {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// Along the normal into the object, N.
        value: f64,
    },
    /// A reading of one sample is missing where others have it.
    #[error(
        "{what} of palm {palm} is missing at sample {sample} (t = {time} s) and there at others; it must be there at every \
         sample, or at none"
    )]
    Missing {
        /// Which reading.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
    },
    /// A number of a palm's hinge.
    #[error("{what} of the hinge of palm {palm} is {value}; it must be {must}")]
    Hinge {
        /// Palm number from 1.
        palm: usize,
        /// Which number.
        what: &'static str,
        /// As given, m or kg m^2.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// A force is asked for that no motor tells.
    #[error(
        "palm {palm} has no {what}, so that its force does not follow from the torque of its motor; {mend}"
    )]
    NoMotor {
        /// Palm number from 1.
        palm: usize,
        /// What is missing.
        what: &'static str,
        /// What to do about it.
        mend: &'static str,
    },
    /// A palm of a log of three planes has no frame.
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
}

impl ContactLogError {
    /// Index from 0 of the sample at fault, where one is.
    #[must_use]
    pub fn sample(&self) -> Option<usize> {
        match *self {
            Self::Series(series) => series.sample(),
            Self::TimeNotFinite { sample, .. }
            | Self::Pose { sample, .. }
            | Self::ReadingNotFinite { sample, .. }
            | Self::TooLarge { sample, .. }
            | Self::TooFast { sample, .. }
            | Self::TwistAgainstPoses { sample, .. }
            | Self::OffPalm { sample, .. }
            | Self::NoNormal { sample, .. }
            | Self::Pull { sample, .. }
            | Self::Missing { sample, .. }
            | Self::Frame { sample, .. } => Some(sample),
            Self::PalmCount { .. }
            | Self::Surface { .. }
            | Self::Friction { .. }
            | Self::ChannelLength { .. }
            | Self::TwistFromPoses { .. }
            | Self::ImpulseAgainstForce { .. }
            | Self::TorqueAgainstForce { .. }
            | Self::Hinge { .. }
            | Self::NoMotor { .. } => None,
        }
    }
}

fn in_words(v: DVec3) -> String {
    format!("({:.3e}, {:.3e}, {:.3e})", v.x, v.y, v.z)
}
