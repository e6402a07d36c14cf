use crate::error::CliError;
use glam::DVec3;
use recon::object_dynamics::{SensorLog, ThreePlanes};
use recon_io::{AnyLog, Scene, brief, read_any_log};
use std::path::Path;

/// A sensor log of either version as one of three flat palms through one point, which is all that is estimated from so far,
/// with what is to be said of that.
pub(crate) fn three_palms(path: &Path, scene: &Scene) -> Result<(SensorLog, Option<String>), CliError> {
    match read_any_log(path, scene.palm_setups().as_deref())? {
        AnyLog::ThreePalms(log) => Ok((log, None)),
        AnyLog::Contacts(log) => {
            let unknown = |source| CliError::NotThreePlanes { path: path.to_owned(), source };
            let known_to = scene.sensors.contact_off_palm.unwrap_or(0.0);
            let ThreePlanes { log, p_WM, apart } = log.three_planes_within(known_to).map_err(unknown)?;
            let [x, y, z] = p_WM.to_array().map(brief);
            let moved = format!(
                "The palms meet in ({x}, {y}, {z}) m, to within {apart:.1e} m: all positions are seen from there."
            );
            Ok((log, (p_WM != DVec3::ZERO).then_some(moved)))
        }
    }
}
