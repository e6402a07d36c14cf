use glam::DVec3;

/// Standard deviations of the white noise of sensors, as an estimator takes them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNoiseLevel {
    /// Of a contact point in each tangent direction of its palm, m.
    pub contact: f64,
    /// Of each axis of a force: a fixed part, N.
    pub force_fixed: f64,
    /// Of each axis of a force: a part that grows with it, as a share of its length.
    pub force_share: f64,
    /// What a contact condition is off by beside that, m/s: palms whose velocity is known no better, creep.
    pub floor: f64,
}

impl ContactNoiseLevel {
    /// Standard deviation of each axis of the force `f`, N.
    pub(super) fn force(&self, f: DVec3) -> f64 {
        self.force_fixed.hypot(self.force_share * f.length())
    }
}
