use crate::console::Console;
use crate::error::CliError;
use glam::DVec3;
use recon::object_dynamics::{ContactLog, LoggedPalm, NotThreePlanes, SensedAxes, SensorLog, ThreePlanes};
use recon_io::{
    AnyLog, BagLog, BagMapping, Scene, brief, is_bag, log_of_bag, palms_of, read_any_log, read_bag,
};
use std::path::Path;

/// What a sensor log is estimated as.
pub(crate) enum LogOf {
    /// Three flat palms through one point, without friction.
    ThreePalms(ThreePlanes),
    /// Contacts of any palms; with why they are not the former.
    AnyPalms(Box<ContactLog>, NotThreePlanes),
}

/// A sensor log that was read.
pub(crate) struct ReadLog {
    pub(crate) log: LogOf,
    /// What is to be said of it.
    pub(crate) warnings: Vec<String>,
    /// Time of a bag at which that of the log is zero, ns.
    pub(crate) epoch: i64,
}

/// Where a log is, and what is known beside it.
#[derive(Clone, Copy)]
pub(crate) struct LogSource<'a> {
    pub(crate) path: &'a Path,
    pub(crate) scene: &'a Scene,
    /// Mapping of the topics of a bag.
    pub(crate) mapping: Option<&'a Path>,
}

/// A sensor log as a file or memory has it, before it is known how it is estimated.
#[derive(Clone)]
pub(crate) struct LoadedLog {
    pub(crate) log: AnyLog,
    /// What was done to a bag.
    pub(crate) notes: Vec<String>,
    pub(crate) warnings: Vec<String>,
    /// Time of a bag at which that of the log is zero, ns.
    pub(crate) epoch: i64,
}

impl From<AnyLog> for LoadedLog {
    fn from(log: AnyLog) -> Self {
        let (notes, warnings, epoch) = Default::default();
        Self { log, notes, warnings, epoch }
    }
}

/// Reads a sensor log of either version or a bag, for an estimate that needs forces.
pub(crate) fn read_log(from: LogSource, console: &Console) -> Result<ReadLog, CliError> {
    read(from, console, impulses_alone)
}

/// The same of what must be three flat palms through one point, without friction; forces are not needed.
pub(crate) fn three_palms(from: LogSource, console: &Console) -> Result<(SensorLog, Vec<String>), CliError> {
    let read = read(from, console, |_| None)?;
    match read.log {
        LogOf::ThreePalms(planes) => Ok(seen_from_meeting_point(planes, read.warnings)),
        LogOf::AnyPalms(_, source) => Err(CliError::NotThreePlanes { path: from.path.to_owned(), source }),
    }
}

fn read(
    from: LogSource,
    console: &Console,
    lacks: impl Fn(&ContactLog) -> Option<NotThreePlanes>,
) -> Result<ReadLog, CliError> {
    let loaded = load(from)?;
    loaded.notes.iter().for_each(|note| console.note(note));
    Ok(sorted(loaded, from.scene, lacks))
}

/// Reads a sensor log of either version or a bag.
pub(crate) fn load(from: LogSource) -> Result<LoadedLog, CliError> {
    let LogSource { path, scene, mapping } = from;
    if is_bag(path) {
        let mapping = mapping.ok_or_else(|| CliError::NoMapping { path: path.to_owned() })?;
        let BagLog { log, epoch, notes, warnings } =
            read_mapped(path, &BagMapping::read(mapping)?, Some(scene))?;
        return Ok(LoadedLog { log: AnyLog::Contacts(log), notes, warnings, epoch });
    }
    // What is not there at all is named by the reader.
    if mapping.is_some() && path.exists() {
        return Err(CliError::MappingOfNoBag { path: path.to_owned() });
    }
    Ok(read_any_log(path, scene.palm_setups().as_deref())?.into())
}

/// The log as what it is estimated, for an estimate that needs forces.
pub(crate) fn sorted_with_forces(loaded: LoadedLog, scene: &Scene) -> ReadLog {
    sorted(loaded, scene, impulses_alone)
}

/// The log as what it is estimated, without a look at its forces.
pub(crate) fn sorted_without_forces(loaded: LoadedLog, scene: &Scene) -> ReadLog {
    sorted(loaded, scene, |_| None)
}

fn sorted(
    loaded: LoadedLog,
    scene: &Scene,
    lacks: impl Fn(&ContactLog) -> Option<NotThreePlanes>,
) -> ReadLog {
    let LoadedLog { log, warnings, epoch, .. } = loaded;
    let log = match log {
        AnyLog::ThreePalms(log) => return ReadLog { log: LogOf::ThreePalms(log.into()), warnings, epoch },
        AnyLog::Contacts(log) => log,
    };
    let known_to = scene.sensors.contact_off_palm.unwrap_or(0.0);
    let planes = log.three_planes_within(known_to).and_then(|planes| lacks(&log).map_or(Ok(planes), Err));
    let log = match planes {
        Err(why) => LogOf::AnyPalms(Box::new(log), why),
        Ok(planes) => LogOf::ThreePalms(planes),
    };
    ReadLog { log, warnings, epoch }
}

/// The log without a place in the world, with what is to be said of that.
pub(crate) fn seen_from_meeting_point(
    ThreePlanes { log, p_WM, apart }: ThreePlanes,
    mut warnings: Vec<String>,
) -> (SensorLog, Vec<String>) {
    let [x, y, z] = p_WM.to_array().map(brief);
    let moved = format!(
        "The palms meet in ({x}, {y}, {z}) m, to within {apart:.1e} m: all positions are seen from there."
    );
    warnings.extend((p_WM != DVec3::ZERO).then_some(moved));
    (log, warnings)
}

/// Reads a bag by a mapping, with what a scene says of the palms.
fn read_mapped(path: &Path, mapping: &BagMapping, scene: Option<&Scene>) -> Result<BagLog, CliError> {
    let bag = read_bag(path)?;
    Ok(palms_of(mapping, scene)
        .and_then(|palms| log_of_bag(&bag, mapping, &palms))
        .map_err(|kind| kind.in_file(path))?)
}

/// The estimators of frictionless motion take forces: where one is known by its impulse alone, and all in three axes, the other one does.
fn impulses_alone(log: &ContactLog) -> Option<NotThreePlanes> {
    let three = Some(SensedAxes::Three);
    let alone = |palm: &LoggedPalm| palm.force_axes().is_none() && !palm.has_torque();
    let felt = |palm: &LoggedPalm| [palm.force_axes(), palm.impulse_axes()].contains(&three);
    let palm = log.palms().iter().position(alone)?;
    log.palms().iter().all(felt).then_some(NotThreePlanes::ImpulseAlone { palm: palm + 1 })
}
