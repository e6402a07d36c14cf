use crate::cli::SimulateArgs;
use crate::console::{Console, listened};
use crate::error::{CliError, Outcome};
use crate::interrupt::{Checked, while_writing};
use crate::pipeline::{
    ContactRun, PlanarContactRun, Simulated, choice_figures, explained, simulate, simulate_contacts,
    simulate_planar_contacts,
};
use crate::progress::Progress;
use recon::least_model::{Choice, body_size, least_tolerance, outline_size};
use recon::object_dynamics::{End, planar};
use recon_io::{
    AnyLog, FileTarget, OutputError, PlanarScene, Scene, SceneError, SceneErrorKind, is_standard_output,
    write_contact_log, write_contact_report, write_log, write_planar_contact_log,
    write_planar_contact_report,
};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::Path;
use std::slice;

pub(crate) fn run(args: &SimulateArgs, console: &Console) -> Result<Outcome, CliError> {
    let scene = AnyScene::read(&args.scene)?;
    let inputs = slice::from_ref(&args.scene);
    let target = match is_standard_output(&args.output) {
        true => None,
        false => Some(FileTarget::new(&args.output, inputs)?),
    };
    let page = args.report.as_ref().map(|path| {
        let target = FileTarget::new(path, &[args.scene.clone(), args.output.clone()])?;
        Ok::<_, CliError>((target, path))
    });
    let page = page.transpose()?;
    let progress = Progress::new(2, console.is_quiet());
    progress.step("simulating");
    let mut made = match &scene {
        AnyScene::Plane(scene) => in_the_plane(scene, args)?,
        AnyScene::Space(scene) => in_space(scene, args)?,
    };
    progress.step("writing the log");
    let to_standard_output = target.is_none();
    match target {
        None => listened(write_any(&made.log, io::stdout().lock()))?,
        Some(target) => write(target, &args.output, |to| write_any(&made.log, to))?,
    }
    if let (Some((target, path)), Some(report)) = (page, &made.report) {
        write(target, path, |to| to.write_all(report))?;
        made.figures["report"] = path.to_string_lossy().into();
    }
    drop(progress);
    if to_standard_output {
        console.note(&made.text);
    } else {
        made.figures["log"] = args.output.to_string_lossy().into();
        console.written(&format!("{}: {}", args.output.display(), made.text), &made.figures)?;
    }
    Ok(made.outcome)
}

/// A scene of space or of the plane.
enum AnyScene {
    Space(Box<Scene>),
    Plane(Box<PlanarScene>),
}

impl AnyScene {
    fn read(path: &Path) -> Result<Self, CliError> {
        match Scene::read(path) {
            Ok(scene) => Ok(Self::Space(Box::new(scene))),
            Err(error) if matches!(error.kind, SceneErrorKind::InPlane) => {
                Ok(Self::Plane(Box::new(PlanarScene::read(path)?)))
            }
            Err(error) => Err(error.into()),
        }
    }
}

/// A log of space or of the plane.
pub(crate) enum MadeLog {
    Space(AnyLog),
    Plane(planar::ContactLog),
}

/// A simulated log and what is said of it.
pub(crate) struct Made {
    pub(crate) log: MadeLog,
    pub(crate) report: Option<Vec<u8>>,
    pub(crate) text: String,
    pub(crate) figures: Value,
    pub(crate) outcome: Outcome,
}

impl Made {
    /// With why it was simulated so, in the figures, and in the text where that is asked for.
    fn with(mut self, choice: Option<&Choice>, args: &SimulateArgs) -> Self {
        let Some(choice) = choice else { return self };
        self.figures["least_model"] = choice_figures(choice);
        self.text += &format!("\n{}", explained(choice, args.explain));
        if !choice.is_reached {
            self.outcome = Outcome::WithReservations;
        }
        self
    }
}

fn in_file(args: &SimulateArgs, kind: SceneErrorKind) -> SceneError {
    SceneError { path: args.scene.clone(), kind }
}

/// Simulates a scene of space.
pub(crate) fn in_space(scene: &Scene, args: &SimulateArgs) -> Result<Made, CliError> {
    match scene.palms {
        Some(_) => any_palms(scene, args),
        None => three_palms(scene, args),
    }
}

fn any_palms(scene: &Scene, args: &SimulateArgs) -> Result<Made, CliError> {
    let (run, choice) = match args.accuracy {
        None => (simulate_contacts(scene, &args.scene, args.tolerance)?, None),
        Some(wanted) => {
            let size = body_size(scene.contact_scene().map_err(|kind| in_file(args, kind))?.body());
            let run = |tolerance| simulate_contacts(scene, &args.scene, tolerance);
            let least = least_tolerance(wanted, size, run, ContactRun::poses)?;
            (least.run, Some(least.choice))
        }
    };
    let told = run.told();
    let report = report(args, |title, to| write_contact_report(title, &run.world, &run.simulation, to))?;
    let log = MadeLog::Space(AnyLog::Contacts(run.log));
    let made = Made { log, report, text: told.describe(), figures: told.figures(), outcome: Outcome::Done };
    Ok(made.with(choice.as_ref(), args))
}

/// Simulates a scene of the plane.
pub(crate) fn in_the_plane(scene: &PlanarScene, args: &SimulateArgs) -> Result<Made, CliError> {
    let (run, choice) = match args.accuracy {
        None => (simulate_planar_contacts(scene, args.tolerance)?, None),
        Some(wanted) => {
            let run = |tolerance| simulate_planar_contacts(scene, tolerance);
            let size = outline_size(&scene.world.object().shape);
            let least = least_tolerance(wanted, size, run, PlanarContactRun::poses)?;
            (least.run, Some(least.choice))
        }
    };
    let told = run.told();
    let (mut text, mut figures) = (told.describe(), told.figures());
    figures["laid_by_m"] = run.laid.into();
    if !scene.touches.is_empty() {
        text += &format!("\n  laid on its palms by a move of {:.1e} m", run.laid);
    }
    let report =
        report(args, |title, to| write_planar_contact_report(title, &scene.world, &run.simulation, to))?;
    let made = Made { log: MadeLog::Plane(run.log), report, text, figures, outcome: Outcome::Done };
    Ok(made.with(choice.as_ref(), args))
}

fn three_palms(scene: &Scene, args: &SimulateArgs) -> Result<Made, CliError> {
    if args.report.is_some() {
        return Err(CliError::NoPage);
    }
    let (simulated, choice) = match args.accuracy {
        None => (simulate(scene, &args.scene, args.tolerance)?, None),
        Some(wanted) => {
            let size = match &scene.simulation {
                Some(simulation) => body_size(&simulation.body()?),
                None => return Err(CliError::NothingToSimulate { path: args.scene.clone() }),
            };
            let run = |tolerance| simulate(scene, &args.scene, tolerance);
            let least = least_tolerance(wanted, size, run, Simulated::poses)?;
            (least.run, Some(least.choice))
        }
    };
    let (text, figures) = (describe(&simulated), figures(&simulated));
    let whole = simulated.end == End::Completed;
    let outcome = if whole { Outcome::Done } else { Outcome::WithReservations };
    let log = MadeLog::Space(AnyLog::ThreePalms(simulated.log));
    Ok(Made { log, report: None, text, figures, outcome }.with(choice.as_ref(), args))
}

fn write_any(log: &MadeLog, to: impl Write) -> io::Result<()> {
    match log {
        MadeLog::Space(AnyLog::ThreePalms(log)) => write_log(log, to),
        MadeLog::Space(AnyLog::Contacts(log)) => write_contact_log(log, to),
        MadeLog::Plane(log) => write_planar_contact_log(log, to),
    }
}

pub(super) fn write(
    target: FileTarget,
    path: &Path,
    contents: impl Fn(&mut dyn Write) -> io::Result<()>,
) -> Result<(), CliError> {
    while_writing(|| {
        let mut file = target.begin()?;
        contents(&mut Checked(&mut file)).map_err(|source| OutputError::Io {
            action: "write",
            path: path.to_owned(),
            source,
        })?;
        Ok(file.commit()?)
    })
}

/// The page of a scene, if one is asked for; its title is the name of the scene's file.
fn report(
    args: &SimulateArgs,
    write: impl Fn(&str, &mut Vec<u8>) -> io::Result<()>,
) -> Result<Option<Vec<u8>>, CliError> {
    if args.report.is_none() {
        return Ok(None);
    }
    let title = args.scene.file_stem().map_or_else(Default::default, |stem| stem.to_string_lossy());
    let mut page = Vec::new();
    write(&title, &mut page).map_err(CliError::Page)?;
    Ok(Some(page))
}

fn describe(simulated: &Simulated) -> String {
    let samples = simulated.log.samples().len();
    match simulated.end {
        End::Completed => {
            format!("{samples} samples over {} s, in contact with all three palms", simulated.duration)
        }
        End::ContactLost { palm, t } => format!(
            "{samples} samples up to t = {t:.6} s, where palm {} loses contact; {} s were asked for",
            palm + 1,
            simulated.duration
        ),
    }
}

fn figures(simulated: &Simulated) -> Value {
    let lost = match simulated.end {
        End::Completed => Value::Null,
        End::ContactLost { palm, t } => json!({ "palm": palm + 1, "t_s": t }),
    };
    json!({
        "samples": simulated.log.samples().len(),
        "duration_s": simulated.log.duration(),
        "contact_lost": lost,
    })
}
