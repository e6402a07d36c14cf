use crate::cli::{PlanarArgs, ReconstructArgs};
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::interrupt::while_writing;
use crate::pipeline::{
    PlanarBounds, PlanarMotion, PlanarSource, hinged_pair, planar_motion, read_planar, with_palms,
};
use crate::progress::Progress;
use glam::DVec2;
use recon::contact_kinematics::planar::FourierBody;
use recon::object_dynamics::planar::{
    ConstantRates, PlanarLog, PlanarMass, PlanarObject, PlanarStart, simulate_prescribed,
};
use recon::observer::planar::{ShapeFitOptions, fit_shape};
use recon_io::{
    FigureCurve, FigurePanel, FolderTarget, OutputFolder, PlanarScene, SummaryOf, brief, read_planar_log,
    status_in_words, write_figures, write_planar_log,
};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::Path;

/// What was made of a planar log.
enum Made {
    /// Motion from contacts and forces.
    Motion(Box<PlanarMotion>),
    /// Shape and motion from contacts alone.
    Fit(Fitted),
}

/// One row of a fit.
struct Row {
    t: f64,
    phi0: f64,
    omega0: f64,
    radii: [f64; 2],
    points: [DVec2; 2],
}

/// A shape that was fitted without forces.
struct Fitted {
    rows: Vec<Row>,
    figures: Value,
    warnings: Vec<String>,
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
            Made::Motion(Box::new(planar_motion(contacts, &known)?))
        }
        None => Made::Fit(fit(args, &log)?),
    };
    let simulated = args.log.is_none().then_some(&log);
    let title = args.log.as_deref().map_or_else(|| "Fig. 3 of the paper".to_owned(), name);
    finish(made, target, simulated, (progress, &args.output, &title), console)
}

/// A log of a scene in the plane: of any palms, or of two hinged ones where the scene has none.
pub(crate) fn reconstruct(
    args: &ReconstructArgs,
    scene: &Path,
    console: &Console,
) -> Result<Outcome, CliError> {
    let mut known = PlanarScene::read_known(scene)?;
    let target = FolderTarget::new(&args.output, &[args.log.clone(), scene.to_owned()], args.force)?;
    let progress = Progress::new(2, console.is_quiet());
    progress.step("reading the log");
    if args.identify {
        known.mass = None;
    }
    let log = read_planar(&PlanarSource::File(&args.log), &known)?;
    progress.step("estimating the motion");
    let made = planar_motion(log, &with_palms(known))?;
    let title = name(&args.log);
    finish(Made::Motion(Box::new(made)), target, None, (progress, &args.output, &title), console)
}

/// The title of a page.
fn name(log: &Path) -> String {
    log.file_name().unwrap_or(log.as_os_str()).to_string_lossy().into_owned()
}

/// Writes the folder and tells of it.
fn finish(
    made: Made,
    target: FolderTarget,
    log: Option<&PlanarLog>,
    (progress, folder, title): (Progress, &Path, &str),
    console: &Console,
) -> Result<Outcome, CliError> {
    let figures = match &made {
        Made::Motion(made) => made.figures(),
        Made::Fit(made) => made.figures.clone(),
    };
    write(target, log, &made, (title, &figures))?;
    drop(progress);
    let (text, sound) = match &made {
        Made::Motion(made) => (made.describe(), made.is_reliable()),
        Made::Fit(made) => (describe(made), made.warnings.is_empty()),
    };
    console.result(&format!("{text}  written to             {}\n", folder.display()), &figures)?;
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

fn fit(args: &PlanarArgs, log: &PlanarLog) -> Result<Fitted, CliError> {
    let contact_deviation = args.contact_noise.filter(|noise| *noise > 0.0).ok_or(CliError::PlanarNoise)?;
    let options =
        ShapeFitOptions { order: usize::from(args.order), contact_deviation, gravity: args.gravity };
    let made = fit_shape(log, &options)?;
    let radius = |theta: f64| {
        let (mut r, mut d) = (0.0, 0.0);
        for (k, (a, b)) in made.cosines.iter().zip(&made.sines).enumerate() {
            let (sin, cos) = (k as f64 * theta).sin_cos();
            r += a * cos + b * sin;
            d += k as f64 * (a * sin - b * cos);
        }
        let n = DVec2::from_angle(theta);
        n * r - n.perp() * d
    };
    let mut rows = Vec::new();
    for ((sample, motion), radii) in log.samples().iter().zip(&made.motion).zip(&made.radii) {
        let quarter = std::f64::consts::FRAC_PI_2;
        let [phi1, phi2] = sample.angles;
        let thetas = [phi1 - motion[0] - quarter, phi1 + phi2 - motion[0] + quarter];
        rows.push(Row {
            t: sample.t,
            phi0: motion[0],
            omega0: motion[1],
            radii: *radii,
            points: thetas.map(radius),
        });
    }
    let mut warnings = Vec::new();
    if made.status != recon::observer::Status::Converged {
        let why = match made.status {
            recon::observer::Status::Inconsistent => {
                "noise does not explain what is left: it is stated too small, or something else is wrong"
            }
            _ => "the readings do not tell all of it",
        };
        let (status, order) = (status_in_words(made.status), made.cosines.len() - 1);
        let direction = &made.direction;
        warnings.push(format!(
            "not to be relied on with {order} harmonics ({status}): {why}; least known: {direction}"
        ));
    }
    let figures = SummaryOf::PlaneWithoutForces.named(json!({
        "method": "shape fitted to contacts and palm angles, no forces",
        "status": status_in_words(made.status),
        "harmonics": made.cosines.len() - 1,
        "residual": made.residual,
        "gyration_squared_m2": made.gyration_squared.0,
        "std_gyration_squared_m2": made.gyration_squared.1,
        "cosines_m": made.cosines,
        "sines_m": made.sines,
        "smallest_information": made.smallest_information,
        "least_known": made.direction,
        "warnings": warnings,
    }));
    Ok(Fitted { rows, figures, warnings })
}

fn write(
    target: FolderTarget,
    log: Option<&PlanarLog>,
    made: &Made,
    (title, figures): (&str, &Value),
) -> Result<(), CliError> {
    while_writing(|| {
        let mut folder = target.begin()?;
        match made {
            Made::Motion(made) => write_motion(&mut folder, made, title)?,
            Made::Fit(made) => {
                folder.write("motion.csv", |to| motion(made, to))?;
                folder.write("contact_points.csv", |to| points(made, to))?;
                folder.write("figures.svg", |to| write_figures(&panels(made), to))?;
            }
        }
        folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
        if let Some(log) = log {
            folder.write("log.csv", |to| write_planar_log(log, to))?;
        }
        folder.commit()?;
        Ok(())
    })
}

/// The files of a motion.
fn write_motion(folder: &mut OutputFolder, made: &PlanarMotion, title: &str) -> Result<(), CliError> {
    folder.write("motion.csv", |to| made.write_motion(to))?;
    folder.write("contact_points.csv", |to| made.write_points(to))?;
    folder.write("radius_functions.csv", |to| made.write_radii(to))?;
    folder.write("figures.svg", |to| write_figures(&made.panels(), to))?;
    folder.write("report.html", |to| made.write_report(title, to))?;
    for (name, outline) in made.bounds().into_iter().flat_map(PlanarBounds::drawn_outlines) {
        folder.write(name, |to| PlanarBounds::write_outline(outline, to))?;
    }
    Ok(())
}

/// Writes the folder of a motion that was estimated in memory.
pub(crate) fn write_estimated(
    target: FolderTarget,
    made: &PlanarMotion,
    title: &str,
) -> Result<(), CliError> {
    while_writing(|| {
        let mut folder = target.begin()?;
        write_motion(&mut folder, made, title)?;
        folder.write("summary.json", |to| writeln!(to, "{:#}", made.figures()))?;
        folder.commit()?;
        Ok(())
    })
}

fn motion(made: &Fitted, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "t,phi0,omega0,r_1,r_2")?;
    made.rows.iter().try_for_each(|r| {
        writeln!(to, "{:?},{:?},{:?},{:?},{:?}", r.t, r.phi0, r.omega0, r.radii[0], r.radii[1])
    })
}

fn points(made: &Fitted, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "palm,t,x,y")?;
    (0..2).try_for_each(|i| {
        made.rows
            .iter()
            .try_for_each(|r| writeln!(to, "{},{:?},{:?},{:?}", i + 1, r.t, r.points[i].x, r.points[i].y))
    })
}

/// Contact points, orientation and radius functions.
fn panels(made: &Fitted) -> Vec<FigurePanel> {
    let over = |name: &str, pick: &dyn Fn(&Row) -> f64| FigureCurve {
        name: name.to_owned(),
        points: made.rows.iter().map(|r| [r.t, pick(r)]).collect(),
        ..FigureCurve::default()
    };
    let panel = |title: &str, unit: &str, curves| FigurePanel {
        title: title.to_owned(),
        axes: ["t in s".to_owned(), unit.to_owned()],
        curves,
        ..FigurePanel::default()
    };
    let shape = [0, 1].map(|i| FigureCurve {
        name: format!("palm {}", i + 1),
        points: made.rows.iter().map(|r| r.points[i].to_array()).collect(),
        dots: true,
        ..FigureCurve::default()
    });
    vec![
        FigurePanel {
            title: "Shape: contact points on the object".to_owned(),
            axes: ["x in m".to_owned(), "y in m".to_owned()],
            equal: true,
            curves: shape.into(),
            ..FigurePanel::default()
        },
        panel("Orientation", "phi0 in rad", vec![over("phi0", &|r| r.phi0)]),
        panel(
            "Radius functions at the contacts",
            "r in m",
            vec![over("r1", &|r| r.radii[0]), over("r2", &|r| r.radii[1])],
        ),
    ]
}

fn describe(made: &Fitted) -> String {
    let mut text: String = made.warnings.iter().map(|w| format!("Warning: {w}\n")).collect();
    let last = made.rows.last().map_or(f64::NAN, |r| r.t);
    let first = made.rows.first().map_or(f64::NAN, |r| r.t);
    text += &format!("{} estimates from t = {} s to {} s\n", made.rows.len(), brief(first), brief(last));
    for key in ["method", "status", "residual", "gyration_squared_m2"] {
        let Some(value) = made.figures.get(key) else { continue };
        let value = value.as_f64().map_or_else(|| value.as_str().unwrap_or_default().to_owned(), brief);
        text += &format!("  {key:<22} {value}\n");
    }
    text
}
