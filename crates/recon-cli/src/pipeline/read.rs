use crate::error::CliError;
use glam::DVec3;
use recon::object_dynamics::{ContactLog, LoggedPalm, NotThreePlanes, SensedAxes, SensorLog, ThreePlanes};
use recon_io::{AnyLog, Scene, brief, read_any_log};
use std::path::Path;

/// What a sensor log is estimated as.
pub(crate) enum LogOf {
    /// Three flat palms through one point, without friction; with what is to be said of that.
    ThreePalms(SensorLog, Option<String>),
    /// Contacts of any palms; with why they are not the former.
    AnyPalms(Box<ContactLog>, NotThreePlanes),
}

/// Reads a sensor log of either version, for an estimate that needs forces.
pub(crate) fn read_log(path: &Path, scene: &Scene) -> Result<LogOf, CliError> {
    read(path, scene, impulses_alone)
}

/// The same of what must be three flat palms through one point, without friction; forces are not needed.
pub(crate) fn three_palms(path: &Path, scene: &Scene) -> Result<(SensorLog, Option<String>), CliError> {
    match read(path, scene, |_| None)? {
        LogOf::ThreePalms(log, moved) => Ok((log, moved)),
        LogOf::AnyPalms(_, source) => Err(CliError::NotThreePlanes { path: path.to_owned(), source }),
    }
}

fn read(
    path: &Path,
    scene: &Scene,
    lacks: impl Fn(&ContactLog) -> Option<NotThreePlanes>,
) -> Result<LogOf, CliError> {
    let log = match read_any_log(path, scene.palm_setups().as_deref())? {
        AnyLog::ThreePalms(log) => return Ok(LogOf::ThreePalms(log, None)),
        AnyLog::Contacts(log) => log,
    };
    let known_to = scene.sensors.contact_off_palm.unwrap_or(0.0);
    let planes = log.three_planes_within(known_to).and_then(|planes| lacks(&log).map_or(Ok(planes), Err));
    Ok(match planes {
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

/// The estimators of frictionless motion take forces: where one is known by its impulse alone, and all in three axes, the other one does.
fn impulses_alone(log: &ContactLog) -> Option<NotThreePlanes> {
    let three = Some(SensedAxes::Three);
    let alone = |palm: &LoggedPalm| palm.force_axes().is_none() && !palm.has_torque();
    let felt = |palm: &LoggedPalm| [palm.force_axes(), palm.impulse_axes()].contains(&three);
    let palm = log.palms().iter().position(alone)?;
    log.palms().iter().all(felt).then_some(NotThreePlanes::ImpulseAlone { palm: palm + 1 })
}
