use super::answers::written_to;
use super::plane;
use crate::cli::{BoundsArgs, FitAs, MeshAs, SurfaceAs};
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{
    BoundsResult, Noise, PlanarBounds, PlanarRequest, bounds_page, concave_bounds, doubtful_fit,
    exact_bounds, feature_lines, fit_words, fitted_shape, meshes_as, noisy_bounds, planar_bounds,
    pose_bounds, sharp_bounds, smooth_surface, write_bounds_folder,
};
use crate::progress::Progress;
use glam::DVec3;
use recon::contact_kinematics::CurvatureRadii;
use recon::contact_kinematics::planar::RadiusBounds;
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::poses::PlaneHeight;
use recon_io::{
    FiguresPage, FolderTarget, SummaryOf, Touches, brief, brief_to, check_unwritten, read_touches,
};
use serde_json::{Value, json};
use std::fmt::Write;
use std::slice;

/// Normals of five digits or more pass for exact: their length is off by less.
const EXACT_NORMALS: f64 = 1e-5;

/// Confidence of bounds under noise where none is asked for.
const CONFIDENCE: f64 = 0.95;

pub(crate) fn run(args: &BoundsArgs, console: &Console) -> Result<Outcome, CliError> {
    let inputs = slice::from_ref(&args.input);
    let target =
        args.output.as_ref().map(|folder| FolderTarget::new(folder, inputs, args.force)).transpose()?;
    let progress = Progress::new(2, console.is_quiet());
    progress.step("reading contacts or poses");
    let touches = read_touches(&args.input)?;
    progress.step("bounding the shape");
    let made = bounded(args, &touches)?;
    let figures = made.figures();
    match target {
        Some(folder) => {
            let title = args.input.file_name().unwrap_or(args.input.as_os_str()).to_string_lossy();
            made.write(folder, (&title, &args.mesh), &figures)?;
        }
        None => made.check(&figures)?,
    }
    drop(progress);
    let text = made.describe() + &written_to(args.output.as_deref());
    match args.output {
        Some(_) => console.written(&text, &figures)?,
        None => console.result(&text, &figures)?,
    }
    Ok(if made.is_whole() { Outcome::Done } else { Outcome::WithReservations })
}

/// Bounds, and what is to be said about them.
pub(crate) enum Bounded {
    /// In space, of so many contacts or poses; contacts are at `points`.
    Space { made: Box<BoundsResult>, about: Value, what: String, points: Vec<DVec3> },
    /// Of so many contacts in the plane.
    Plane { made: Box<PlanarBounds>, count: usize },
}

/// Bounds from what `args.input` held.
pub(crate) fn bounded(args: &BoundsArgs, touches: &Touches) -> Result<Bounded, CliError> {
    check_options(args, touches)?;
    Ok(match touches {
        Touches::PlanarContacts { curves, .. } => {
            let made = Box::new(planar_bounds(curves, &planar_request(args))?);
            Bounded::Plane { made, count: curves.iter().map(Vec::len).sum() }
        }
        Touches::Poses(runs) => {
            let count = runs.iter().map(Vec::len).sum::<usize>();
            let plane = PlaneHeight {
                z: args.plane_height.unwrap_or(0.0),
                deviation: args.height_deviation.unwrap_or(0.0),
                run_deviation: args.run_height_deviation.unwrap_or(0.0),
            };
            let (made, about) = pose_bounds(runs, plane, confidence(args), args.tight)?;
            let what = format!("{count} poses in {} runs", runs.len());
            Bounded::Space { made: Box::new(made), about, what, points: Vec::new() }
        }
        Touches::Contacts { curves, .. } => {
            let (made, about) = of_contacts(args, curves)?;
            let what = format!("{} contacts", curves.iter().map(Vec::len).sum::<usize>());
            let points = curves.iter().flatten().map(|contact| contact.point).collect();
            Bounded::Space { made: Box::new(made), about, what, points }
        }
    })
}

impl Bounded {
    /// The summary.
    pub(crate) fn figures(&self) -> Value {
        match self {
            Self::Space { made, about, what, .. } => figures(made, what, about),
            Self::Plane { made, count } => plane::figures(made, *count),
        }
    }

    /// The summary in words.
    pub(crate) fn describe(&self) -> String {
        match self {
            Self::Space { made, about, what, .. } => describe(made, what, about),
            Self::Plane { made, count } => plane::describe(made, *count),
        }
    }

    /// The page, under a title.
    pub(crate) fn page(&self, title: &str) -> FiguresPage {
        match self {
            Self::Space { made, about, what, points } => bounds_page(title, (made, about, what), points),
            Self::Plane { made, count } => plane::page(title, made, *count),
        }
    }

    /// Writes the folder, whose page is under a title.
    pub(crate) fn write(
        &self,
        folder: FolderTarget,
        (title, formats): (&str, &[MeshAs]),
        figures: &Value,
    ) -> Result<(), CliError> {
        match self {
            Self::Space { made, .. } => {
                let others = made.others.iter().map(|(name, _, mesh)| (*name, mesh));
                let extras = meshes_as(made.surfaces().into_iter().chain(others), formats)?;
                write_bounds_folder(folder, made, (&self.page(title), &extras), figures)
            }
            Self::Plane { made, .. } => plane::write_folder(folder, made, &self.page(title), figures),
        }
    }

    /// Checks what is not written.
    pub(crate) fn check(&self, figures: &Value) -> Result<(), CliError> {
        match self {
            Self::Space { made, .. } => check_unwritten(figures, &made.surfaces(), &[])?,
            Self::Plane { made, .. } => check_unwritten(figures, &[], &made.drawn_outlines())?,
        }
        Ok(())
    }

    /// Whether there is all that was asked for.
    pub(crate) fn is_whole(&self) -> bool {
        let (about, whole) = match self {
            Self::Space { made, about, .. } => {
                (about, made.lower.is_some() && made.upper.is_some() && !made.contradicts())
            }
            Self::Plane { made, .. } => {
                (&made.about, made.outlines.iter().all(|outline| !outline.is_empty()))
            }
        };
        whole && about["fit"]["status"] != "refused"
    }
}

/// Bounds of contacts in space, with what approximates the object where that is asked for.
fn of_contacts(args: &BoundsArgs, curves: &[Vec<ContactSample>]) -> Result<(BoundsResult, Value), CliError> {
    let (mut made, mut about) = match args.concave {
        true => concave_bounds(&curves.concat(), args.alpha)?,
        false => of_convex(args, curves)?,
    };
    if let Some(kind) = args.surface.or(args.concave.then_some(SurfaceAs::Hermite)) {
        let smooth = smooth_surface(&curves.concat(), kind, args.contact_noise)?;
        about["surface"] = smooth.about;
        made.warnings.extend(smooth.warning.map(str::to_owned));
        let comment = "smooth surface, an approximation and no bound; metres";
        made.others.push(("smooth_surface.ply", comment, smooth.mesh));
    }
    Ok((made, about))
}

fn of_convex(args: &BoundsArgs, curves: &[Vec<ContactSample>]) -> Result<(BoundsResult, Value), CliError> {
    let noise = noise(args).map(|noise| (noise, confidence(args)));
    let (mut made, mut about) = match (radii(args), noise) {
        (Some(radii), noise) => sharp_bounds(curves, radii, noise)?,
        (None, Some((noise, confidence))) => noisy_bounds(curves, noise, confidence)?,
        (None, None) => (exact_bounds(&curves.concat())?, json!({ "noise": "none" })),
    };
    if let Some(family) = args.fit {
        let fitted = fitted_shape(curves, noise, family)?;
        about["fit"] = fitted.report;
        made.warnings.extend(fitted.warning);
        made.warnings.extend(doubtful_fit(&about));
        let comment = "shape fitted to the contacts; metres";
        made.others.extend(fitted.drawn.map(|mesh| ("fitted_shape.ply", comment, mesh)));
    }
    Ok((made, about))
}

fn planar_request(args: &BoundsArgs) -> PlanarRequest {
    PlanarRequest {
        noise: noise(args).map(|noise| (noise, confidence(args))),
        radii: args.rho_max.map(|max| RadiusBounds { min: args.rho_min.unwrap_or(0.0), max }),
        fit: args.fit,
    }
}

fn confidence(args: &BoundsArgs) -> f64 {
    args.confidence.unwrap_or(CONFIDENCE)
}

/// Refuses options that mean nothing for what is in the file.
fn check_options(args: &BoundsArgs, touches: &Touches) -> Result<(), CliError> {
    let (in_space, in_plane) = args.fit.map_or((true, true), FitAs::is_for);
    let exact = noise(args).is_none();
    let pointless = [
        (args.plane_height.is_some(), "plane-height", "poses"),
        (args.height_deviation.is_some(), "height-deviation", "poses"),
        (args.run_height_deviation.is_some(), "run-height-deviation", "poses"),
        (args.tight, "tight", "poses"),
        (args.confidence.is_some() && exact, "confidence", "poses and noisy contacts"),
    ];
    let (found, wrong): (_, Vec<(bool, &str, &str)>) = match touches {
        Touches::Poses(_) => (
            "poses",
            vec![
                (args.contact_noise.is_some(), "contact-noise", "contacts"),
                (args.estimate_noise, "estimate-noise", "contacts"),
                (args.rho_max.is_some(), "rho-max", "contacts"),
                (args.fit.is_some(), "fit", "contacts"),
                (args.concave, "concave", "contacts"),
                (args.surface.is_some(), "surface", "contacts"),
            ],
        ),
        Touches::Contacts { .. } => {
            let family = (!in_space, "fit circle, ellipse or waves", "contacts in the plane");
            let through = matches!(args.surface, Some(SurfaceAs::Hermite | SurfaceAs::Spline));
            let through = (through && !exact, "surface hermite or spline", "exact contacts; take principal");
            let found = if exact { "contacts without stated noise" } else { "noisy contacts" };
            (found, pointless.into_iter().chain([family, through]).collect())
        }
        Touches::PlanarContacts { .. } => {
            let of_space = [
                (args.concave, "concave", "contacts in space"),
                (args.surface.is_some(), "surface", "contacts in space"),
                (!args.mesh.is_empty(), "mesh", "contacts in space"),
                (!in_plane, "fit ball, ellipsoid, superquadric or harmonics", "contacts in space"),
                (args.rho_max.is_some() && !exact, "rho-max beside noise", "contacts in space"),
            ];
            ("contacts in the plane", pointless.into_iter().chain(of_space).collect())
        }
    };
    match wrong.into_iter().find(|(given, ..)| *given) {
        Some((_, option, meant)) => Err(CliError::Option { option, meant, found, path: args.input.clone() }),
        None if exact => exact_enough(touches),
        None => Ok(()),
    }
}

/// Refuses to take normals as exact that are visibly rounded: bounds from them would be off by as much.
fn exact_enough(touches: &Touches) -> Result<(), CliError> {
    match touches {
        Touches::Contacts { rounding, .. } | Touches::PlanarContacts { rounding, .. }
            if *rounding > EXACT_NORMALS =>
        {
            Err(CliError::RoundedNormals { off: *rounding })
        }
        _ => Ok(()),
    }
}

fn noise(args: &BoundsArgs) -> Option<Noise> {
    match (args.contact_noise, args.normal_noise) {
        (Some(point), Some(normal)) => Some(Noise::Stated { point, normal }),
        _ => args.estimate_noise.then_some(Noise::Estimated),
    }
}

fn radii(args: &BoundsArgs) -> Option<CurvatureRadii> {
    args.rho_max.map(|max| CurvatureRadii { min: args.rho_min.unwrap_or(0.0), max })
}

fn figures(made: &BoundsResult, what: &str, about: &Value) -> Value {
    let (lower, upper) = (made.drawn.lower.volume, made.drawn.upper.as_ref().map(|u| u.volume));
    SummaryOf::Bounds.named(json!({
        "input": what,
        "about": about,
        "bounds": {
            "lower_volume_m3": lower,
            "upper_volume_m3": upper,
            "lower_over_upper": upper.map(|u| lower / u),
            "largest_gap_m": made.drawn.largest_gap.map(|gap| gap.distance),
            "contradiction_m": made.contradiction,
        },
        "warnings": made.warnings,
    }))
}

fn describe(made: &BoundsResult, what: &str, about: &Value) -> String {
    let lower = made.drawn.lower.volume;
    let mut text = String::new();
    for warning in &made.warnings {
        let _ = writeln!(text, "Warning: {warning}");
    }
    let _ = writeln!(text, "{what}");
    if let Some(confidence) = about["confidence"].as_f64() {
        let _ = writeln!(text, "  confidence             {} %", 100.0 * confidence);
    }
    if let Some(margin) = about["margin_m"].as_f64() {
        let _ = writeln!(text, "  margin of the poses    {} m", brief(margin));
    }
    let _ = writeln!(text, "  lower bound            {} m^3", brief(lower));
    if let Some(upper) = &made.drawn.upper {
        let _ = writeln!(text, "  upper bound            {} m^3", brief(upper.volume));
        let _ = writeln!(text, "  lower / upper          {}", brief_to(4, lower / upper.volume));
    }
    if let Some(gap) = made.drawn.largest_gap.map(|gap| gap.distance) {
        let _ = writeln!(text, "  gap, at most           {} m", brief(gap));
    }
    if let Some(volume) = about["concave"]["alpha_volume_m3"].as_f64() {
        let _ = writeln!(text, "  alpha shape, about     {} m^3", brief(volume));
    }
    if let Some(kind) = about["surface"]["kind"].as_str() {
        let _ = writeln!(text, "  smooth surface         {kind}, an approximation and no bound");
    }
    for (name, value) in feature_lines(&about["features"]) {
        let _ = writeln!(text, "  {name:<22} {value}");
    }
    if about["fit"].is_object() {
        text += &fit_words(&about["fit"]);
    }
    let _ = writeln!(text, "  next                   {}", next_touch(made));
    text
}

/// Where to touch next.
fn next_touch(made: &BoundsResult) -> String {
    match made.drawn.largest_gap {
        Some(gap) => {
            let [x, y, z] = gap.outer.to_array().map(|of| brief_to(4, of));
            let apart = brief_to(3, gap.distance);
            format!("touch it about ({x}, {y}, {z}) m: there the bounds are {apart} m apart")
        }
        None if made.drawn.upper.is_none() => {
            "touch the object from all sides: only then it has an upper bound".to_owned()
        }
        None if made.drawn.lower.volume == 0.0 => {
            "more contacts or poses, or better ones: nothing is certain to be inside yet".to_owned()
        }
        None => "nothing is left to touch: the bounds are one".to_owned(),
    }
}
