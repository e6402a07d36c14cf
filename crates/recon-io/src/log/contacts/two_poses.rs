//! Where a palm stands by the log and by the scene, if both say it.

use glam::DVec3;
use recon::contact_kinematics::SurfacePose;
use thiserror::Error;

/// A palm stands elsewhere than the scene says.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "line {line}: palm {palm} stands elsewhere than `pose` of its [[palm]] says: its point at the contact is at {} m by the log and at \
     {} m by the scene, {distance:.2e} m apart, where `contact_off_palm` allows {limit:.2e} m; correct the one that is wrong, or \
     leave `pose` out of the scene, and the log's columns P and Q count alone",
    in_words(*log), in_words(*scene)
)]
pub struct PoseAgainstScene {
    /// Line of the log.
    pub line: u64,
    /// Palm from 1.
    pub palm: usize,
    /// The palm's point at the contact by the log, world, m.
    pub log: DVec3,
    /// The same point by the scene.
    pub scene: DVec3,
    /// Between the two, m.
    pub distance: f64,
    /// Largest distance that is taken for noise, m.
    pub limit: f64,
}

/// Whether a point of the palm (palm axes, m) is at one place by the poses of log and scene, to the `limit`.
pub(super) fn check_pose(
    (line, palm): (u64, usize),
    poses: [&SurfacePose; 2],
    point: DVec3,
    limit: f64,
) -> Result<(), PoseAgainstScene> {
    let [log, scene] = poses.map(|pose| pose.at_rest().to_world(point));
    let distance = log.distance(scene);
    // A limit that is not a number limits nothing.
    if distance > limit {
        return Err(PoseAgainstScene { line, palm, log, scene, distance, limit });
    }
    Ok(())
}

fn in_words(p: DVec3) -> String {
    format!("({:.5}, {:.5}, {:.5})", p.x, p.y, p.z)
}
