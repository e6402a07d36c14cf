//! The true motion and shape, in the body axes of the estimate.

use super::body::{body, volume};
use crate::error::CliError;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::{MassProperties, TrueState};
use recon::observer::equivalent_orientations;
use recon_io::{MotionState, Simulation, TriangleMesh, TrueShape};
use std::f64::consts::{PI, TAU};

/// Rows and columns of the net of normals on which a true shape is drawn.
const ROWS: u32 = 36;
const COLUMNS: u32 = 72;

/// The turn `D` of the true body axes after which they are those of the estimate: `R_WO` estimated is about `R_WO D`
/// true. No data can tell the four turns apart that leave the inertia as it is.
pub(crate) fn axes_of_estimate(mass: &MassProperties, estimated: DQuat, truth: DQuat) -> DQuat {
    let agreement = |turn: &DQuat| estimated.dot(truth * *turn).abs();
    equivalent_orientations(mass)
        .into_iter()
        .max_by(|a, b| agreement(a).total_cmp(&agreement(b)))
        .unwrap_or(DQuat::IDENTITY)
}

/// The true motion in the axes of the estimate.
pub(crate) fn true_motion(states: &[TrueState], axes: DQuat) -> Vec<MotionState> {
    states.iter().map(|s| MotionState { R_WO: s.R_WO * axes, ..MotionState::from(*s) }).collect()
}

/// The true shape in the axes of the estimate, as triangles and as lines of equal normal.
pub(crate) fn true_shape(simulation: &Simulation, axes: DQuat) -> Result<TrueShape, CliError> {
    let body = body(simulation)?;
    let on = |n: DVec3| axes.inverse() * body.point(Direction::new_unchecked(n));
    let at = |row: u32, column: u32| {
        let (polar, around) =
            (PI * f64::from(row) / f64::from(ROWS), TAU * f64::from(column) / f64::from(COLUMNS));
        on(DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos()))
    };
    let rings = (1..ROWS).filter(|row| row % 3 == 0).map(|row| (0..=COLUMNS).map(|c| at(row, c)).collect());
    let meridians =
        (0..COLUMNS).filter(|c| c % 3 == 0).map(|column| (0..=ROWS).map(|row| at(row, column)).collect());
    Ok(TrueShape {
        mesh: TriangleMesh::net(ROWS, COLUMNS, on),
        wireframe: rings.chain(meridians).collect(),
        volume: volume(&simulation.shape),
    })
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
            let found = truth * axes_of_estimate(&mass, estimated, truth);
            assert!(found.dot(estimated).abs() > 1.0 - 1e-5);
        }
    }
}
