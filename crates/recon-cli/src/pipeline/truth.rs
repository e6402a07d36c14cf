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
    let at = |row: u32, column: u32| {
        let (polar, around) =
            (PI * f64::from(row) / f64::from(ROWS), TAU * f64::from(column) / f64::from(COLUMNS));
        let n = DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos());
        axes.inverse() * body.point(Direction::new_unchecked(n))
    };
    let rings = (1..ROWS).filter(|row| row % 3 == 0).map(|row| (0..=COLUMNS).map(|c| at(row, c)).collect());
    let meridians =
        (0..COLUMNS).filter(|c| c % 3 == 0).map(|column| (0..=ROWS).map(|row| at(row, column)).collect());
    Ok(TrueShape {
        mesh: net(at)?,
        wireframe: rings.chain(meridians).collect(),
        volume: volume(&simulation.shape),
    })
}

/// The closed surface over a net of normals; degenerate triangles at the poles are left out.
fn net(at: impl Fn(u32, u32) -> DVec3) -> Result<TriangleMesh, CliError> {
    let index = |row: u32, column: u32| match row {
        0 => 0,
        ROWS => 1,
        _ => 2 + (row - 1) * COLUMNS + column % COLUMNS,
    };
    let mut vertices = vec![at(0, 0), at(ROWS, 0)];
    vertices.extend(
        (1..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))).map(|(r, c)| at(r, c)),
    );
    let mut triangles = Vec::new();
    for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        let [a, b, c, d] =
            [index(row, column), index(row + 1, column), index(row + 1, column + 1), index(row, column + 1)];
        triangles.extend(
            [[a, b, c], [a, c, d]].into_iter().filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]),
        );
    }
    Ok(TriangleMesh::new(vertices, triangles)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use recon::shape_bounds;

    #[test]
    fn net_is_closed_and_turned_outwards() {
        let sphere = recon::contact_kinematics::Sphere::new(1.0).unwrap();
        let mesh = net(|row, column| {
            let (polar, around) =
                (PI * f64::from(row) / f64::from(ROWS), TAU * f64::from(column) / f64::from(COLUMNS));
            let n = DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos());
            sphere.point(Direction::new(n).unwrap())
        })
        .unwrap();
        // Every edge is passed once in each direction.
        let mut edges = std::collections::HashMap::new();
        for t in &mesh.triangles {
            for k in 0..3 {
                *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
            }
        }
        assert!(edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1)));
        let solid = shape_bounds::TriangleMesh { vertices: mesh.vertices, triangles: mesh.triangles };
        let missing = 4.0 / 3.0 * PI - solid.moments().volume;
        assert!(missing > 0.0 && missing < 0.03, "{missing}");
    }

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
