//! `summary.json`: the figures of a reconstruction for programs.

use crate::report::{Bounds, Departure, Evidence, EvidenceValue, ReportData, level};
use serde_json::{Map, Value, json};

/// The figures of a reconstruction. Numbers are at full precision, in SI units; a number that is not finite is null.
#[must_use]
pub fn summary(data: &ReportData) -> Value {
    json!({
        "recon": env!("CARGO_PKG_VERSION"),
        "title": data.title,
        "verdict": { "level": level(data.verdict.level), "text": data.verdict.text },
        "samples": data.times.len(),
        "t_first_s": data.times.first(),
        "t_last_s": data.times.last(),
        "evidence": data.evidence.iter().map(evidence).collect::<Map<_, _>>(),
        "bounds": data.bounds.as_ref().map(bounds),
        "true_volume_m3": data.true_shape.as_ref().and_then(|s| s.volume),
        "largest_error": data.departures().map(|d| largest(&d)),
        "warnings": data.warnings,
    })
}

fn evidence(row: &Evidence) -> (String, Value) {
    let value = match &row.value {
        EvidenceValue::Number(v) => json!(v),
        EvidenceValue::Count(n) => json!(n),
        EvidenceValue::Text(text) => json!(text),
    };
    (row.key.clone(), json!({ "value": value, "unit": row.unit, "level": level(row.level) }))
}

fn bounds(bounds: &Bounds) -> Value {
    let (lower, upper) = (bounds.lower.volume, bounds.upper.as_ref().map(|u| u.volume));
    json!({
        "lower_volume_m3": lower,
        "upper_volume_m3": upper,
        "lower_over_upper": upper.map(|u| lower / u),
        "largest_gap_m": bounds.largest_gap,
    })
}

fn largest(departures: &[Departure]) -> Value {
    let most = |of: fn(&Departure) -> f64| departures.iter().map(of).fold(0.0, f64::max);
    json!({
        "position_m": most(|d| d.position),
        "orientation_rad": most(|d| d.angle),
        "velocity_m_per_s": most(|d| d.velocity),
        "angular_velocity_rad_per_s": most(|d| d.angular_velocity),
        "radius_function_m": most(|d| d.radius),
    })
}
