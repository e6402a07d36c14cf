use crate::cli::BoundsArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{
    BoundsResult, Noise, bounds, noisy_bounds, pose_bounds, sharp_bounds, write_bounds_folder,
};
use crate::progress::Progress;
use recon::contact_kinematics::CurvatureRadii;
use recon_io::{Touches, read_touches};
use serde_json::{Value, json};
use std::fmt::Write;

/// Confidence of bounds under noise where none is asked for.
const CONFIDENCE: f64 = 0.95;

pub(crate) fn run(args: &BoundsArgs, console: &Console) -> Result<Outcome, CliError> {
    let progress = Progress::new(2, console.is_json());
    progress.step("reading contacts or poses");
    let touches = read_touches(&args.input)?;
    check_options(args, &touches)?;
    progress.step("bounding the shape");
    let confidence = args.confidence.unwrap_or(CONFIDENCE);
    let (made, about, what) = match touches {
        Touches::Poses(runs) => {
            let count = runs.iter().map(Vec::len).sum::<usize>();
            let (made, about) = pose_bounds(&runs, args.plane_height.unwrap_or(0.0), confidence)?;
            (made, about, format!("{count} poses in {} runs", runs.len()))
        }
        Touches::Contacts(curves) => {
            let count = format!("{} contacts", curves.iter().map(Vec::len).sum::<usize>());
            let (made, about) = match (radii(args), noise(args)) {
                (Some(radii), noise) => sharp_bounds(&curves, radii, noise.map(|n| (n, confidence)))?,
                (None, Some(noise)) => noisy_bounds(&curves, noise, confidence)?,
                (None, None) => (bounds(&curves.concat())?, json!({ "noise": "none" })),
            };
            (made, about, count)
        }
    };
    let figures = figures(&made, &what, &about);
    if let Some(folder) = &args.output {
        write_bounds_folder(folder, &made, &figures)?;
    }
    drop(progress);
    console.result(&describe(&made, &what, &about), &figures)?;
    let whole = made.lower.is_some() && made.upper.is_some();
    Ok(if whole { Outcome::Done } else { Outcome::WithReservations })
}

/// Refuses options that mean nothing for what is in the file.
fn check_options(args: &BoundsArgs, touches: &Touches) -> Result<(), CliError> {
    let (found, meant, given) = match touches {
        Touches::Poses(_) => {
            let option = [
                (args.contact_noise.is_some(), "contact-noise"),
                (args.estimate_noise, "estimate-noise"),
                (args.rho_max.is_some(), "rho-max"),
            ];
            ("poses", "contacts", option.into_iter().find(|(given, _)| *given))
        }
        Touches::Contacts(_) => {
            let option = [
                (args.plane_height.is_some(), "plane-height"),
                (args.confidence.is_some() && noise(args).is_none(), "confidence"),
            ];
            let found = "contacts without stated noise";
            (found, "poses and noisy contacts", option.into_iter().find(|(given, _)| *given))
        }
    };
    match given {
        Some((_, option)) => Err(CliError::Option { option, meant, found, path: args.input.clone() }),
        None => Ok(()),
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
    json!({
        "recon": env!("CARGO_PKG_VERSION"),
        "input": what,
        "about": about,
        "bounds": {
            "lower_volume_m3": lower,
            "upper_volume_m3": upper,
            "lower_over_upper": upper.map(|u| lower / u),
            "largest_gap_m": made.drawn.largest_gap,
        },
        "warnings": made.warnings,
    })
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
        let _ = writeln!(text, "  margin of the poses    {margin:.6} m");
    }
    let _ = writeln!(text, "  lower bound            {lower:.6e} m^3");
    if let Some(upper) = &made.drawn.upper {
        let _ = writeln!(text, "  upper bound            {:.6e} m^3", upper.volume);
        let _ = writeln!(text, "  lower / upper          {:.4}", lower / upper.volume);
    }
    if let Some(gap) = made.drawn.largest_gap {
        let _ = writeln!(text, "  gap, at most           {gap:.6} m");
    }
    text
}
