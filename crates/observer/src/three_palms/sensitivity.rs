//! How the orientation follows a change of the start: a linear equation beside the motion.

use super::track::Integrals;
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::MassProperties;

/// What the sensitivity of the orientation needs at one time: `theta' = M theta + K (dL0 + impulse x dcm0 + ...)`.
pub(super) struct Turning {
    pub(super) w: DVec3,
    /// Inverse inertia in world axes.
    pub(super) K: DMat3,
    /// `K [L]x`.
    pub(super) M: DMat3,
    pub(super) impulse: DVec3,
    pub(super) first_moment: DVec3,
}

impl Turning {
    pub(super) fn new(mass: &MassProperties, q: DQuat, L: DVec3, integrals: &Integrals) -> Self {
        Self::at(mass, q, L, integrals.impulse, integrals.first_moment)
    }

    pub(super) fn at(mass: &MassProperties, q: DQuat, L: DVec3, impulse: DVec3, first_moment: DVec3) -> Self {
        let R = DMat3::from_quat(q);
        let K = R * mass.inverse_inertia() * R.transpose();
        Self { w: K * L, K, M: K * cross_matrix(L), impulse, first_moment }
    }

    /// Right-hand side of the sensitivity equation, block by block.
    fn rate(&self, theta: &[DMat3; 4]) -> [DMat3; 4] {
        [
            self.M * theta[0] + self.K * cross_matrix(self.impulse),
            self.M * theta[1] + self.K * cross_matrix(self.first_moment),
            self.M * theta[2] + self.K,
            self.M * theta[3],
        ]
    }
}

/// Derivative of the orientation (a rotation vector in world axes) by centre of mass, velocity, angular momentum and
/// orientation at the start.
pub(super) struct Sensitivity([DMat3; 4]);

impl Sensitivity {
    pub(super) fn at_start() -> Self {
        Self([DMat3::ZERO, DMat3::ZERO, DMat3::ZERO, DMat3::IDENTITY])
    }

    /// One Runge-Kutta step of order 4 of the linear equation `theta' = M theta + S`, as `theta' = w x theta + dw`
    /// reduces to it.
    pub(super) fn advance(&mut self, start: &Turning, middle: &Turning, end: &Turning, h: f64) {
        let move_by = |theta: &[DMat3; 4], k: &[DMat3; 4], h: f64| -> [DMat3; 4] {
            std::array::from_fn(|i| theta[i] + k[i] * h)
        };
        let k1 = start.rate(&self.0);
        let k2 = middle.rate(&move_by(&self.0, &k1, 0.5 * h));
        let k3 = middle.rate(&move_by(&self.0, &k2, 0.5 * h));
        let k4 = end.rate(&move_by(&self.0, &k3, h));
        for i in 0..4 {
            self.0[i] += (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) * (h / 6.0);
        }
    }

    /// `block' v`.
    pub(super) fn transposed(&self, block: usize, v: DVec3) -> DVec3 {
        self.0[block].transpose() * v
    }
}

pub(super) fn cross_matrix(v: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, v.z, -v.y), DVec3::new(-v.z, 0.0, v.x), DVec3::new(v.y, -v.x, 0.0))
}

/// `exp [v]x` as a quaternion, exact for small `v` too.
pub(super) fn exponential(v: DVec3) -> DQuat {
    let angle = v.length();
    // sin(a/2) / a; the series is exact to rounding below 1e-4.
    let ratio = if angle < 1e-4 { 0.5 - angle * angle / 48.0 } else { (0.5 * angle).sin() / angle };
    DQuat::from_xyzw(ratio * v.x, ratio * v.y, ratio * v.z, (0.5 * angle).cos())
}

/// The rotation vector of a unit quaternion, of length at most pi: `exponential` undone.
pub(super) fn logarithm(q: DQuat) -> DVec3 {
    let q = if q.w < 0.0 { -q } else { q };
    let v = DVec3::new(q.x, q.y, q.z);
    let sine = v.length();
    // angle / sin(angle / 2); the series is exact to rounding below 1e-4.
    let ratio = if sine < 1e-4 { 2.0 + sine * sine / 3.0 } else { 2.0 * sine.atan2(q.w) / sine };
    v * ratio
}
