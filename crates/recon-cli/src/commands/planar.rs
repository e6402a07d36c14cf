use crate::cli::PlanarArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::interrupt::{check, while_writing};
use crate::progress::Progress;
use glam::DVec2;
use recon::contact_kinematics::planar::FourierBody;
use recon::object_dynamics::planar::{
    ConstantRates, PlanarLog, PlanarMass, PlanarObject, PlanarStart, simulate_prescribed,
};
use recon::observer::planar::{
    NaturalScale, PlanarNominal, PlanarObserver, PlanarObserverOptions, ShapeFitOptions, fit_shape,
};
use recon_io::{
    FigureCurve, FigurePanel, FolderTarget, brief, read_planar_log, write_figures, write_planar_log,
};
use serde_json::{Value, json};
use std::io::{self, Write};

/// Natural times before the first estimate: from six on a start without a guess succeeds.
const STARTING_TIMES: f64 = 6.0;
/// The observer doubts a start below 1.5.
const SHORTEST_TIMES: f64 = 1.6;

/// One row of the result.
struct Row {
    t: f64,
    phi0: f64,
    omega0: f64,
    radii: [f64; 2],
    points: [DVec2; 2],
}

/// Everything that is written.
struct Reconstruction {
    rows: Vec<Row>,
    figures: Value,
    warnings: Vec<String>,
}

pub(crate) fn run(args: &PlanarArgs, console: &Console) -> Result<Outcome, CliError> {
    let target = FolderTarget::new(&args.output, args.log.as_slice(), args.force)?;
    let progress = Progress::new(2, console.is_json());
    progress.step("reading the log");
    let demo = args.log.is_none().then(demo).transpose()?;
    let (log, mass) = match (&args.log, demo) {
        (Some(path), _) => (read_planar_log(path)?, known_mass(args)?),
        (None, Some((log, mass))) => (log, Some(mass)),
        (None, None) => return Err(CliError::PlanarDemo("no scene".to_owned())),
    };
    progress.step("reconstructing shape and motion");
    let sensed = log.samples().iter().all(|s| s.forces.is_some() || s.torques.is_some());
    let made = match mass.filter(|_| sensed) {
        Some(mass) => observe(args, &log, mass)?,
        None => fit(args, &log)?,
    };
    write(target, args.log.is_none(), &log, &made)?;
    drop(progress);
    console.result(&describe(args, &made), &made.figures)?;
    Ok(if made.warnings.is_empty() { Outcome::Done } else { Outcome::WithReservations })
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

fn observe(args: &PlanarArgs, log: &PlanarLog, mass: PlanarMass) -> Result<Reconstruction, CliError> {
    let nominal = PlanarNominal {
        mass,
        gravity: args.gravity,
        contact_deviation: args.contact_noise,
        force_deviation: args.force_noise,
    };
    let samples = log.samples();
    let seconds = samples[samples.len() - 1].t - samples[0].t;
    // A short log still gives a result: the first estimate comes at half of it, if that is long enough to be believed.
    let scale = NaturalScale::from_sample(&samples[0], args.gravity)?;
    let time = scale.time();
    let settle = (STARTING_TIMES * time).min((0.5 * seconds).max(SHORTEST_TIMES * time));
    let options = PlanarObserverOptions { settle: Some(settle), ..Default::default() };
    let mut observer = PlanarObserver::<5>::new(nominal, &[], options)?;
    let (mut rows, mut warnings, mut last) = (Vec::new(), Vec::new(), None);
    for sample in log.samples() {
        check()?;
        match observer.push(sample) {
            Ok(Some(e)) => {
                let omega0 = e.state[4];
                rows.push(Row { t: e.t, phi0: e.phi0, omega0, radii: e.radii, points: e.contact_points });
                last = Some(e);
            }
            Ok(None) => {}
            Err(error) if last.is_some() => {
                warnings.push(format!("ends early: {error}"));
                break;
            }
            Err(error) => return Err(error.into()),
        }
    }
    let last = last.ok_or(CliError::PlanarTooShort { seconds, needed: settle, length: scale.length })?;
    if let Some(doubt) = last.doubt {
        warnings.push(format!("not to be relied on: {doubt:?}"));
    }
    let figures = json!({
        "method": "Newton observer, forces measured",
        "window_s": observer.window(),
        "natural_time_s": time,
        "natural_length_m": scale.length,
        "status": format!("{:?}", last.report.status),
        "residual": last.report.residual,
        "rank": last.report.rank,
        "condition": last.report.condition,
        "smallest_information": last.report.smallest_information,
        "radius_deviation_m": last.radius_deviations,
        "warnings": warnings,
    });
    Ok(Reconstruction { rows, figures, warnings })
}

fn fit(args: &PlanarArgs, log: &PlanarLog) -> Result<Reconstruction, CliError> {
    if args.contact_noise <= 0.0 {
        return Err(CliError::PlanarNoise);
    }
    let options = ShapeFitOptions {
        order: usize::from(args.order),
        contact_deviation: args.contact_noise,
        gravity: args.gravity,
    };
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
        warnings.push(format!("not to be relied on: {:?}, least known: {}", made.status, made.direction));
    }
    let figures = json!({
        "method": "shape fitted to contacts and palm angles, no forces",
        "status": format!("{:?}", made.status),
        "residual": made.residual,
        "gyration_squared_m2": made.gyration_squared.0,
        "gyration_squared_deviation_m2": made.gyration_squared.1,
        "cosines_m": made.cosines,
        "sines_m": made.sines,
        "smallest_information": made.smallest_information,
        "least_known": made.direction,
        "warnings": warnings,
    });
    Ok(Reconstruction { rows, figures, warnings })
}

fn write(
    target: FolderTarget,
    with_log: bool,
    log: &PlanarLog,
    made: &Reconstruction,
) -> Result<(), CliError> {
    while_writing(|| {
        let mut folder = target.begin()?;
        folder.write("motion.csv", |to| motion(made, to))?;
        folder.write("contact_points.csv", |to| points(made, to))?;
        folder.write("figures.svg", |to| write_figures(&panels(log, made), to))?;
        folder.write("summary.json", |to| writeln!(to, "{:#}", made.figures))?;
        if with_log {
            folder.write("log.csv", |to| write_planar_log(log, to))?;
        }
        folder.commit()?;
        Ok(())
    })
}

fn motion(made: &Reconstruction, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "t,phi0,omega0,r_1,r_2")?;
    made.rows.iter().try_for_each(|r| {
        writeln!(to, "{:?},{:?},{:?},{:?},{:?}", r.t, r.phi0, r.omega0, r.radii[0], r.radii[1])
    })
}

fn points(made: &Reconstruction, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "palm,t,x,y")?;
    (0..2).try_for_each(|i| {
        made.rows
            .iter()
            .try_for_each(|r| writeln!(to, "{},{:?},{:?},{:?}", i + 1, r.t, r.points[i].x, r.points[i].y))
    })
}

/// The paper's Figs. 2b and 3a (contact points), 2c (orientation) and 3b (errors, where the truth is known).
fn panels(log: &PlanarLog, made: &Reconstruction) -> Vec<FigurePanel> {
    let line = |name: &str, points: Vec<[f64; 2]>| FigureCurve {
        name: name.to_owned(),
        points,
        ..FigureCurve::default()
    };
    let panel = |title: &str, unit: &str, curves| FigurePanel {
        title: title.to_owned(),
        axes: ["t in s".to_owned(), unit.to_owned()],
        curves,
        ..FigurePanel::default()
    };
    let over = |pick: &dyn Fn(&Row) -> f64| made.rows.iter().map(|r| [r.t, pick(r)]).collect::<Vec<_>>();
    let shape = [0, 1].map(|i| FigureCurve {
        name: format!("palm {}", i + 1),
        points: made.rows.iter().map(|r| r.points[i].to_array()).collect(),
        dots: true,
        ..FigureCurve::default()
    });
    let mut panels = vec![
        FigurePanel {
            title: "Shape: contact points on the object".to_owned(),
            axes: ["x in m".to_owned(), "y in m".to_owned()],
            equal: true,
            curves: shape.into(),
            ..FigurePanel::default()
        },
        panel("Orientation", "phi0 in rad", vec![line("observed", over(&|r| r.phi0))]),
        panel(
            "Radius functions at the contacts",
            "r in m",
            vec![line("r1", over(&|r| r.radii[0])), line("r2", over(&|r| r.radii[1]))],
        ),
    ];
    let Some(truth) = log.truth() else { return panels };
    let first = truth[0].phi0;
    let rows: Vec<_> = log.samples().iter().zip(truth).collect();
    // Below the observed one, which begins later.
    panels[1].curves.insert(0, line("true", rows.iter().map(|(s, t)| [s.t, t.phi0 - first]).collect()));
    let errors = made.rows.iter().filter_map(|r| {
        let k = rows.partition_point(|(s, _)| s.t < r.t);
        let (sample, truth) = rows.get(k)?;
        let normals = sample.palms().ok()?.normals();
        let radius = |i: usize| r.radii[i] - normals[i].dot(truth.p_WCm);
        Some([r.t, radius(0), radius(1), r.phi0 - (truth.phi0 - first)])
    });
    let errors: Vec<[f64; 4]> = errors.collect();
    let column = |i: usize| errors.iter().map(|e| [e[0], e[i]]).collect::<Vec<_>>();
    panels.push(panel(
        "Errors",
        "m, rad",
        vec![
            line("error in r1", column(1)),
            line("error in r2", column(2)),
            line("error in phi0", column(3)),
        ],
    ));
    panels
}

fn describe(args: &PlanarArgs, made: &Reconstruction) -> String {
    let mut text: String = made.warnings.iter().map(|w| format!("Warning: {w}\n")).collect();
    let last = made.rows.last().map_or(f64::NAN, |r| r.t);
    let first = made.rows.first().map_or(f64::NAN, |r| r.t);
    text += &format!("{} estimates from t = {} s to {} s\n", made.rows.len(), brief(first), brief(last));
    for key in [
        "method",
        "status",
        "residual",
        "natural_length_m",
        "window_s",
        "gyration_squared_m2",
        "radius_deviation_m",
    ] {
        if let Some(value) = made.figures.get(key) {
            let value = match (value.as_f64(), value.as_str()) {
                (Some(number), _) => brief(number),
                (None, Some(word)) => word.to_owned(),
                (None, None) => value.as_array().map_or(value.to_string(), |all| {
                    all.iter().filter_map(Value::as_f64).map(brief).collect::<Vec<_>>().join(", ")
                }),
            };
            text += &format!("  {key:<22} {value}\n");
        }
    }
    text + &format!("  written to             {}\n", args.output.display())
}
