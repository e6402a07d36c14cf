//! `recon reconstruct` on logs of contacts of any palms.

use super::reconstruct::bounds_and_errors;
use crate::cli::ReconstructArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{
    AnyPalmsRequest, LogStand, as_planes, bag_of_any_palms, describe_times, estimate_any_palms, exported,
    write_estimate_folder,
};
use crate::progress::Progress;
use recon::object_dynamics::{ContactLog, SensorLog};
use recon_io::{EstimateData, FolderTarget, Level, brief, brief_to, estimated_mode_spans};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

pub(super) fn run(
    args: &ReconstructArgs,
    (log, request, stand): (ContactLog, AnyPalmsRequest<'_>, LogStand),
    planes: Option<&SensorLog>,
    (target, progress): (FolderTarget, Progress),
    console: &Console,
) -> Result<Outcome, CliError> {
    let scene = request.scene;
    let made = estimate_any_palms(log, request, &progress)?;
    progress.step("writing the results");
    let files = match args.export.is_empty() {
        true => Vec::new(),
        false => exported(&made.object()?, &args.export, args.export_shape)?,
    };
    let mut extras: Vec<_> = files.into_iter().map(|file| (file.name, file.contents)).collect();
    if args.mcap {
        extras.push(bag_of_any_palms(&made, stand)?);
    }
    let page = planes.map(|planes| as_planes(&made, planes, scene)).transpose()?;
    let (mut figures, data) = (write_estimate_folder(target, &made, page.as_ref(), &extras)?, &made.data);
    drop(progress);
    figures["folder"] = args.output.to_string_lossy().into();
    console.result(&describe(data, &figures, &args.output), &figures)?;
    Ok(if data.verdict.level == Level::Good { Outcome::Done } else { Outcome::WithReservations })
}

fn describe(data: &EstimateData, figures: &Value, folder: &Path) -> String {
    let found = &data.estimate;
    let mut text = format!("{}\n{}\n", data.verdict.text, data.note);
    for warning in &data.warnings {
        let _ = writeln!(text, "Warning: {warning}");
    }
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<22} {value}");
    };
    line("samples", format!("{} over {} s", data.log.times().len(), brief(data.log.duration())));
    let known = match found.axes_deviations {
        Some(_) => "as stated".to_owned(),
        None => format!("deviation {} kg", brief_to(2, found.mass * found.mass_deviation)),
    };
    line("mass", format!("{} kg, {known}", brief(found.mass)));
    if let Some(axes) = figures["evidence"]["std_axes"]["value"].as_str() {
        line("axes, deviations", format!("{axes} rad"));
    }
    let moments: Vec<String> = ["moment_x", "moment_y", "moment_z"]
        .iter()
        .filter_map(|key| figures["evidence"][key]["value"].as_f64())
        .map(|moment| brief_to(4, moment))
        .collect();
    if !moments.is_empty() {
        line("principal moments", format!("{} kg m^2", moments.join(", ")));
    }
    for (name, value) in bounds_and_errors(data.bounds.as_ref(), figures) {
        line(name, value);
    }
    let spans: Vec<_> =
        (0..data.log.palms().len()).map(|palm| estimated_mode_spans(data.log.times(), found, palm)).collect();
    let times = describe_times(&spans);
    let _ = write!(text, "{}\n{}", times.trim_start_matches('\n'), folder.join("report.html").display());
    text
}
