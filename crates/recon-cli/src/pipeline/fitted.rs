//! Shapes of few parameters fitted to contacts, as the reader sees them: values, deviations, covariance, misfit.

use super::sound::{Noise, cleaned};
use crate::cli::FitAs;
use crate::error::CliError;
use glam::DVec2;
use recon::contact_kinematics::planar::RadiusFunction;
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::fit::{
    Candidate, FitError, FitOptions, FitStatistics, NoiseLevel, ShapeFamily, ShapeFit,
};
use recon::shape_bounds::noise::{ContactNoise, NoisyContact};
use recon::shape_bounds::planar;
use recon::shape_bounds::planar::fit::{OutlineFamily, OutlineFit};
use recon_io::{TriangleMesh, brief, brief_to};
use serde_json::{Value, json};
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Display;

/// Deviation of normals, in rad, and of points, as a share of the size, where no noise is stated: only their ratio
/// matters, because their common factor is estimated from the residuals.
const RELATIVE_NOISE: f64 = 1e-3;
/// Rows and columns of a fitted body's mesh, and corners of a fitted outline.
const NET: (u32, u32) = (48, 96);
const CORNERS: u32 = 720;

/// A fit, or why there is none.
pub(crate) struct Fitted<T> {
    /// Status and figures, for the summary.
    pub(crate) report: Value,
    /// The fitted surface or outline; none where the contacts refute it.
    pub(crate) drawn: Option<T>,
    /// What the reader must know.
    pub(crate) warning: Option<String>,
}

impl<T> Fitted<T> {
    /// Nothing, because the contacts refute it.
    fn refused(error: &dyn Error, tried: Value) -> Self {
        let warning = if tried.is_null() {
            format!("No shape is written: {error}.")
        } else {
            "No family of shapes fits the contacts, so that none is written; the bounds do not need one. \
             summary.json tells of each."
                .to_owned()
        };
        let report = json!({ "status": "refused", "reason": error.to_string(), "tried": tried });
        Self { report, drawn: None, warning: Some(warning) }
    }
}

/// Fits a shape to contacts in space. A shape that the contacts refute is reported as refused, which is no error: the
/// bounds hold without it.
pub(crate) fn fitted_shape(
    curves: &[Vec<ContactSample>],
    noise: Option<(Noise, f64)>,
    family: FitAs,
) -> Result<Fitted<TriangleMesh>, CliError> {
    let (contacts, options) = match noise {
        Some((noise, confidence)) => (cleaned(curves, noise, confidence)?.kept.concat(), stated()),
        None => {
            let contacts = curves.concat();
            let noise = ContactNoise::isotropic(
                RELATIVE_NOISE * size(contacts.iter().map(|c| c.point)),
                RELATIVE_NOISE,
            );
            let with = |contact: &ContactSample| NoisyContact { contact: *contact, noise };
            (contacts.iter().map(with).collect(), estimated())
        }
    };
    let families = match family {
        FitAs::Auto => ShapeFamily::candidates(contacts.len()),
        FitAs::Ball => vec![ShapeFamily::Sphere],
        FitAs::Ellipsoid => vec![ShapeFamily::Ellipsoid],
        FitAs::Superquadric => vec![ShapeFamily::Superquadric],
        FitAs::Harmonics(degree) => vec![ShapeFamily::Harmonics { degree }],
        FitAs::Circle | FitAs::Ellipse | FitAs::Waves(_) => Vec::new(),
    };
    let choice = match ShapeFit::choose(&contacts, &families, &options) {
        Ok(choice) => choice,
        Err(error) => {
            return match &error {
                FitError::NoneFits { candidates } => Ok(Fitted::refused(&error, tried(candidates))),
                FitError::Refuted { .. } => Ok(Fitted::refused(&error, Value::Null)),
                _ => Err(error.into()),
            };
        }
    };
    let fit = &choice.best;
    let mut report = report(&fit.family().to_string(), fit.names(), fit.parameters(), fit.covariance());
    add_statistics(&mut report, fit.statistics(), 3.0, noise.is_some());
    report["tried"] = tried(&choice.candidates);
    let mesh = TriangleMesh::net(NET.0, NET.1, |n| fit.body().point(Direction::new_unchecked(n)));
    Ok(Fitted { report, drawn: Some(mesh), warning: None })
}

fn tried<F: Display, E: Display>(candidates: &[Candidate<F, E>]) -> Value {
    let one = |c: &Candidate<F, E>| {
        let name = c.family.to_string();
        match &c.outcome {
            Ok(criterion) => json!({ "family": name, "criterion": criterion }),
            Err(error) => json!({ "family": name, "not_fitted": error.to_string() }),
        }
    };
    candidates.iter().map(one).collect()
}

/// Fits an outline to contacts in the plane, drawn by its corners; refused as in space.
pub(crate) fn fitted_outline(
    contacts: &[planar::noise::NoisyContact],
    stated_noise: bool,
    family: FitAs,
) -> Result<Fitted<Vec<DVec2>>, CliError> {
    let families = match family {
        FitAs::Auto => OutlineFamily::candidates(contacts.len()),
        FitAs::Circle => vec![OutlineFamily::Circle],
        FitAs::Ellipse => vec![OutlineFamily::Ellipse],
        FitAs::Waves(order) => vec![OutlineFamily::Fourier { order }],
        FitAs::Ball | FitAs::Ellipsoid | FitAs::Superquadric | FitAs::Harmonics(_) => Vec::new(),
    };
    let options = if stated_noise { stated() } else { estimated() };
    let choice = match OutlineFit::choose(contacts, &families, &options) {
        Ok(choice) => choice,
        Err(error) => {
            return match &error {
                planar::fit::FitError::NoneFits { candidates } => {
                    Ok(Fitted::refused(&error, tried(candidates)))
                }
                planar::fit::FitError::Refuted { .. } => Ok(Fitted::refused(&error, Value::Null)),
                _ => Err(error.into()),
            };
        }
    };
    let fit = &choice.best;
    let mut report = report(&fit.family().to_string(), &fit.names(), fit.parameters(), fit.covariance());
    add_statistics(&mut report, fit.statistics(), 2.0, stated_noise);
    report["tried"] = tried(&choice.candidates);
    let corner = |k: u32| fit.body().point(TAU * f64::from(k) / f64::from(CORNERS));
    Ok(Fitted { report, drawn: Some((0..CORNERS).map(corner).collect()), warning: None })
}

/// Contacts in the plane with noise of which only the ratio between points and normals is meant.
pub(super) fn relative_noise(contacts: &[planar::ContactSample]) -> Vec<planar::noise::NoisyContact> {
    let level = RELATIVE_NOISE * size(contacts.iter().map(|c| c.point.extend(0.0)));
    let noise = planar::noise::ContactNoise::isotropic(level, RELATIVE_NOISE);
    contacts.iter().map(|&contact| planar::noise::NoisyContact { contact, noise }).collect()
}

fn stated() -> FitOptions {
    FitOptions::default()
}

fn estimated() -> FitOptions {
    FitOptions { noise_level: NoiseLevel::Estimated, ..FitOptions::default() }
}

/// The largest distance from the first point, in m.
fn size(mut points: impl Iterator<Item = glam::DVec3>) -> f64 {
    let first = points.next().unwrap_or_default();
    points.map(|p| p.distance(first)).fold(0.0, f64::max)
}

/// Names, values, deviations and covariance; the matrix types are nalgebra's, which this crate does not name.
fn report<V, M>(family: &str, names: &[String], values: &V, covariance: &M) -> Value
where
    V: std::ops::Index<usize, Output = f64>,
    M: std::ops::Index<(usize, usize), Output = f64>,
{
    let count = names.len();
    let row = |i: usize| (0..count).map(|j| covariance[(i, j)]).collect::<Vec<f64>>();
    let parameters = (0..count)
        .map(|i| json!({ "name": names[i], "value": values[i], "std": covariance[(i, i)].max(0.0).sqrt() }));
    json!({
        // One that does not come to rest is an error, one that the contacts refute is refused.
        "status": "fitted",
        "family": family,
        "parameters": parameters.collect::<Vec<_>>(),
        "covariance": (0..count).map(row).collect::<Vec<_>>(),
    })
}

fn add_statistics(report: &mut Value, of: &FitStatistics, equations: f64, stated: bool) {
    report["residual_m"] = json!(of.residual);
    report["condition"] = json!(of.condition);
    report["std_weakest_over_size"] = json!(of.weakest_deviation);
    report["active_curvature_constraints"] = json!(of.active_constraints);
    report["worst_contact"] = json!(of.worst.0 + 1);
    if stated {
        report["chi_squared"] = json!(of.chi_squared);
        report["degrees_of_freedom"] = json!(of.degrees_of_freedom);
        report["worst_squared_residual_over_noise"] = json!(of.worst.1 / equations);
    }
}

/// What is said about a fit.
pub(crate) fn fit_words(report: &Value) -> String {
    if report["status"] == "refused" {
        return "  fitted shape           none: refused\n".to_owned();
    }
    let number = |name: &str| report[name].as_f64().unwrap_or(f64::NAN);
    let mut text = format!(
        "  fitted shape           {}, rms residual {} m\n",
        report["family"].as_str().unwrap_or_default(),
        brief(number("residual_m"))
    );
    for parameter in report["parameters"].as_array().into_iter().flatten().take(NAMED) {
        let of = |name: &str| parameter[name].as_f64().unwrap_or(f64::NAN);
        let name = parameter["name"].as_str().unwrap_or_default();
        let unit = unit_of(name);
        let space = if unit.is_empty() { "" } else { " " };
        text +=
            &format!("    {name:<20} {} +- {}{space}{unit}\n", brief(of("value")), brief_to(2, of("std")));
    }
    let count = report["parameters"].as_array().map_or(0, Vec::len);
    if count > NAMED {
        text += &format!("    and {} more parameters: see summary.json or --json\n", count - NAMED);
    }
    if report["chi_squared"].is_number() {
        let ratio = number("chi_squared") / number("degrees_of_freedom");
        text += &format!(
            "    chi squared over degrees of freedom {}; about 1 for a shape of this family\n",
            brief_to(3, ratio)
        );
    }
    text
}

/// The unit of a parameter of that name, of any family.
pub(crate) fn unit_of(name: &str) -> &'static str {
    match name {
        _ if name.starts_with("exponent") => "",
        _ if name.starts_with("turn") => "rad",
        // Places, radii, semi-axes, and what waves and harmonics add to a support function.
        _ => "m",
    }
}

/// Parameters that are told one by one.
const NAMED: usize = 11;
