//! `summary.json`: numbers that are there, and fits that say how they ended.

use super::Fault;
use serde_json::Value;

/// Numbers that may be absent: there is no upper bound, no bound at all, or no truth to compare with.
const MAY_BE_NULL: [&str; 10] = [
    "bounds",
    "upper_volume_m3",
    "upper_area_m2",
    "lower_over_upper",
    "largest_gap_m",
    "true_volume_m3",
    "largest_error",
    "rms_error",
    "contradiction_m",
    "plane_seems_lower_m",
];

/// Whether the reader is told that something is amiss.
pub(super) fn warns(summary: &Value) -> bool {
    let warned = summary["warnings"].as_array().is_some_and(|warnings| !warnings.is_empty());
    let level = &summary["verdict"]["level"];
    warned || level.is_string() && level != "good"
}

/// What is missing from a summary, or wrong in it without a warning.
pub(super) fn faults(summary: &Value) -> Vec<Fault> {
    let mut faults = Vec::new();
    if !warns(summary) {
        absent(summary, "", &mut faults);
    }
    let fits = [("method", "status"), ("verdict", "verdict/level"), ("about/fit", "about/fit/status")];
    for (fit, status) in fits {
        let Some(found) = summary.pointer(&format!("/{fit}")).filter(|found| !found.is_null()) else {
            continue;
        };
        match summary.pointer(&format!("/{status}")).and_then(Value::as_str) {
            None | Some("") => faults.push(Fault::NoStatus { fit: words(found), status: status.to_owned() }),
            Some("converged" | "stalled" | "fitted" | "good") => {}
            Some(_) if warns(summary) => {}
            Some(found) => {
                faults.push(Fault::NotSettled { status: status.to_owned(), found: found.to_owned() })
            }
        }
    }
    faults
}

fn words(fit: &Value) -> String {
    let word = |value: &Value| value.as_str().map(str::to_owned);
    word(fit).or_else(|| word(&fit["family"])).unwrap_or_else(|| "the motion".to_owned())
}

/// Numbers that are null: JSON has no other word for what is not finite.
fn absent(value: &Value, place: &str, faults: &mut Vec<Fault>) {
    match value {
        Value::Null if !MAY_BE_NULL.iter().any(|name| place.rsplit('.').next() == Some(name)) => {
            faults.push(Fault::Null { place: place.to_owned() });
        }
        Value::Array(all) => {
            all.iter().enumerate().for_each(|(k, one)| absent(one, &format!("{place}[{k}]"), faults));
        }
        Value::Object(all) => all.iter().for_each(|(name, one)| {
            let dot = if place.is_empty() { "" } else { "." };
            absent(one, &format!("{place}{dot}{name}"), faults);
        }),
        _ => {}
    }
}
