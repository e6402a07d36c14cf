//! The orientations of a body that no data can tell apart.

use glam::{DQuat, DVec3};
use object_dynamics::MassProperties;

/// Of the [`equivalent_orientations`] the turn `D` that brings `R_WO D` nearest to the orientation `to`.
#[must_use]
pub fn nearest_turn(mass: &MassProperties, R_WO: DQuat, to: DQuat) -> DQuat {
    let agreement = |turn: &DQuat| to.dot(R_WO * *turn).abs();
    equivalent_orientations(mass)
        .into_iter()
        .max_by(|a, b| agreement(a).total_cmp(&agreement(b)))
        .unwrap_or(DQuat::IDENTITY)
}

/// The four turns `D` of the body axes under which the inertia tensor does not change: identity and half turns about
/// the principal axes. Motion and contacts are the same for `R_WO` and `R_WO D`; the body's shape is turned with them.
#[must_use]
pub fn equivalent_orientations(mass: &MassProperties) -> [DQuat; 4] {
    let axes = mass.principal().axes;
    let half = |v: DVec3| axes * DQuat::from_xyzw(v.x, v.y, v.z, 0.0) * axes.inverse();
    [DQuat::IDENTITY, half(DVec3::X), half(DVec3::Y), half(DVec3::Z)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_turns_about_principal_axes_are_taken_back() {
        let mass = MassProperties::from_principal(1.0, DVec3::new(1.0, 1.45, 2.05)).unwrap();
        let truth = DQuat::from_scaled_axis(DVec3::new(0.4, -0.2, 1.1));
        for turn in equivalent_orientations(&mass) {
            let estimated = truth * turn * DQuat::from_scaled_axis(DVec3::splat(1e-3));
            let found = truth * nearest_turn(&mass, truth, estimated);
            assert!(found.dot(estimated).abs() > 1.0 - 1e-5);
        }
    }
}
