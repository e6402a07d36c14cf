use super::PalmHinge;
use crate::ContactMode;
use crate::series::is_taken;
use contact_kinematics::{PalmSurface, SurfacePose};
use glam::DVec3;

/// What one palm recorded over a log: one entry a sample in every channel that it has.
#[derive(Clone, Debug, PartialEq)]
pub struct PalmRecord {
    /// Its shape.
    pub surface: PalmSurface,
    /// Coefficient of friction between it and the object, where it is known.
    pub friction: Option<f64>,
    /// Where it was, and how it moved.
    pub motion: RecordedMotion,
    /// Where it was touched.
    pub contacts: ContactPoints,
    /// Contact force on the object, N.
    pub force: ForceChannel,
    /// Its integral since a time that is one for the whole log, N s: exact through blows, which samples of the force miss.
    pub impulse: ForceChannel,
    /// Torque of its motor about the hinge, or about the palm's x axis where that is not known, N m: where and while it was
    /// measured.
    pub torque: Option<Vec<Option<f64>>>,
    /// What its motor turns it about, where that is known.
    pub hinge: Option<PalmHinge>,
    /// What a simulator knows of the contact. Never read by an estimator.
    pub truth: Option<Vec<TrueContact>>,
    /// Largest distance of a contact point from the palm's surface that is taken for noise, m; may be infinite.
    pub largest_offset: f64,
}

/// Where a palm was.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordedMotion {
    /// It did not move.
    Fixed(SurfacePose),
    /// Its pose at every sample; twists are taken from a spline through the poses.
    Poses(Vec<SurfacePose>),
    /// Pose and twist at every sample.
    Measured(Vec<MeasuredMotion>),
}

/// Pose and twist of a palm at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredMotion {
    /// Pose of its frame.
    pub pose: SurfacePose,
    /// Velocity of the frame's origin, m/s, world.
    pub v_WP: DVec3,
    /// Angular velocity, rad/s, world axes.
    pub w_WP: DVec3,
}

/// Where the twist of a logged palm comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TwistSource {
    /// It does not move: the twist is zero.
    Immobile,
    /// It was measured, or stated by what prescribed the motion.
    Stated,
    /// From a cubic spline through the poses, which makes their noise that of a derivative: the deviation of a pose,
    /// times `3 sqrt(2 / sqrt(3) - 1) = 1.18`, over the time between samples.
    FromPoses,
}

/// Where a palm was touched at every sample, m; none while it was not.
#[derive(Clone, Debug, PartialEq)]
pub enum ContactPoints {
    /// Points in the world.
    World(Vec<Option<DVec3>>),
    /// Points in the palm's frame.
    Palm(Vec<Option<DVec3>>),
}

/// How much of a force a sensor has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensedAxes {
    /// The part along the palm's normal.
    Normal,
    /// All of it.
    Three,
}

/// A force or its integral at every sample. A palm that is not touched exerts none.
#[derive(Clone, Debug, PartialEq)]
pub enum ForceChannel {
    /// It was not measured.
    Missing,
    /// Its part along the palm's normal, into the object.
    Normal(Vec<f64>),
    /// The vector on the object, world axes.
    Three(Vec<DVec3>),
}

/// What a simulator knows of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueContact {
    /// What the contact does.
    pub mode: ContactMode,
    /// Distance of object and palm, m, negative where they penetrate.
    pub gap: f64,
    /// Speed of the object over the palm's material, m/s.
    pub slip: f64,
}

impl MeasuredMotion {
    /// Velocity of the palm's material at the world point `c`, m/s: `V + W x (c - P)`.
    #[must_use]
    pub fn material_velocity(&self, c: DVec3) -> DVec3 {
        self.v_WP + self.w_WP.cross(c - self.pose.p_WP)
    }

    pub(super) fn at_rest(pose: SurfacePose) -> Self {
        Self { pose, v_WP: DVec3::ZERO, w_WP: DVec3::ZERO }
    }
}

impl ForceChannel {
    /// How much of the force there is.
    #[must_use]
    pub fn axes(&self) -> Option<SensedAxes> {
        match self {
            Self::Missing => None,
            Self::Normal(_) => Some(SensedAxes::Normal),
            Self::Three(_) => Some(SensedAxes::Three),
        }
    }

    pub(super) fn len(&self) -> Option<usize> {
        match self {
            Self::Missing => None,
            Self::Normal(values) => Some(values.len()),
            Self::Three(vectors) => Some(vectors.len()),
        }
    }

    /// Index of the first sample whose value is no reading, with the component at fault.
    pub(super) fn first_not_taken(&self) -> Option<(usize, f64)> {
        match self {
            Self::Missing => None,
            Self::Normal(values) => values.iter().copied().enumerate().find(|(_, value)| !is_taken(*value)),
            Self::Three(vectors) => vectors.iter().enumerate().find_map(|(k, v)| Some((k, not_taken(*v)?))),
        }
    }

    /// Along the normal `n` and as a vector on the object, at sample `k`.
    pub(super) fn at(&self, k: usize, n: Option<DVec3>) -> Option<DVec3> {
        match self {
            Self::Missing => None,
            Self::Normal(values) => Some(n.map_or(DVec3::ZERO, |n| values[k] * n)),
            Self::Three(vectors) => Some(vectors[k]),
        }
    }

    pub(super) fn bytes(&self) -> usize {
        match self {
            Self::Missing => 0,
            Self::Normal(_) => size_of::<f64>(),
            Self::Three(_) => size_of::<DVec3>(),
        }
    }
}

impl ContactPoints {
    pub(super) fn points(&self) -> &[Option<DVec3>] {
        match self {
            Self::World(points) | Self::Palm(points) => points,
        }
    }
}

/// The first component of `v` that is not finite.
pub(super) fn not_finite(v: DVec3) -> Option<f64> {
    v.to_array().into_iter().find(|c| !c.is_finite())
}

/// The first component of `v` that is no reading.
pub(super) fn not_taken(v: DVec3) -> Option<f64> {
    v.to_array().into_iter().find(|c| !is_taken(*c))
}
