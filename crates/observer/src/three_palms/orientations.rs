//! The orientations of a body that no data can tell apart.

use glam::{DQuat, DVec3};
use object_dynamics::MassProperties;

/// Of the orientations `R_WO D` with `D` a half turn about a principal axis, the one with the smallest angle.
pub(super) fn nearest_to_identity(mass: &MassProperties, R_WO: DQuat) -> DQuat {
    equivalent_orientations(mass)
        .into_iter()
        .map(|turn| R_WO * turn)
        .max_by(|a, b| a.w.abs().total_cmp(&b.w.abs()))
        .unwrap_or(R_WO)
}

/// The four turns `D` of the body axes under which the inertia tensor does not change: identity and half turns about
/// the principal axes. Motion and contacts are the same for `R_WO` and `R_WO D`; the body's shape is turned with them.
#[must_use]
pub fn equivalent_orientations(mass: &MassProperties) -> [DQuat; 4] {
    let axes = mass.principal().axes;
    let half = |v: DVec3| axes * DQuat::from_xyzw(v.x, v.y, v.z, 0.0) * axes.inverse();
    [DQuat::IDENTITY, half(DVec3::X), half(DVec3::Y), half(DVec3::Z)]
}
