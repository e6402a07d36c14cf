use super::{SurfaceError, SurfacePose, SurfaceState};
use crate::MotionLaw;
use glam::DVec2;

/// A prescribed rigid motion of a palm: a pose, moved by parts one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMotion {
    /// The pose before any of them.
    pub pose: SurfacePose,
    /// Each moves what the ones before it have made, along axes fixed in the world; none: the palm is immobile.
    pub parts: Vec<MotionPart>,
}

/// One shift or turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionPart {
    /// By the law's value in m.
    Shift {
        /// Angle of the direction of the shift against world X, rad.
        direction: f64,
        /// Distance in m over time.
        law: MotionLaw,
    },
    /// About `pivot` by the law's value in rad.
    Turn {
        /// The point that stays, m.
        pivot: DVec2,
        /// Angle in rad over time.
        law: MotionLaw,
    },
}

impl SurfaceMotion {
    /// A palm that does not move.
    #[must_use]
    pub fn immobile(pose: SurfacePose) -> Self {
        Self { pose, parts: Vec::new() }
    }

    /// Whether the palm never moves.
    #[must_use]
    pub fn is_immobile(&self) -> bool {
        self.parts.iter().all(|part| part.law().is_constant())
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`].
    pub fn check(&self) -> Result<(), SurfaceError> {
        SurfacePose::new(self.pose.p_WP, self.pose.angle)?;
        for part in &self.parts {
            let own = match *part {
                MotionPart::Shift { direction, .. } => [("direction", direction), ("direction", direction)],
                MotionPart::Turn { pivot, .. } => [("x of the pivot", pivot.x), ("y of the pivot", pivot.y)],
            };
            let bad = own.into_iter().find(|(_, value)| !value.is_finite()).or(part.law().first_bad());
            if let Some((what, value)) = bad {
                return Err(SurfaceError::Parameter { what, value });
            }
        }
        Ok(())
    }

    /// Pose, velocity and acceleration at time `t` in s.
    #[must_use]
    pub fn at(&self, t: f64) -> SurfaceState {
        self.parts.iter().fold(self.pose.at_rest(), |state, part| part.moved(&state, t))
    }

    /// How fast the palm's direction and its own motion change about the time `t` at most, rad/s: over a time that is short against the
    /// inverse, and has no joint, every distance to the palm is nearly a polynomial of low degree.
    #[must_use]
    pub fn quickness(&self, t: f64) -> f64 {
        let of_part = |part: &MotionPart| match part {
            MotionPart::Shift { law, .. } => law.quickness(t),
            MotionPart::Turn { law, .. } => law.quickness_of_turn(t),
        };
        self.parts.iter().map(of_part).sum()
    }

    /// Times at which the motion is less smooth than elsewhere, ascending: an integrator of high order stops there.
    #[must_use]
    pub fn joints(&self) -> Vec<f64> {
        let mut joints: Vec<f64> = self.parts.iter().filter_map(|p| p.law().joints()).flatten().collect();
        joints.sort_by(f64::total_cmp);
        joints
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
                let d = DVec2::from_angle(direction);
                SurfaceState {
                    p_WP: of.p_WP + value * d,
                    v_WP: of.v_WP + rate * d,
                    a_WP: of.a_WP + acceleration * d,
                    ..*of
                }
            }
            Self::Turn { pivot, .. } => {
                let turn = DVec2::from_angle(value);
                let (arm, v) = (turn.rotate(of.p_WP - pivot), turn.rotate(of.v_WP));
                let a = turn.rotate(of.a_WP);
                SurfaceState {
                    p_WP: pivot + arm,
                    angle: of.angle + value,
                    v_WP: rate * arm.perp() + v,
                    w_WP: rate + of.w_WP,
                    a_WP: acceleration * arm.perp() - rate * rate * arm + 2.0 * rate * v.perp() + a,
                    alpha_WP: acceleration + of.alpha_WP,
                }
            }
        }
    }
}
