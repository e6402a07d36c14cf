//! How far one configuration of palms is from another.
//!
//! A configuration is the poses of the palms in the frame of the body. The distance of two poses is
//! `d = sqrt(|p - p'|^2 + l^2 theta^2)` with the angle `theta = 2 arccos |q . q'|` of the rotation between them, and a length `l` that
//! turns angles into ways: half the mean width of the body, plus the clearance at which palms are led around it, fixed from the start.
//! `theta` is twice the great-circle distance of the pairs `{q, -q}`, so it is a metric; the norm of two metrics is one, and so are
//! the maximum and the sum over the palms. Sums of squares are none, nor is anything that tells `q` from `-q`.

use contact_kinematics::Direction;
use glam::{DQuat, DVec3};
use thiserror::Error;

/// Where a palm is, in the frame of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmPose {
    /// Turns axes of the palm into those of the body.
    pub R_OP: DQuat,
    /// The palm's point of reference, say the centre of its pad, in m.
    pub p_OP: DVec3,
}

/// How the ways of several palms make one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Together {
    /// They move at once: the longest way.
    AtOnce,
    /// They move one after another: the sum.
    OneByOne,
}

/// Limits of speed of a palm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// In m/s.
    pub linear: f64,
    /// In rad/s.
    pub angular: f64,
}

/// Why two configurations have no distance.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MetricError {
    /// Different numbers of palms.
    #[error("configurations of {from} and {to} palms: their numbers must be the same")]
    Palms {
        /// In the first.
        from: usize,
        /// In the second.
        to: usize,
    },
    /// A length or a speed that is none.
    #[error("{what} is {value}; it must be positive and finite")]
    Scale {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// A pose that is none.
    #[error("palm {palm}: its pose is not finite, or its quaternion is zero")]
    Pose {
        /// Which palm, from 0.
        palm: usize,
    },
}

/// Angle of the rotation from one orientation to another in rad, in [0, pi]: the same for `q` and `-q`.
///
/// By the arc tangent of both parts of the quaternion between them: exact for small angles, where the cosine is flat.
#[must_use]
pub fn rotation_angle(from: DQuat, to: DQuat) -> f64 {
    let between = from.conjugate() * to;
    2.0 * between.xyz().length().atan2(between.w.abs())
}

/// Distance of two configurations in m, with the length `l` (m) that turns an angle into a way.
///
/// # Errors
/// [`MetricError`].
pub fn distance(from: &[PalmPose], to: &[PalmPose], l: f64, together: Together) -> Result<f64, MetricError> {
    check_scale("the length of the metric", l)?;
    let one = |a: &PalmPose, b: &PalmPose| a.p_OP.distance(b.p_OP).hypot(l * rotation_angle(a.R_OP, b.R_OP));
    combined(from, to, together, one)
}

/// Least duration in s of the way from one configuration to another under limits of speed: what the metric means to a robot.
///
/// # Errors
/// [`MetricError`].
pub fn duration(
    from: &[PalmPose],
    to: &[PalmPose],
    speeds: Speeds,
    together: Together,
) -> Result<f64, MetricError> {
    check_scale("the linear speed", speeds.linear)?;
    check_scale("the angular speed", speeds.angular)?;
    let one = |a: &PalmPose, b: &PalmPose| {
        let turning = rotation_angle(a.R_OP, b.R_OP) / speeds.angular;
        (a.p_OP.distance(b.p_OP) / speeds.linear).max(turning)
    };
    combined(from, to, together, one)
}

/// As [`distance`] where no palm is told from any other: the least over all ways to pair them.
///
/// # Errors
/// [`MetricError`].
pub fn distance_of_equal_palms(
    from: &[PalmPose],
    to: &[PalmPose],
    l: f64,
    together: Together,
) -> Result<f64, MetricError> {
    let mut order: Vec<PalmPose> = to.to_vec();
    let mut least = distance(from, &order, l, together)?;
    // Heap's algorithm (1963): each ordering once, by one exchange.
    let mut counters = vec![0; order.len()];
    let mut k = 0;
    while k < order.len() {
        if counters[k] < k {
            order.swap(if k % 2 == 0 { 0 } else { counters[k] }, k);
            least = least.min(distance(from, &order, l, together)?);
            counters[k] += 1;
            k = 0;
        } else {
            counters[k] = 0;
            k += 1;
        }
    }
    Ok(least)
}

/// Distance in m of two touches by a palm that looks the same however it is turned about its own axis, which passes through its
/// point of reference: the least over all such turns leaves the angle between the axes.
///
/// # Errors
/// [`MetricError::Scale`].
pub fn distance_of_touches(
    from: (DVec3, Direction),
    to: (DVec3, Direction),
    l: f64,
) -> Result<f64, MetricError> {
    check_scale("the length of the metric", l)?;
    Ok(from.0.distance(to.0).hypot(l * crate::Heading::angle_to(from.1, to.1)))
}

fn check_scale(what: &'static str, value: f64) -> Result<(), MetricError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(MetricError::Scale { what, value }) }
}

fn combined(
    from: &[PalmPose],
    to: &[PalmPose],
    together: Together,
    one: impl Fn(&PalmPose, &PalmPose) -> f64,
) -> Result<f64, MetricError> {
    if from.len() != to.len() {
        return Err(MetricError::Palms { from: from.len(), to: to.len() });
    }
    let is_none = |p: &PalmPose| !(p.p_OP.is_finite() && p.R_OP.is_finite() && p.R_OP.length_squared() > 0.0);
    for poses in [from, to] {
        if let Some(palm) = poses.iter().position(is_none) {
            return Err(MetricError::Pose { palm });
        }
    }
    let ways = from.iter().zip(to).map(|(a, b)| one(a, b));
    Ok(match together {
        Together::AtOnce => ways.fold(0.0, f64::max),
        Together::OneByOne => ways.sum(),
    })
}

#[cfg(test)]
mod tests;
