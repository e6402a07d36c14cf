//! Rotations by small and large angles.

use glam::{DMat3, DQuat, DVec3};

/// `[v]x`.
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

/// How the rotation vector `v` of a turn changes with a small turn after it.
pub(crate) fn logarithm_slope(v: DVec3) -> DMat3 {
    let (cross, angle) = (cross_matrix(v), v.length());
    // 1 / a^2 - cot(a / 2) / (2 a); the series is exact to rounding below 1e-2.
    let bend = if angle < 1e-2 {
        1.0 / 12.0 + angle * angle / 720.0
    } else {
        (1.0 / angle - 0.5 / (0.5 * angle).tan()) / angle
    };
    DMat3::IDENTITY - cross * 0.5 + cross * cross * bend
}
