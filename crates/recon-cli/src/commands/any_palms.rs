//! What `recon reconstruct` says of contacts of any palms.

use super::answers::{bounds_and_errors, of_body};
use crate::pipeline::{describe_times, feature_lines};
use recon::object_dynamics::MassProperties;
use recon::observer::contacts::ContactEstimate;
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
    // A tensor that no body has, as rounding may leave one, has no moments to tell.
    match MassProperties::new(found.mass, found.inertia) {
        Ok(body) => of_body(&body, figures).into_iter().for_each(|(name, value)| line(name, value)),
        Err(_) => line("mass", format!("{} kg", brief(found.mass))),
    }
    if let Some(axes) = figures["evidence"]["std_axes"]["value"].as_str() {
        line("axes, deviations", format!("{axes} rad"));
    }
    if let Some(explained) = figures["evidence"]["explained_by"]["value"].as_str() {
        line("explained by", explained.to_owned());
    }
    if let Some([position, velocity, _, turn]) = largest(found) {
        let [position, velocity, turn] = [position, velocity, turn].map(|std| brief_to(2, std));
        line("motion known to", format!("{position} m, {velocity} m/s, {turn} rad (largest std relied on)"));
    }
    for (name, value) in bounds_and_errors(data.bounds.as_ref(), figures) {
        line(name, value);
    }
    feature_lines(&figures["features"]).into_iter().for_each(|(name, value)| line(name, value));
    line("next", data.next.clone());
    let spans: Vec<_> = (0..data.log.palms().len())
        .map(|palm| estimated_mode_spans(data.log.times(), &found.modes, found.mode_odds.as_ref(), palm))
        .collect();
    let times = describe_times(&spans);
    let _ = writeln!(text, "{}", times.trim_start_matches('\n'));
    text
}

/// The largest standard deviations, all axes together, at the samples that are relied on; none where there is no such sample.
fn largest(found: &ContactEstimate) -> Option<[f64; 4]> {
    let relied = found.deviations.iter().zip(&found.relied_on).filter(|(_, relied)| **relied);
    let sizes = relied.map(|(of, _)| of.map(|std| std.length()));
    sizes.reduce(|a, b| std::array::from_fn(|i| a[i].max(b[i])))
}
