//! What is said of every estimate: the body, how well things are known, and what to do next.

use recon::object_dynamics::MassProperties;
use recon_io::{Bounds, brief, brief_to};
use serde_json::Value;

/// Share of the upper bound's volume that the lower one has where there is little left to gain.
const TIGHT: f64 = 0.6;

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

/// What decides on what to do next.
pub(super) struct Advice<'a> {
    pub(super) reliable: bool,
    pub(super) bounds: Option<&'a Bounds>,
    /// Whether mass and inertia were estimated.
    pub(super) identified: bool,
    /// Whether all of the inertia was learned, if so.
    pub(super) learned: bool,
}

impl Advice<'_> {
    /// The step that gains most.
    pub(super) fn next(&self) -> &'static str {
        let upper = self.bounds.and_then(|bounds| Some((bounds.lower.volume, bounds.upper.as_ref()?.volume)));
        match (self.reliable, upper) {
            (false, _) => {
                "see which evidence is red in report.html, and what was read of the log: recon check-input LOG --scene SCENE"
            }
            (true, _) if self.identified && !self.learned => {
                "turn the object about more axes: the log does not tell all of its inertia"
            }
            (true, None) => "touch the object from all sides: only then it has an upper bound",
            (true, Some((lower, upper))) if lower < TIGHT * upper => {
                "touch more of the object (a longer log): the bounds leave much of its shape open"
            }
            (true, Some(_)) if !self.identified => "--identify tells mass and inertia from the log as well",
            (true, Some(_)) => "--export mjcf,urdf writes the object for simulators",
        }
    }
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
            lines.push((name, format!("{error:.2e} {unit}")));
        }
    }
    lines
}
