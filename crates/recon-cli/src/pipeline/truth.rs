//! The true motion and shape, in the body axes of the estimate.

use super::body::volume;
use crate::error::CliError;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::TrueState;
use recon_io::{MotionState, Simulation, TriangleMesh, TrueShape};

/// Rows and columns of the net of normals on which a true shape is drawn.
const ROWS: u32 = 24;
const COLUMNS: u32 = 48;

/// The true motion in the axes of the estimate.
pub(crate) fn true_motion(states: &[TrueState], axes: DQuat) -> Vec<MotionState> {
    states.iter().map(|s| MotionState { R_WO: s.R_WO * axes, ..MotionState::from(*s) }).collect()
}

/// The true shape in the axes of the estimate.
pub(crate) fn true_shape(simulation: &Simulation, axes: DQuat) -> Result<TrueShape, CliError> {
    let body = simulation.body()?;
    let on = |n: DVec3| axes.inverse() * body.point(Direction::new_unchecked(n));
    Ok(TrueShape { mesh: TriangleMesh::net(ROWS, COLUMNS, on), volume: volume(&simulation.shape) })
}
