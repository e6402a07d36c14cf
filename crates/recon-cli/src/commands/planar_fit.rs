//! Outline and motion in the plane from contacts alone: the fit, its tables and its page.

use crate::cli::PlanarArgs;
use crate::error::CliError;
use glam::DVec2;
use recon::object_dynamics::planar::PlanarLog;
use recon::observer::planar::{ShapeFitOptions, fit_shape};
use recon_io::EvidenceValue::{Number, Text};
use recon_io::{
    Evidence, EvidenceValue, FigureCurve, FigurePanel, FiguresPage, Level, SummaryOf, Verdict, brief,
    status_in_words,
};
use serde_json::{Value, json};
use std::io::{self, Write};

/// One row of a fit.
struct Row {
    t: f64,
    phi0: f64,
    omega0: f64,
    radii: [f64; 2],
    points: [DVec2; 2],
}

/// A shape that was fitted without forces.
pub(super) struct Fitted {
    rows: Vec<Row>,
    pub(super) figures: Value,
    pub(super) warnings: Vec<String>,
}

/// Fits a shape to contacts and palm angles.
pub(super) fn fit(args: &PlanarArgs, log: &PlanarLog) -> Result<Fitted, CliError> {
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

/// The motion, a row a sample.
pub(super) fn motion(made: &Fitted, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "t,phi0,omega0,r_1,r_2")?;
    made.rows.iter().try_for_each(|r| {
        writeln!(to, "{:?},{:?},{:?},{:?},{:?}", r.t, r.phi0, r.omega0, r.radii[0], r.radii[1])
    })
}

/// Contact points on the object, palm by palm.
pub(super) fn points(made: &Fitted, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "palm,t,x,y")?;
    (0..2).try_for_each(|i| {
        made.rows
            .iter()
            .try_for_each(|r| writeln!(to, "{},{:?},{:?},{:?}", i + 1, r.t, r.points[i].x, r.points[i].y))
    })
}

/// Contact points, orientation and radius functions.
pub(super) fn panels(made: &Fitted) -> Vec<FigurePanel> {
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

/// The page of a fit.
pub(super) fn page(made: &Fitted, title: &str) -> FiguresPage {
    let [first, last] = [made.rows.first(), made.rows.last()].map(|row| row.map_or(f64::NAN, |row| row.t));
    let number = |key: &str| made.figures[key].as_f64().unwrap_or(f64::NAN);
    let row = |key: &str, name: &str, value: EvidenceValue, unit: &str, meaning: &str| {
        let [key, name, unit, meaning] = [key, name, unit, meaning].map(str::to_owned);
        Evidence { key, name, value, unit, meaning, level: Level::Neutral }
    };
    let (level, text) = match made.warnings.is_empty() {
        true => (Level::Good, "The outline and the motion explain the contacts to within their noise."),
        false => (Level::Bad, "Do not rely on this result; the warning says why."),
    };
    let [gyration, deviation] = ["gyration_squared_m2", "std_gyration_squared_m2"].map(number);
    FiguresPage {
        kicker: "Outline and motion in the plane, from contacts alone",
        title: title.to_owned(),
        verdict: Verdict { level, text: text.to_owned() },
        warnings: made.warnings.clone(),
        facts: vec![
            ("Time", brief(last - first), "s"),
            ("Samples", made.rows.len().to_string(), ""),
            ("Harmonics", made.figures["harmonics"].to_string(), ""),
        ],
        heading: "Shape and motion",
        panels: panels(made),
        caption: "Contact points on the object, its orientation, and the radius functions at the contacts."
            .to_owned(),
        table: FiguresPage::RESTS_ON,
        evidence: vec![
            row(
                "residual",
                "Residual",
                Number(number("residual")),
                "",
                "In standard deviations of the readings.",
            ),
            row(
                "gyration",
                "Radius of gyration squared",
                Number(gyration),
                "m²",
                "Moment of inertia over mass.",
            ),
            row("std_gyration", "Its uncertainty", Number(deviation), "m²", "Standard deviation."),
            row(
                "least_known",
                "Least known",
                Text(made.figures["least_known"].as_str().unwrap_or_default().to_owned()),
                "",
                "The direction that the log tells worst.",
            ),
        ],
    }
}

/// In words for the console.
pub(super) fn describe(made: &Fitted) -> String {
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
