use crate::error::CliError;
use glam::DVec3;
use recon::object_dynamics::{ContactLog, NotThreePlanes, SensorLog, ThreePlanes};
use recon_io::{AnyLog, Scene, brief, read_any_log};
use std::path::Path;

/// What a sensor log is estimated as.
pub(crate) enum LogOf {
    /// Three flat palms through one point, without friction; with what is to be said of that.
    ThreePalms(SensorLog, Option<String>),
    /// Contacts of any palms; with why they are not the former.
    AnyPalms(Box<ContactLog>, NotThreePlanes),
}

/// Reads a sensor log of either version.
pub(crate) fn read_log(path: &Path, scene: &Scene) -> Result<LogOf, CliError> {
    let log = match read_any_log(path, scene.palm_setups().as_deref())? {
        AnyLog::ThreePalms(log) => return Ok(LogOf::ThreePalms(log, None)),
        AnyLog::Contacts(log) => log,
    };
    let known_to = scene.sensors.contact_off_palm.unwrap_or(0.0);
    Ok(match log.three_planes_within(known_to) {
        Err(why) => LogOf::AnyPalms(Box::new(log), why),
        Ok(ThreePlanes { log, p_WM, apart }) => {
            let [x, y, z] = p_WM.to_array().map(brief);
            let moved = format!(
                "The palms meet in ({x}, {y}, {z}) m, to within {apart:.1e} m: all positions are seen from there."
            );
            LogOf::ThreePalms(log, (p_WM != DVec3::ZERO).then_some(moved))
        }
    })
}

/// The same of what must be three flat palms through one point, without friction.
pub(crate) fn three_palms(path: &Path, scene: &Scene) -> Result<(SensorLog, Option<String>), CliError> {
    match read_log(path, scene)? {
        LogOf::ThreePalms(log, moved) => Ok((log, moved)),
        LogOf::AnyPalms(_, source) => Err(CliError::NotThreePlanes { path: path.to_owned(), source }),
    }
}
