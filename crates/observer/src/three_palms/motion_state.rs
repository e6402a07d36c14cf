use glam::{DQuat, DVec3};

/// Motion at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionState {
    /// Time as in the log, s.
    pub t: f64,
    /// Centre of mass, world, m.
    pub p_WCm: DVec3,
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Velocity of the centre of mass, world, m/s.
    pub v_WCm: DVec3,
    /// Angular velocity, world axes, rad/s.
    pub w_WO: DVec3,
}
