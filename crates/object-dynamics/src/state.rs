use glam::{DQuat, DVec3};

/// State of a rigid body in maximal coordinates: nothing in it knows of palms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass, world, m.
    pub p_WCm: DVec3,
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Velocity of the centre of mass, world, m/s.
    pub v_WCm: DVec3,
    /// Angular velocity, world axes, rad/s.
    pub w_WO: DVec3,
}
