//! The true motion and shape, in the body axes of the estimate.

use super::body::volume;
use crate::error::CliError;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::TrueState;
use recon_io::{MotionState, Simulation, TriangleMesh, TrueShape};
use std::f64::consts::{PI, TAU};

/// Rows and columns of the net of normals on which a true shape is drawn.
const ROWS: u32 = 36;
const COLUMNS: u32 = 72;

/// The true motion in the axes of the estimate.
pub(crate) fn true_motion(states: &[TrueState], axes: DQuat) -> Vec<MotionState> {
    states.iter().map(|s| MotionState { R_WO: s.R_WO * axes, ..MotionState::from(*s) }).collect()
}

/// The true shape in the axes of the estimate, as triangles and as lines of equal normal.
pub(crate) fn true_shape(simulation: &Simulation, axes: DQuat) -> Result<TrueShape, CliError> {
    let body = simulation.body()?;
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
