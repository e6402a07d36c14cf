//! `recon planar`, and `recon reconstruct` of a scene in the plane.

use super::answers::written_to;
use super::planar_fit;
use crate::cli::{PlanarArgs, ReconstructArgs};
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::interrupt::while_writing;
use crate::pipeline::{
    Extra, PlanarBounds, PlanarMotion, PlanarSource, explained, hinged_pair, planar_motion, read_planar,
    with_palms,
};
use crate::progress::Progress;
use recon::contact_kinematics::planar::FourierBody;
use recon::object_dynamics::planar::{
    ConstantRates, PlanarLog, PlanarMass, PlanarObject, PlanarStart, simulate_prescribed,
};
use recon_io::{
    FolderTarget, OutputFolder, PlanarScene, read_planar_log, write_figures, write_figures_page,
    write_planar_log,
};
use serde_json::Value;
use std::io::Write;
use std::path::Path;

/// What was made of a planar log.
enum Made {
    /// Motion from contacts and forces.
    Motion(Box<PlanarMotion>),
    /// Shape and motion from contacts alone.
    Fit(planar_fit::Fitted),
}

pub(crate) fn run(args: &PlanarArgs, console: &Console) -> Result<Outcome, CliError> {
    let target = FolderTarget::new(&args.output, args.log.as_slice(), args.force)?;
    let progress = Progress::new(2, console.is_quiet());
    progress.step("reading the log");
    let demo = args.log.is_none().then(demo).transpose()?;
    let (log, mass) = match (&args.log, demo) {
        (Some(path), _) => (read_planar_log(path)?, known_mass(args)?),
        (None, Some((log, mass))) => (log, Some(mass)),
        (None, None) => return Err(CliError::PlanarDemo("no scene".to_owned())),
    };
    progress.step("reconstructing shape and motion");
    let made = match log.contact_log(args.palm_inertias()) {
        Some(contacts) => {
            let known = hinged_pair(args.gravity, mass, args.contact_noise, args.force_noise);
            Made::Motion(Box::new(planar_motion(contacts, &known, None, false)?))
        }
        None => Made::Fit(planar_fit::fit(args, &log)?),
    };
    let simulated = args.log.is_none().then_some(&log);
    let title = args.log.as_deref().map_or_else(|| "Fig. 3 of the paper".to_owned(), name);
    finish(&made, target, (simulated, &[]), (progress, &args.output, &title), console)
}

/// A log of a scene in the plane: of any palms, or of two hinged ones where the scene has none.
pub(crate) fn reconstruct(
    args: &ReconstructArgs,
    scene: &Path,
    console: &Console,
) -> Result<Outcome, CliError> {
    in_space_alone(args, scene)?;
    let mut known = PlanarScene::read_known(scene)?;
    let target = FolderTarget::new(&args.output, &[args.log.clone(), scene.to_owned()], args.force)?;
    let progress = Progress::new(2, console.is_quiet());
    progress.step("reading the log");
    if args.identify {
        known.mass = None;
    }
    let log = read_planar(&PlanarSource::File(&args.log), &known)?;
    progress.step("estimating the motion");
    let made = planar_motion(log, &with_palms(known), args.accuracy, args.covariance)?;
    let extras = if args.covariance { vec![made.covariances()?] } else { Vec::new() };
    let title = name(&args.log);
    let explained = made.choice.as_ref().filter(|_| args.explain).map(|choice| explained(choice, true));
    explained.iter().for_each(|text| console.note(text));
    let (made, extras) = (Made::Motion(Box::new(made)), (None, extras.as_slice()));
    finish(&made, target, extras, (progress, &args.output, &title), console)
}

/// Refuses what would be left out in silence: files and ways of the space alone.
fn in_space_alone(args: &ReconstructArgs, scene: &Path) -> Result<(), CliError> {
    let asked = [
        ("mapping", args.mapping.is_some()),
        ("without-forces", args.without_forces),
        ("export", !args.export.is_empty()),
        ("mesh", !args.mesh.is_empty()),
        ("mcap", args.mcap),
    ];
    match asked.into_iter().find(|(_, is_asked)| *is_asked) {
        None => Ok(()),
        Some((option, _)) => Err(CliError::in_space_alone(option, scene)),
    }
}

/// The title of a page.
fn name(log: &Path) -> String {
    log.file_name().unwrap_or(log.as_os_str()).to_string_lossy().into_owned()
}

/// Writes the folder, with the log that was simulated and more files, and tells of it.
fn finish(
    made: &Made,
    target: FolderTarget,
    beside: (Option<&PlanarLog>, &[Extra]),
    (progress, folder, title): (Progress, &Path, &str),
    console: &Console,
) -> Result<Outcome, CliError> {
    let figures = match made {
        Made::Motion(made) => made.figures(),
        Made::Fit(made) => made.figures.clone(),
    };
    write(target, beside, made, (title, &figures))?;
    drop(progress);
    let (text, sound) = match made {
        Made::Motion(made) => (made.describe(), made.is_reliable()),
        Made::Fit(made) => (planar_fit::describe(made), made.warnings.is_empty()),
    };
    console.written(&(text + &written_to(Some(folder))), &figures)?;
    Ok(if sound { Outcome::Done } else { Outcome::WithReservations })
}

fn known_mass(args: &PlanarArgs) -> Result<Option<PlanarMass>, CliError> {
    let known = args.mass.zip(args.inertia).map(|(m, i)| PlanarMass::new(m, i));
    known.transpose().map_err(|e| CliError::PlanarDemo(e.to_string()))
}

/// The scene of the paper's Fig. 3: an object of radius 2, palms at a fixed angle that turn counter-clockwise.
fn demo() -> Result<(PlanarLog, PlanarMass), CliError> {
    let failed = |e: &dyn std::fmt::Display| CliError::PlanarDemo(e.to_string());
    let shape =
        FourierBody::new(&[2.0, 0.15, 0.225, 0.03], &[0.0, -0.1, 0.05, -0.04]).map_err(|e| failed(&e))?;
    let mass = PlanarMass::from_gyration(1.0, 1.8225).map_err(|e| failed(&e))?;
    let object = PlanarObject { shape, mass, gravity: 9.81 };
    let motion = ConstantRates { angles: [45_f64.to_radians(), 90_f64.to_radians()], rates: [0.2, 0.0] };
    let times: Vec<f64> = (0..=1400).map(|k| f64::from(k) * 1e-3).collect();
    let start = PlanarStart { phi0: 5.85, omega0: 1.0 };
    let run = simulate_prescribed(&object, &motion, start, &times, 1e-13).map_err(|e| failed(&e))?;
    Ok((run.log().map_err(|e| failed(&e))?, mass))
}

fn write(
    target: FolderTarget,
    (log, extras): (Option<&PlanarLog>, &[Extra]),
    made: &Made,
    (title, figures): (&str, &Value),
) -> Result<(), CliError> {
    let made = match made {
        Made::Motion(made) => return write_estimated(target, made, (title, figures), (log, extras)),
        Made::Fit(made) => made,
    };
    while_writing(|| {
        let folder = target.begin()?;
        folder.write("motion.csv", |to| planar_fit::motion(made, to))?;
        folder.write("contact_points.csv", |to| planar_fit::points(made, to))?;
        folder.write("figures.svg", |to| write_figures(&planar_fit::panels(made), to))?;
        folder.write("report.html", |to| write_figures_page(&planar_fit::page(made, title), to))?;
        finish_folder(folder, figures, log)
    })
}

/// Writes what all of these folders have.
fn finish_folder(folder: OutputFolder, figures: &Value, log: Option<&PlanarLog>) -> Result<(), CliError> {
    folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
    if let Some(log) = log {
        folder.write("log.csv", |to| write_planar_log(log, to))?;
    }
    folder.commit()?;
    Ok(())
}

/// Writes the folder of a motion, with the log that was simulated and more files.
pub(crate) fn write_estimated(
    target: FolderTarget,
    made: &PlanarMotion,
    (title, figures): (&str, &Value),
    (log, extras): (Option<&PlanarLog>, &[Extra]),
) -> Result<(), CliError> {
    while_writing(|| {
        let folder = target.begin()?;
        folder.write("motion.csv", |to| made.write_motion(to))?;
        folder.write("contact_points.csv", |to| made.write_points(to))?;
        folder.write("radius_functions.csv", |to| made.write_radii(to))?;
        folder.write("figures.svg", |to| write_figures(&made.panels(), to))?;
        folder.write("report.html", |to| made.write_report(title, to))?;
        for (name, outline) in made.bounds().into_iter().flat_map(PlanarBounds::drawn_outlines) {
            folder.write(name, |to| PlanarBounds::write_outline(outline, to))?;
        }
        for (name, contents) in extras {
            folder.write(name, |to| to.write_all(contents))?;
        }
        finish_folder(folder, figures, log)
    })
}
