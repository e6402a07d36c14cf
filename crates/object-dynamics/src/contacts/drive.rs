use contact_kinematics::{Direction, MotionLaw, SurfaceError, SurfaceMotion, SurfacePose};
use glam::{DMat3, DVec3};
use thiserror::Error;

/// What moves a palm.
#[derive(Clone, Debug, PartialEq)]
pub enum PalmDrive {
    /// A motion that the object cannot change; immobile palms are those whose motion is constant.
    Prescribed(SurfaceMotion),
    /// Springs and dampers between the palm and a prescribed motion, which gives way in translation alone.
    Spring(PalmSpring),
    /// A motor's torque on a hinged palm (paper, (29), (34) and (37)).
    Torque(PalmTorque),
}

/// A palm on springs: `m p'' = -K (p - p_c) - C (p' - p_c') - f`, with the orientation of the command.
///
/// No weight acts on it: its springs are taken to carry that already.
#[derive(Clone, Debug, PartialEq)]
pub struct PalmSpring {
    /// Where the palm stands without load: `p_c` and its orientation.
    pub command: SurfaceMotion,
    /// `K`, N/m, world axes, symmetric and positive definite.
    pub stiffness: DMat3,
    /// `C`, N s/m, world axes, symmetric, not negative.
    pub damping: DMat3,
    /// `m` in kg, above zero.
    pub mass: f64,
}

/// A palm on a hinge, turned by a motor: `I angle'' = torque - moment of the contact force about the axis`.
///
/// No weight acts on it: its motor is taken to be balanced, as in the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmTorque {
    /// The palm at angle zero.
    pub pose: SurfacePose,
    /// A point of the axis, world, m.
    pub pivot: DVec3,
    /// Direction of the axis, world.
    pub axis: Direction,
    /// Moment of inertia about the axis, kg m^2, above zero.
    pub inertia: f64,
    /// Torque over time in N m: the law's value.
    pub torque: MotionLaw,
    /// Angle at `t = 0`, rad.
    pub angle: f64,
    /// Its rate at `t = 0`, rad/s.
    pub rate: f64,
}

/// Why the drive of a palm cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DriveError {
    /// Its motion or pose.
    #[error(transparent)]
    Motion(#[from] SurfaceError),
    /// A matrix of a spring is not what it must be.
    #[error(
        "{what} matrix of the palm's spring is {problem}; stiffness must be symmetric and positive definite, damping \
         symmetric and not negative"
    )]
    Spring {
        /// `stiffness` or `damping`.
        what: &'static str,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// A number that must be positive is not.
    #[error("{what} of the palm is {value}; it must be positive and finite")]
    NotPositive {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
}

impl PalmDrive {
    /// Checks every number.
    ///
    /// # Errors
    /// [`DriveError`].
    pub fn check(&self) -> Result<(), DriveError> {
        match self {
            Self::Prescribed(motion) => Ok(motion.check()?),
            Self::Spring(spring) => {
                spring.command.check()?;
                check_matrix("stiffness", spring.stiffness, true)?;
                check_matrix("damping", spring.damping, false)?;
                positive("mass", spring.mass)
            }
            Self::Torque(drive) => {
                SurfacePose::new(drive.pose.p_WP, drive.pose.R_WP)?;
                let numbers = [("angle", drive.angle), ("rate", drive.rate)];
                let bad = numbers.into_iter().find(|(_, v)| !v.is_finite()).or(drive.torque.first_bad());
                if let Some((what, value)) = bad {
                    return Err(SurfaceError::Parameter { what, value }.into());
                }
                if !drive.pivot.is_finite() {
                    let value = drive.pivot.to_array();
                    return Err(SurfaceError::PoseNotFinite { what: "pivot", value }.into());
                }
                positive("moment of inertia", drive.inertia)
            }
        }
    }

    /// How fast what is prescribed of it changes about the time `t`, rad/s; see [`SurfaceMotion::quickness`].
    #[must_use]
    pub fn quickness(&self, t: f64) -> f64 {
        match self {
            Self::Prescribed(motion) => motion.quickness(t),
            Self::Spring(spring) => spring.command.quickness(t),
            Self::Torque(drive) => drive.torque.quickness(t),
        }
    }

    /// Times at which its motion is less smooth than elsewhere.
    #[must_use]
    pub fn joints(&self) -> Vec<f64> {
        match self {
            Self::Prescribed(motion) => motion.joints(),
            Self::Spring(spring) => spring.command.joints(),
            Self::Torque(drive) => drive.torque.joints().into_iter().flatten().collect(),
        }
    }

    /// Whether the object cannot change its motion.
    #[must_use]
    pub fn is_prescribed(&self) -> bool {
        matches!(self, Self::Prescribed(_))
    }
}

fn positive(what: &'static str, value: f64) -> Result<(), DriveError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(DriveError::NotPositive { what, value }) }
}

/// Symmetric to rounding, and positive: by the signs of the leading minors (definite) or of all principal minors.
fn check_matrix(what: &'static str, m: DMat3, definite: bool) -> Result<(), DriveError> {
    let wrong = |problem| Err(DriveError::Spring { what, problem });
    if !m.is_finite() {
        return wrong("not finite");
    }
    let size = m.to_cols_array().iter().fold(0.0_f64, |s, v| s.max(v.abs()));
    let [a, b, c] = [m.x_axis, m.y_axis, m.z_axis];
    if (a.y - b.x).abs().max((a.z - c.x).abs()).max((b.z - c.y).abs()) > 1e-9 * size {
        return wrong("not symmetric");
    }
    let pairs = [a.x * b.y - a.y * b.x, a.x * c.z - a.z * c.x, b.y * c.z - b.z * c.y];
    let (slack, zero) = (1e-12 * size, size == 0.0);
    let positive = a.x > 0.0 && pairs[0] > 0.0 && m.determinant() > 0.0;
    let not_negative = [a.x, b.y, c.z].iter().all(|v| *v >= -slack)
        && pairs.iter().all(|v| *v >= -slack * size)
        && m.determinant() >= -slack * size * size;
    match (definite, positive, zero || not_negative) {
        (true, true, _) | (false, _, true) => Ok(()),
        (true, false, _) if zero => wrong("zero"),
        _ => wrong("not positive"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn bad_drives_are_named() {
        let pose = SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).unwrap();
        let good = PalmSpring {
            command: SurfaceMotion::immobile(pose),
            stiffness: DMat3::from_diagonal(DVec3::new(100.0, 200.0, 10.0)),
            damping: DMat3::ZERO,
            mass: 0.1,
        };
        assert!(PalmDrive::Spring(good.clone()).check().is_ok());
        let without = PalmSpring { stiffness: DMat3::ZERO, ..good.clone() };
        let problem = PalmDrive::Spring(without).check();
        assert!(
            matches!(problem, Err(DriveError::Spring { what: "stiffness", problem: "zero" })),
            "{problem:?}"
        );
        let soft = PalmSpring { stiffness: DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)), ..good.clone() };
        assert!(PalmDrive::Spring(soft).check().is_err());
        let negative =
            PalmSpring { damping: DMat3::from_diagonal(DVec3::new(0.0, -1.0, 0.0)), ..good.clone() };
        assert!(PalmDrive::Spring(negative).check().is_err());
        let light = PalmDrive::Spring(PalmSpring { mass: 0.0, ..good }).check();
        assert!(matches!(light, Err(DriveError::NotPositive { what: "mass", .. })));
    }
}
