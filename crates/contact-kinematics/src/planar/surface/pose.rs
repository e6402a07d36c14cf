use super::SurfaceError;
use glam::DVec2;

/// Where a palm's frame stands in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePose {
    /// Origin of the palm's frame, m.
    pub p_WP: DVec2,
    /// Angle of the palm's x axis against world X, rad.
    pub angle: f64,
}

impl SurfacePose {
    /// From origin (m) and angle (rad).
    ///
    /// # Errors
    /// [`SurfaceError::Parameter`].
    pub fn new(p_WP: DVec2, angle: f64) -> Result<Self, SurfaceError> {
        let numbers = [("x of the position", p_WP.x), ("y of the position", p_WP.y), ("angle", angle)];
        match numbers.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((what, value)) => Err(SurfaceError::Parameter { what, value }),
            None => Ok(Self { p_WP, angle }),
        }
    }

    /// A palm at rest in this pose.
    #[must_use]
    pub fn at_rest(&self) -> SurfaceState {
        SurfaceState { p_WP: self.p_WP, angle: self.angle, ..SurfaceState::default() }
    }
}

/// Pose, velocity and acceleration of a palm's frame at one instant, in world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceState {
    /// Origin of the palm's frame, m.
    pub p_WP: DVec2,
    /// Angle of the palm's x axis against world X, rad.
    pub angle: f64,
    /// Velocity of the origin, m/s.
    pub v_WP: DVec2,
    /// Angular velocity, rad/s.
    pub w_WP: f64,
    /// Acceleration of the origin, m/s^2.
    pub a_WP: DVec2,
    /// Angular acceleration, rad/s^2.
    pub alpha_WP: f64,
}

impl SurfaceState {
    /// Velocity of the palm's material at the world point `c`, m/s: `V + W x (c - P)`.
    ///
    /// A palm that turns in itself moves its surface, although its shape does not change.
    #[must_use]
    pub fn material_velocity(&self, c: DVec2) -> DVec2 {
        self.v_WP + self.w_WP * (c - self.p_WP).perp()
    }

    /// Rate of [`Self::material_velocity`] at a point that moves at `c_dot`, m/s^2.
    #[must_use]
    pub fn material_velocity_rate(&self, c: DVec2, c_dot: DVec2) -> DVec2 {
        self.a_WP + self.alpha_WP * (c - self.p_WP).perp() + self.w_WP * (c_dot - self.v_WP).perp()
    }

    /// A point of the world in palm axes, m.
    #[must_use]
    pub fn to_palm(&self, p_W: DVec2) -> DVec2 {
        DVec2::from_angle(-self.angle).rotate(p_W - self.p_WP)
    }

    /// A point in palm axes in the world, m.
    #[must_use]
    pub fn to_world(&self, p_P: DVec2) -> DVec2 {
        self.p_WP + DVec2::from_angle(self.angle).rotate(p_P)
    }
}
