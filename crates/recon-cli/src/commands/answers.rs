//! What is said of every estimate: the body, and how well things are known.

use recon::object_dynamics::MassProperties;
use recon_io::{Bounds, brief, brief_to};
use serde_json::Value;
use std::path::Path;

/// The line that tells the folder of results; none without one.
pub(super) fn written_to(folder: Option<&Path>) -> String {
    folder.map_or_else(String::new, |folder| format!("  written to             {}\n", folder.display()))
}

/// A number of the evidence in a summary.
pub(super) fn evidence(figures: &Value, key: &str) -> Option<f64> {
    figures["evidence"][key]["value"].as_f64()
}

/// Names and values of mass and inertia: as the scene states them, or with their deviations where they were estimated.
pub(super) fn of_body(body: &MassProperties, figures: &Value) -> Vec<(&'static str, String)> {
    let with = |value: f64, std: Option<f64>| match std {
        Some(std) => format!("{} +- {}", brief(value), brief_to(2, std)),
        None => brief(value),
    };
    let std_mass = evidence(figures, "std_mass");
    let stated = if std_mass.is_none() { ", as stated" } else { "" };
    let of = |(key, value): (&str, f64)| with(value, std_mass.and(evidence(figures, &format!("std_{key}"))));
    let keys = ["moment_x", "moment_y", "moment_z"];
    let moments =
        keys.into_iter().zip(body.principal().moments.to_array()).map(of).collect::<Vec<_>>().join(", ");
    vec![
        ("mass", format!("{} kg{stated}", with(body.mass(), std_mass))),
        ("principal moments", format!("{moments} kg m^2{stated}")),
    ]
}

/// Names and values of what is said of the bounds and, where the truth is known, of the largest errors.
pub(super) fn bounds_and_errors(bounds: Option<&Bounds>, figures: &Value) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    if let Some(bounds) = bounds {
        lines.push(("lower bound", format!("{} m^3", brief(bounds.lower.volume))));
        if let Some(upper) = &bounds.upper {
            lines.push(("upper bound", format!("{} m^3", brief(upper.volume))));
            lines.push(("lower / upper", brief_to(4, bounds.lower.volume / upper.volume)));
        }
    }
    for (name, key, unit) in [
        ("largest error: position", "position_m", "m"),
        ("  orientation", "orientation_rad", "rad"),
        ("  angular velocity", "angular_velocity_rad_per_s", "rad/s"),
    ] {
        if let Some(error) = figures["largest_error"][key].as_f64() {
            lines.push((name, format!("{} {unit}", brief_to(2, error))));
        }
    }
    lines
}
