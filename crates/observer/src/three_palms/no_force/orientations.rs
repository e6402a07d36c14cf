//! Orientations that a search begins with.

use glam::{DQuat, DVec3};

/// Orientations of principal axes, spread over all that differ: turns by pi about a principal axis change nothing, so
/// the 24 turns of a cube leave 6, and each is taken as it is and turned by 45 degrees about each axis.
pub(super) fn orientations() -> Vec<DQuat> {
    let third =
        |k: i32| DQuat::from_axis_angle(DVec3::ONE.normalize(), f64::from(k) * std::f64::consts::TAU / 3.0);
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut all = Vec::new();
    for swap in [DQuat::IDENTITY, DQuat::from_rotation_z(quarter)] {
        for k in 0..3 {
            let base = third(k) * swap;
            all.push(base);
        }
    }
    let bases = all.clone();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        all.extend(bases.iter().map(|base| DQuat::from_axis_angle(axis, 0.5 * quarter) * *base));
    }
    all
}
