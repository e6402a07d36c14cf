use super::{PoseTable, SurfaceError, SurfacePose, SurfaceState};
use crate::{Direction, MotionLaw};
use glam::DVec3;

/// A prescribed rigid motion of a palm.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceMotion {
    /// A pose, moved by parts one after the other.
    Parts {
        /// The pose before any of them.
        pose: SurfacePose,
        /// Each moves what the ones before it have made, about axes fixed in the world; none: the palm is immobile.
        parts: Vec<MotionPart>,
    },
    /// Poses at given times with a smooth curve through them.
    Table(PoseTable),
}

/// One shift or turn with world-fixed axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionPart {
    /// Along `direction` by the law's value in m.
    Shift {
        /// Unit vector.
        direction: Direction,
        /// Distance in m over time.
        law: MotionLaw,
    },
    /// About the axis through `pivot` by the law's value in rad.
    Turn {
        /// A point of the axis, m.
        pivot: DVec3,
        /// Unit vector.
        axis: Direction,
        /// Angle in rad over time.
        law: MotionLaw,
    },
}

impl SurfaceMotion {
    /// A palm that does not move.
    #[must_use]
    pub fn immobile(pose: SurfacePose) -> Self {
        Self::Parts { pose, parts: Vec::new() }
    }

    /// Whether the palm never moves.
    #[must_use]
    pub fn is_immobile(&self) -> bool {
        matches!(self, Self::Parts { parts, .. } if parts.iter().all(|part| part.law().is_constant()))
    }

    /// Checks every parameter.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`], [`SurfaceError::PoseNotFinite`].
    pub fn check(&self) -> Result<(), SurfaceError> {
        let Self::Parts { parts, .. } = self else { return Ok(()) };
        for part in parts {
            if let Some((what, value)) = part.law().first_bad() {
                return Err(SurfaceError::Parameter { what, value });
            }
            if let MotionPart::Turn { pivot, .. } = part
                && !pivot.is_finite()
            {
                return Err(SurfaceError::PoseNotFinite { what: "pivot", value: pivot.to_array() });
            }
        }
        Ok(())
    }

    /// Pose, velocity and acceleration at time `t` in s.
    #[must_use]
    pub fn at(&self, t: f64) -> SurfaceState {
        match self {
            Self::Parts { pose, parts } => {
                parts.iter().fold(pose.at_rest(), |state, part| part.moved(&state, t))
            }
            Self::Table(table) => table.at(t),
        }
    }

    /// How fast directions of the palm and its own motion change about the time `t` at most, rad/s: over a time that is short against the
    /// inverse, and has no joint, every distance to the palm is nearly a polynomial of low degree.
    #[must_use]
    pub fn quickness(&self, t: f64) -> f64 {
        let of_part = |part: &MotionPart| match part {
            MotionPart::Shift { law, .. } => law.quickness(t),
            MotionPart::Turn { law, .. } => law.quickness_of_turn(t),
        };
        match self {
            Self::Parts { parts, .. } => parts.iter().map(of_part).sum(),
            Self::Table(table) => table.at(t).w_WP.length(),
        }
    }

    /// Times at which the motion is less smooth than elsewhere, ascending: an integrator of high order stops there.
    #[must_use]
    pub fn joints(&self) -> Vec<f64> {
        match self {
            Self::Parts { parts, .. } => {
                let mut joints: Vec<f64> = parts.iter().filter_map(|p| p.law().joints()).flatten().collect();
                joints.sort_by(f64::total_cmp);
                joints
            }
            Self::Table(table) => table.times().to_vec(),
        }
    }
}

impl MotionPart {
    fn law(&self) -> &MotionLaw {
        match self {
            Self::Shift { law, .. } | Self::Turn { law, .. } => law,
        }
    }

    /// The state `of` a frame after this part has moved it.
    fn moved(&self, of: &SurfaceState, t: f64) -> SurfaceState {
        let [value, rate, acceleration] = self.law().at(t);
        match *self {
            Self::Shift { direction, .. } => {
                let d = direction.get();
                SurfaceState {
                    p_WP: of.p_WP + value * d,
                    v_WP: of.v_WP + rate * d,
                    a_WP: of.a_WP + acceleration * d,
                    ..*of
                }
            }
            Self::Turn { pivot, axis, .. } => of.turned(pivot, axis, [value, rate, acceleration]),
        }
    }
}
