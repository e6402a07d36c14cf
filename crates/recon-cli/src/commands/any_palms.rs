//! What `recon reconstruct` says of contacts of any palms.

use super::reconstruct::bounds_and_errors;
use crate::pipeline::describe_times;
use recon_io::{EstimateData, brief, brief_to, estimated_mode_spans};
use serde_json::Value;
use std::fmt::Write;

/// What contacts of any palms tell, in words; `figures` are those of its summary.
pub(super) fn describe(data: &EstimateData, figures: &Value) -> String {
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
    let _ = writeln!(text, "{}", times.trim_start_matches('\n'));
    text
}
