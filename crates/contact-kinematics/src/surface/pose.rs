use super::SurfaceError;
use super::error::{FASTEST_PALM, FASTEST_TURN};
use crate::Direction;
use glam::{DMat3, DQuat, DVec3};

/// Largest departure of a quaternion's length from 1 that is taken for rounding.
const UNIT_TOLERANCE: f64 = 1e-4;

/// Where a palm's frame stands in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePose {
    /// Origin of the palm's frame, m.
    pub p_WP: DVec3,
    /// Orientation, palm axes to world axes.
    pub R_WP: DQuat,
}

impl SurfacePose {
    /// Refuses this pose as the one `row` (from 0) of a motion if it is too far from the one `before` it, `seconds` (s) earlier, or
    /// turned against it by more than `farthest` (degrees).
    ///
    /// # Errors
    /// [`SurfaceError::Jump`].
    pub fn check_step(
        &self,
        before: &Self,
        seconds: f64,
        row: usize,
        farthest: f64,
    ) -> Result<(), SurfaceError> {
        let distance = (self.p_WP - before.p_WP).length();
        let degrees = before.R_WP.angle_between(self.R_WP).to_degrees();
        let farthest = farthest.min(FASTEST_TURN * seconds);
        if distance <= FASTEST_PALM * seconds && degrees <= farthest {
            return Ok(());
        }
        Err(SurfaceError::Jump { row, seconds, distance, degrees, farthest })
    }

    /// From origin (m) and orientation; the quaternion is normalised.
    ///
    /// # Errors
    /// [`SurfaceError::PoseNotFinite`] and [`SurfaceError::NoRotation`].
    pub fn new(p_WP: DVec3, R_WP: DQuat) -> Result<Self, SurfaceError> {
        if !p_WP.is_finite() {
            return Err(SurfaceError::PoseNotFinite { what: "position", value: p_WP.to_array() });
        }
        let length = R_WP.length();
        // A NaN is not within the tolerance either.
        if (length - 1.0).abs() <= UNIT_TOLERANCE {
            Ok(Self { p_WP, R_WP: R_WP.normalize() })
        } else {
            Err(SurfaceError::NoRotation { length })
        }
    }

    /// A palm at rest in this pose.
    #[must_use]
    pub fn at_rest(&self) -> SurfaceState {
        let zero = DVec3::ZERO;
        let R_WP = DMat3::from_quat(self.R_WP);
        SurfaceState { p_WP: self.p_WP, R_WP, v_WP: zero, w_WP: zero, a_WP: zero, alpha_WP: zero }
    }
}

/// Pose, velocity and acceleration of a palm's frame at one instant, in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceState {
    /// Origin of the palm's frame, m.
    pub p_WP: DVec3,
    /// Orientation, palm axes to world axes.
    pub R_WP: DMat3,
    /// Velocity of the origin, m/s.
    pub v_WP: DVec3,
    /// Angular velocity, rad/s.
    pub w_WP: DVec3,
    /// Acceleration of the origin, m/s^2.
    pub a_WP: DVec3,
    /// Angular acceleration, rad/s^2.
    pub alpha_WP: DVec3,
}

impl SurfaceState {
    /// The frame carried along by a turn about the axis through `pivot`: `[angle, rate, acceleration]` in rad and s.
    #[must_use]
    pub fn turned(&self, pivot: DVec3, axis: Direction, [angle, rate, acceleration]: [f64; 3]) -> Self {
        let turn = DMat3::from_quat(DQuat::from_axis_angle(axis.get(), angle));
        let (w, alpha) = (rate * axis.get(), acceleration * axis.get());
        let (arm, v, w_P) = (turn * (self.p_WP - pivot), turn * self.v_WP, turn * self.w_WP);
        Self {
            p_WP: pivot + arm,
            R_WP: turn * self.R_WP,
            v_WP: w.cross(arm) + v,
            w_WP: w + w_P,
            a_WP: alpha.cross(arm) + w.cross(w.cross(arm)) + 2.0 * w.cross(v) + turn * self.a_WP,
            alpha_WP: alpha + w.cross(w_P) + turn * self.alpha_WP,
        }
    }

    /// Velocity of the palm's material at the world point `c`, m/s: `V + W x (c - P)`.
    ///
    /// A palm that turns in itself moves its surface, although its shape does not change.
    #[must_use]
    pub fn material_velocity(&self, c: DVec3) -> DVec3 {
        self.v_WP + self.w_WP.cross(c - self.p_WP)
    }

    /// Rate of [`Self::material_velocity`] at a point that moves at `c_dot`, m/s^2.
    #[must_use]
    pub fn material_velocity_rate(&self, c: DVec3, c_dot: DVec3) -> DVec3 {
        self.a_WP + self.alpha_WP.cross(c - self.p_WP) + self.w_WP.cross(c_dot - self.v_WP)
    }

    /// A point of the world in palm axes, m.
    #[must_use]
    pub fn to_palm(&self, p_W: DVec3) -> DVec3 {
        self.R_WP.transpose() * (p_W - self.p_WP)
    }

    /// A point in palm axes in the world, m.
    #[must_use]
    pub fn to_world(&self, p_P: DVec3) -> DVec3 {
        self.p_WP + self.R_WP * p_P
    }
}
