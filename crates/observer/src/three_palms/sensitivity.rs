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
        Self::of(R, mass.inverse_inertia(), L, impulse, first_moment)
    }

    pub(super) fn of(
        R: DMat3,
        inverse_inertia: DMat3,
        L: DVec3,
        impulse: DVec3,
        first_moment: DVec3,
    ) -> Self {
        let K = R * inverse_inertia * R.transpose();
        Self { w: K * L, K, M: times_cross(K, L), impulse, first_moment }
    }
}

/// One Runge-Kutta step of order 4 of the linear equation `theta' = M theta + S`, as `theta' = w x theta + dw` reduces to
/// it, for any number of columns: `theta + G0 (M0 theta + S0) + G1 (M1 theta + S1) + G2 (M2 theta + S2)`, start, middle and
/// end, where the `G` are what the four stages come to.
pub(super) struct SensitivityStep {
    transition: DMat3,
    /// `G K`, for sources `S = K dL`.
    through: [DMat3; 3],
}

impl SensitivityStep {
    pub(super) fn new(start: &Turning, middle: &Turning, end: &Turning, h: f64) -> Self {
        let (first, last) = (middle.M * middle.M, end.M * middle.M);
        let half = 0.5 * h * h;
        let g0 =
            (DMat3::IDENTITY + middle.M * h + first * half + last * middle.M * (0.5 * h * half)) * (h / 6.0);
        let g1 = (DMat3::from_diagonal(DVec3::splat(4.0)) + (middle.M + end.M) * h + last * half) * (h / 6.0);
        let g2 = h / 6.0;
        Self {
            transition: DMat3::IDENTITY + g0 * start.M + g1 * middle.M + end.M * g2,
            through: [g0 * start.K, g1 * middle.K, end.K * g2],
        }
    }

    /// A column whose angular momentum changes by these at start, middle and end.
    pub(super) fn column(&self, theta: DVec3, by_L: [DVec3; 3]) -> DVec3 {
        let [a, b, c] = self.through;
        self.transition * theta + a * by_L[0] + b * by_L[1] + c * by_L[2]
    }

    /// Columns of centre of mass or velocity at the start, whose angular momenta change by `arms x` them.
    pub(super) fn crossed(&self, theta: DMat3, arms: [DVec3; 3]) -> DMat3 {
        let [a, b, c] = self.through;
        self.transition * theta + times_cross(a, arms[0]) + times_cross(b, arms[1]) + times_cross(c, arms[2])
    }

    /// Columns of the angular momentum at the start.
    pub(super) fn turned(&self, theta: DMat3) -> DMat3 {
        let [a, b, c] = self.through;
        self.transition * theta + a + b + c
    }

    /// Columns of the orientation at the start.
    pub(super) fn carried(&self, theta: DMat3) -> DMat3 {
        self.transition * theta
    }
}

/// `m [v]x`.
fn times_cross(m: DMat3, v: DVec3) -> DMat3 {
    DMat3::from_cols(
        m.y_axis * v.z - m.z_axis * v.y,
        m.z_axis * v.x - m.x_axis * v.z,
        m.x_axis * v.y - m.y_axis * v.x,
    )
}

/// Derivative of the orientation (a rotation vector in world axes) by centre of mass, velocity, angular momentum and
/// orientation at the start.
pub(super) struct Sensitivity([DMat3; 4]);

impl Sensitivity {
    pub(super) fn at_start() -> Self {
        Self([DMat3::ZERO, DMat3::ZERO, DMat3::ZERO, DMat3::IDENTITY])
    }

    pub(super) fn advance(&mut self, start: &Turning, middle: &Turning, end: &Turning, h: f64) {
        let step = SensitivityStep::new(start, middle, end, h);
        let all = [start, middle, end];
        let [p, v, L, theta] = self.0;
        self.0 = [
            step.crossed(p, all.map(|turning| turning.impulse)),
            step.crossed(v, all.map(|turning| turning.first_moment)),
            step.turned(L),
            step.carried(theta),
        ];
    }

    /// `block' v`.
    pub(super) fn transposed(&self, block: usize, v: DVec3) -> DVec3 {
        self.0[block].transpose() * v
    }
}

pub(crate) fn cross_matrix(v: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, v.z, -v.y), DVec3::new(-v.z, 0.0, v.x), DVec3::new(v.y, -v.x, 0.0))
}

/// `exp [v]x` as a quaternion, exact for small `v` too.
pub(crate) fn exponential(v: DVec3) -> DQuat {
    let square = 0.25 * v.length_squared();
    // sin(a/2) / a and cos(a/2): the series are exact to rounding below a half of 0.05.
    let (ratio, w) = if square < 2.5e-3 {
        let sine = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)));
        let cosine =
            1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)));
        (0.5 * sine, cosine)
    } else {
        let half = square.sqrt();
        (half.sin() / (2.0 * half), half.cos())
    };
    DQuat::from_xyzw(ratio * v.x, ratio * v.y, ratio * v.z, w)
}

/// The rotation vector of a unit quaternion, of length at most pi: `exponential` undone.
pub(crate) fn logarithm(q: DQuat) -> DVec3 {
    let q = if q.w < 0.0 { -q } else { q };
    let v = DVec3::new(q.x, q.y, q.z);
    let sine = v.length();
    // angle / sin(angle / 2); the series is exact to rounding below 1e-4.
    let ratio = if sine < 1e-4 { 2.0 + sine * sine / 3.0 } else { 2.0 * sine.atan2(q.w) / sine };
    v * ratio
}
