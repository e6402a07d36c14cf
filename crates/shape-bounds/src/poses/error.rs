use super::BodyPose;
use contact_kinematics::Direction;
use exact_hull::IntersectionError;
use thiserror::Error;

/// Why poses above a plane give no bound.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PoseError {
    /// A pose that is not finite, or whose quaternion is not of unit length.
    #[error("run {run}, frame {frame}: pose {pose:?} above the plane at {plane_z} m is not finite and unit")]
    Pose {
        /// Which run.
        run: usize,
        /// Which frame of it.
        frame: usize,
        /// The pose.
        pose: BodyPose,
        /// Height of the plane.
        plane_z: f64,
    },
    /// A run too short to tell how rough the motion is.
    #[error("run {run} has {frames} frames; the roughness of a motion takes at least 3")]
    ShortRun {
        /// Which run.
        run: usize,
        /// Frames in it.
        frames: usize,
    },
    /// A confidence that is none.
    #[error("confidence {0}: it must lie between 0.5 and 1, both excluded")]
    Confidence(f64),
    /// A standard deviation of the plane's height that is none.
    #[error("standard deviation {0} m of the plane's height: it must be finite and at least zero")]
    Deviation(f64),
    /// A share or factor of a rule that is none.
    #[error(
        "the rule's `{name}` is {value}: shares and factors are finite, `trusted` is above 0 and at most 1, factors are above 0 and ordered"
    )]
    Rule {
        /// Which field.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The noise cannot be judged.
    #[error("{found} poses touch the plane, {needed} are needed to judge the noise; add runs")]
    TooFewTouching {
        /// Touching poses found.
        found: usize,
        /// Touching poses needed.
        needed: usize,
    },
    /// The poses leave some direction open.
    #[error("the poses leave {} directions open; add runs in which other sides face the plane", directions.len())]
    Open {
        /// Generators of the open directions.
        directions: Vec<Direction>,
    },
    /// The half-spaces have no intersection.
    #[error(transparent)]
    HalfSpaces(#[from] IntersectionError),
}
