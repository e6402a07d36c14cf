//! Sensor logs, version 2: palms of any number, shape, pose and motion.

mod any;
mod columns;
mod poses;
mod read;
mod reader;
mod two_poses;
mod write;

#[cfg(test)]
mod tests;

pub use any::{AnyLog, parse_any_log, read_any_log};
pub(super) use columns::Columns as ContactColumns;
pub(super) use columns::{check_palms, palms_in_space};
pub(crate) use poses::read_pose_table;
pub(super) use read::contacts;
pub use read::{parse_contact_log, read_contact_log};
pub use reader::ContactRows;
pub(super) use reader::{check_setups, sample as contact_sample};
pub use two_poses::PoseAgainstScene;
pub use write::write_contact_log;

use recon::contact_kinematics::{PalmSurface, SurfacePose};
use recon::object_dynamics::PalmHinge;

/// What a log does not say of a palm: its shape and, where it does not move, its pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmSetup {
    /// Its shape.
    pub surface: PalmSurface,
    /// Coefficient of friction between it and the object, where it is known.
    pub friction: Option<f64>,
    /// Where it stands while the log has no columns for that.
    pub pose: Option<SurfacePose>,
    /// What its motor turns it about, if it has one.
    pub hinge: Option<PalmHinge>,
    /// Largest distance of a contact point from the palm's surface that is taken for noise, m; may be infinite.
    pub largest_offset: f64,
}
